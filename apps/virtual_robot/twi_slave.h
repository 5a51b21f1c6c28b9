/// The two-wire interface of an ATmega328P as a slave, register by register (data sheet, chapter
/// "2-wire Serial Interface"). It replaces that of simavr 1.6, which knows no general call, sends
/// one byte a read, never reports a stop and cannot stretch the clock.
#pragma once

#include <cstdint>

#include "apps/virtual_robot/i2c_bus.h"

struct avr_t;
struct avr_twi_t;

namespace taut::virtual_robot {

/// Status codes, TWSR without the prescaler.
enum TwiStatus : std::uint8_t {
  kTwiBusError = 0x00,
  kTwiAddressed = 0x60,  ///< To be written to; acknowledged.
  kTwiCalled = 0x70,     ///< By a general call; acknowledged.
  kTwiData = 0x80,       ///< A byte came and was acknowledged ...
  kTwiDataNoAck = 0x88,  ///< ... or not.
  kTwiCallData = 0x90,
  kTwiCallDataNoAck = 0x98,
  kTwiStop = 0xA0,  ///< A stop or a repeated start ended it.
  kTwiAddressedToSend = 0xA8,
  kTwiSent = 0xB8,       ///< A byte went and was acknowledged ...
  kTwiSentNoAck = 0xC0,  ///< ... or not: the master has enough.
  kTwiLastSent = 0xC8,   ///< Acknowledged although TWEA had said that it was the last.
  kTwiIdle = 0xF8
};

/// Belongs to one core, whose registers and time it lives in.
class TwiSlave : public I2cSlave {
 public:
  /// Takes the registers TWCR, TWSR and TWDR of `avr`; it outlives the slave. Times are those of
  /// `clock`.
  TwiSlave(avr_t& avr, const BoardClock& clock);
  TwiSlave(const TwiSlave&) = delete;
  TwiSlave& operator=(const TwiSlave&) = delete;

  void Schedule(const BusEvent& event) override;
  bool Powered() const override { return powered_; }
  bool HoldsClock() const override { return powered_ && holds_; }
  Time ReleasedAt() const override { return released_; }
  bool Acked() const override { return powered_ && acked_; }
  std::uint8_t NextByte() const override;

  /// After every reset of the core, which has set all registers to zero and forgotten all timers.
  void AfterReset();
  void SetPowered(bool powered);

 private:
  enum class State { kIdle, kReceiving, kCalled, kSending };

  static void WriteControl(avr_t* avr, std::uint16_t address, std::uint8_t value, void* self);
  static void WriteStatus(avr_t* avr, std::uint16_t address, std::uint8_t value, void* self);
  static void WriteData(avr_t* avr, std::uint16_t address, std::uint8_t value, void* self);
  static std::uint64_t Fire(avr_t* avr, std::uint64_t when, void* self);

  void Handle(const BusEvent& event);
  void HandleAddress(std::uint8_t byte);
  void HandleByte(const BusEvent& event);
  void Raise(TwiStatus status, bool holds);
  void Release();
  bool Enabled(std::uint8_t bit) const;

  avr_t& avr_;
  const BoardClock& clock_;
  avr_twi_t* twi_ = nullptr;  ///< simavr's, for its interrupt vector.
  State state_ = State::kIdle;
  BusEvent event_;
  bool pending_ = false;
  bool powered_ = true, holds_ = false, acked_ = false, last_byte_ = false;
  std::uint8_t shift_ = 0xFF;
  Time released_ = 0;
};

}  // namespace taut::virtual_robot
