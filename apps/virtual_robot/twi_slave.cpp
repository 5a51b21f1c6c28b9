#include "apps/virtual_robot/twi_slave.h"

#include "apps/virtual_robot/simavr.h"
#include "base/assert.h"

namespace taut::virtual_robot {
namespace {

// Bits of the control register TWCR.
constexpr std::uint8_t kTwint = 0x80, kTwea = 0x40, kTwsto = 0x10, kTwwc = 0x08, kTwen = 0x04,
                       kTwie = 0x01;
constexpr std::uint8_t kGeneralCallEnable = 0x01;  // bit in TWAR
constexpr std::uint8_t kPrescaler = 0x03;          // bits in TWSR

}  // namespace

TwiSlave::TwiSlave(avr_t& avr, const BoardClock& clock) : avr_(avr), clock_(clock) {
  twi_ = reinterpret_cast<avr_twi_t*>(FindPeripheral(avr, "twi"));
  TAUT_ASSERT(twi_ != nullptr);
  OnWrite(avr, kTwcr, WriteControl, this);
  OnWrite(avr, kTwsr, WriteStatus, this);
  OnWrite(avr, kTwdr, WriteData, this);
  for (const std::uint16_t address : {kTwcr, kTwsr, kTwdr}) OnRead(avr, address, nullptr, nullptr);
  AfterReset();
}

void TwiSlave::AfterReset() {
  state_ = State::kIdle;
  holds_ = acked_ = last_byte_ = false;
  released_ = clock_.StartOf(avr_.cycle);
  avr_.data[kTwcr] = 0;
  avr_.data[kTwsr] = kTwiIdle;
  avr_.data[kTwdr] = 0xFF;
  avr_.data[kTwar] = 0xFE;
  if (pending_) Schedule(event_);
}

void TwiSlave::SetPowered(bool powered) {
  if (powered_ && !powered) {
    avr_clear_interrupt(&avr_, &twi_->twi);
    state_ = State::kIdle;
    holds_ = acked_ = pending_ = false;
  }
  powered_ = powered;
}

bool TwiSlave::Enabled(std::uint8_t bit) const { return (avr_.data[kTwcr] & bit) != 0; }

std::uint8_t TwiSlave::NextByte() const {
  return powered_ && state_ == State::kSending ? shift_ : 0xFF;
}

void TwiSlave::Schedule(const BusEvent& event) {
  pending_ = powered_;
  if (!powered_) return;
  event_ = event;
  const std::uint64_t at = clock_.CycleAt(event.at);
  if (at > avr_.cycle) {
    avr_cycle_timer_register(&avr_, at - avr_.cycle, Fire, this);
  } else {
    // The event falls into a cycle or instruction that the core has completed. It is handled at
    // once, because the core may not run again before the bus reads the state.
    pending_ = false;
    Handle(event);
  }
}

std::uint64_t TwiSlave::Fire(avr_t* /*avr*/, std::uint64_t /*when*/, void* self) {
  auto& slave = *static_cast<TwiSlave*>(self);
  slave.pending_ = false;
  slave.Handle(slave.event_);
  return 0;
}

void TwiSlave::Handle(const BusEvent& event) {
  acked_ = false;
  if (!Enabled(kTwen)) return;
  switch (event.kind) {
    case BusEvent::Kind::kStart:
      if (state_ == State::kReceiving || state_ == State::kCalled) {
        state_ = State::kIdle;
        Raise(kTwiStop, true);
      } else {
        state_ = State::kIdle;
        // The program processes a pending event before the address continues.
        holds_ = Enabled(kTwint);
      }
      return;
    case BusEvent::Kind::kAddress:
      return HandleAddress(event.byte);
    case BusEvent::Kind::kByte:
      return HandleByte(event);
    case BusEvent::Kind::kStop: {
      const bool ends = state_ == State::kReceiving || state_ == State::kCalled;
      state_ = State::kIdle;
      if (ends) Raise(kTwiStop, false);
      return;
    }
    case BusEvent::Kind::kError:
      if (state_ == State::kIdle) return;
      state_ = State::kIdle;
      Raise(kTwiBusError, false);
      return;
  }
}

void TwiSlave::HandleAddress(std::uint8_t byte) {
  state_ = State::kIdle;
  if (!Enabled(kTwea)) return;
  const std::uint8_t own = avr_.data[kTwar];
  const auto care = static_cast<std::uint8_t>(~avr_.data[kTwamr] & 0xFE);
  const bool reads = (byte & 1) != 0;
  if (byte == 0 && (own & kGeneralCallEnable) != 0) {
    state_ = State::kCalled;
    acked_ = true;
    Raise(kTwiCalled, true);
  } else if (((byte ^ own) & care) == 0) {
    state_ = reads ? State::kSending : State::kReceiving;
    acked_ = true;
    Raise(reads ? kTwiAddressedToSend : kTwiAddressed, true);
  }
}

void TwiSlave::HandleByte(const BusEvent& event) {
  const bool called = state_ == State::kCalled;
  if (called || state_ == State::kReceiving) {
    acked_ = Enabled(kTwea);
    avr_.data[kTwdr] = event.byte;
    if (!acked_) state_ = State::kIdle;
    if (called) return Raise(acked_ ? kTwiCallData : kTwiCallDataNoAck, true);
    return Raise(acked_ ? kTwiData : kTwiDataNoAck, true);
  }
  if (state_ != State::kSending) return;
  if (event.master_reads && event.master_acked && !last_byte_) return Raise(kTwiSent, true);
  state_ = State::kIdle;
  Raise(event.master_reads && event.master_acked ? kTwiLastSent : kTwiSentNoAck, true);
}

void TwiSlave::Raise(TwiStatus status, bool holds) {
  avr_.data[kTwsr] = static_cast<std::uint8_t>(status | (avr_.data[kTwsr] & kPrescaler));
  avr_.data[kTwcr] |= kTwint;
  holds_ = holds;
  avr_raise_interrupt(&avr_, &twi_->twi);
}

void TwiSlave::Release() {
  avr_clear_interrupt(&avr_, &twi_->twi);
  avr_.data[kTwcr] &= static_cast<std::uint8_t>(~kTwint);
  if (!holds_) return;
  holds_ = false;
  released_ = clock_.StartOf(avr_.cycle);
}

void TwiSlave::WriteControl(avr_t* avr, std::uint16_t address, std::uint8_t value, void* self) {
  auto& slave = *static_cast<TwiSlave*>(self);
  const std::uint8_t old = avr->data[address];
  constexpr std::uint8_t kStored = kTwea | kTwen | kTwie;
  avr->data[address] = static_cast<std::uint8_t>((value & kStored) | (old & (kTwint | kTwwc)));
  if ((value & kTwen) == 0) {
    slave.state_ = State::kIdle;
    slave.Release();
    return;
  }
  if ((value & kTwsto) != 0)
    slave.state_ = State::kIdle;  // a slave releases the lines; no stop is sent
  if ((value & kTwint) != 0) {
    slave.shift_ = avr->data[kTwdr];
    slave.last_byte_ = (value & kTwea) == 0;
    slave.Release();
  } else if ((old & kTwint) != 0 && (old & kTwie) == 0 && (value & kTwie) != 0) {
    avr_raise_interrupt(avr, &slave.twi_->twi);
  }
}

void TwiSlave::WriteStatus(avr_t* avr, std::uint16_t address, std::uint8_t value, void* /*self*/) {
  avr->data[address] =
      static_cast<std::uint8_t>((avr->data[address] & ~kPrescaler) | (value & kPrescaler));
}

void TwiSlave::WriteData(avr_t* avr, std::uint16_t address, std::uint8_t value, void* /*self*/) {
  if ((avr->data[kTwcr] & kTwint) != 0) {
    avr->data[address] = value;
    avr->data[kTwcr] &= static_cast<std::uint8_t>(~kTwwc);
  } else {
    avr->data[kTwcr] |= kTwwc;  // too late or too early: the byte is lost
  }
}

}  // namespace taut::virtual_robot
