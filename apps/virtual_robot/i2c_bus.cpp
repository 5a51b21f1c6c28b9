#include "apps/virtual_robot/i2c_bus.h"

#include <algorithm>
#include <utility>

#include "base/assert.h"
#include "math/random.h"

namespace taut::virtual_robot {
namespace {

constexpr std::uint32_t kNoiseStream =
    0x4932'4300;  // random stream, different for each use of the robot's seed
constexpr int kBitsPerByte = 9;

}  // namespace

void I2cBus::Begin(Time now, std::vector<BusStep> steps, const BusTiming& timing,
                   bool stop_after_nack) {
  TAUT_ASSERT(!busy_ && !steps.empty());
  timing_ = timing;
  steps_ = std::move(steps);
  next_ = 0;
  busy_ = true;
  stop_after_nack_ = stop_after_nack;
  address_follows_ = false;
  blocked_ = abandoned_ = false;
  phase_ = Phase::kReady;
  happened_ = now;
  result_ = {};
  Step(now);
}

Time I2cBus::Duration(const BusStep& step) const {
  const bool is_byte = step.kind == BusStep::Kind::kWrite || step.kind == BusStep::Kind::kRead;
  return is_byte ? kBitsPerByte * timing_.bit + timing_.byte_gap : timing_.bit;
}

Time I2cBus::SafeUntil(Time now) const {
  if (phase_ == Phase::kIdle) return kNever;
  if (phase_ == Phase::kReady) return now + Duration(steps_[next_]);
  // The step after the scheduled step sets the limit: if a written byte remains unacknowledged, a
  // stop follows after one bit.
  const bool may_stop = steps_[next_].kind != BusStep::Kind::kRead || next_ + 1 == steps_.size();
  return event_.at + (may_stop ? timing_.bit : Duration(steps_[next_ + 1]));
}

void I2cBus::Step(Time now) {
  while (busy_) {
    if (phase_ == Phase::kScheduled) {
      if (now < event_.at) return;
      Look();
      continue;
    }
    const bool is_start = steps_[next_].kind == BusStep::Kind::kStart;
    Time free = happened_;
    bool held = clock_low_ || (is_start && data_low_);
    for (const I2cSlave* slave : slaves_) {
      held = held || slave->HoldsClock();
      free = std::max(free, slave->ReleasedAt());
    }
    if (held) {
      blocked_ = blocked_ || clock_low_ || data_low_;
      if (now - happened_ >= timing_.timeout) Finish(BusOutcome::kStuck, now);
      return;
    }
    if (std::exchange(blocked_, false))
      free = std::max(free, now);  // the end of the blocking was not observed
    Put(free);
  }
}

bool I2cBus::Flip() {
  if (flips_per_bit_ <= 0.0) return false;
  const bool flip = math::Random(seed_, kNoiseStream, drawn_++).Uniform() < flips_per_bit_;
  flipped_ += flip;
  return flip;
}

std::uint8_t I2cBus::Noisy(std::uint8_t byte) {
  for (int bit = 0; bit < 8; ++bit) {
    if (Flip()) byte = static_cast<std::uint8_t>(byte ^ (1U << bit));
  }
  return data_low_ ? 0 : byte;
}

void I2cBus::Put(Time at) {
  const BusStep& step = steps_[next_];
  const bool writes = step.kind == BusStep::Kind::kWrite, reads = step.kind == BusStep::Kind::kRead;
  event_ = {};
  event_.at = at + Duration(step);
  if (writes || reads) {
    stretch_.bytes += 1;
    stretch_.sum += at - happened_;
    stretch_.longest = std::max(stretch_.longest, at - happened_);
    // Sending a one releases the line: the wires carry the AND of all senders.
    std::uint8_t byte = writes ? step.byte : 0xFF;
    for (const I2cSlave* slave : slaves_) byte &= slave->NextByte();
    event_.kind = address_follows_ ? BusEvent::Kind::kAddress : BusEvent::Kind::kByte;
    event_.byte = Noisy(byte);
    event_.master_reads = reads;
    event_.master_acked = reads && (step.acknowledge != Flip() || data_low_);
    if (std::exchange(disturb_, false)) event_.kind = BusEvent::Kind::kError;
    address_follows_ = false;
  } else if (step.kind == BusStep::Kind::kStart) {
    event_.kind = BusEvent::Kind::kStart;
    address_follows_ = true;
  } else {
    event_.kind = BusEvent::Kind::kStop;
  }
  for (I2cSlave* slave : slaves_) slave->Schedule(event_);
  phase_ = Phase::kScheduled;
}

void I2cBus::Look() {
  happened_ = event_.at;
  phase_ = Phase::kReady;
  if (event_.kind == BusEvent::Kind::kError || abandoned_) {
    return Finish(BusOutcome::kError, happened_);
  }
  const BusStep step = steps_[next_++];
  if (step.kind == BusStep::Kind::kRead) {
    result_.read.push_back(event_.byte);
  } else if (step.kind == BusStep::Kind::kWrite) {
    const bool pulled = std::any_of(slaves_.begin(), slaves_.end(),
                                    [](const I2cSlave* slave) { return slave->Acked(); });
    if (pulled != Flip() || data_low_) {
      result_.written += 1;
    } else {
      result_.outcome = BusOutcome::kNoAcknowledge;
      if (!stop_after_nack_) return Finish(result_.outcome, happened_);
      while (next_ < steps_.size() && steps_[next_].kind != BusStep::Kind::kStop) ++next_;
    }
  }
  if (next_ == steps_.size()) Finish(result_.outcome, happened_);
}

void I2cBus::Abandon(Time now) {
  abandoned_ = true;
  if (phase_ == Phase::kReady) Finish(BusOutcome::kError, now);
}

void I2cBus::Finish(BusOutcome outcome, Time at) {
  result_.outcome = outcome;
  result_.ended = at;
  busy_ = false;
  phase_ = Phase::kIdle;
}

}  // namespace taut::virtual_robot
