/// I2C slave interface of an ATmega328P at register level (data sheet, chapter "2-wire Serial
/// Interface"). Replaces the one of simavr 1.6, which has no general call, sends one byte per read,
/// never reports a stop and cannot stretch the clock.
#pragma once

#include <cstdint>

#include "apps/virtual_robot/i2c_bus.h"

struct avr_t;
struct avr_twi_t;

namespace taut::virtual_robot {

/// Status codes: the register TWSR without the prescaler.
enum TwiStatus : std::uint8_t {
  kTwiBusError = 0x00,
  kTwiAddressed = 0x60,  ///< Addressed for writing; acknowledged.
  kTwiCalled = 0x70,     ///< Addressed by general call; acknowledged.
  kTwiData = 0x80,       ///< Byte received and acknowledged ...
  kTwiDataNoAck = 0x88,  ///< ... or not.
  kTwiCallData = 0x90,
  kTwiCallDataNoAck = 0x98,
  kTwiStop = 0xA0,  ///< A stop or a repeated start ended the transfer.
  kTwiAddressedToSend = 0xA8,
  kTwiSent = 0xB8,       ///< Byte sent and acknowledged ...
  kTwiSentNoAck = 0xC0,  ///< ... or not: the master has enough.
  kTwiLastSent = 0xC8,   ///< Acknowledged although TWEA marked it as the last byte.
  kTwiIdle = 0xF8
};

/// Slave of one core, in the core's registers and time.
class TwiSlave : public I2cSlave {
 public:
  /// Handles the registers TWCR, TWSR and TWDR of `avr`, which must outlive the slave. Times are
  /// relative to `clock`.
  TwiSlave(avr_t& avr, const BoardClock& clock);
  TwiSlave(const TwiSlave&) = delete;
  TwiSlave& operator=(const TwiSlave&) = delete;

  void Schedule(const BusEvent& event) override;
  bool Powered() const override { return powered_; }
  bool HoldsClock() const override { return powered_ && holds_; }
  Time ReleasedAt() const override { return released_; }
  bool Acked() const override { return powered_ && acked_; }
  std::uint8_t NextByte() const override;

  /// Must be called after every reset of the core, which clears all registers and timers.
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
  avr_twi_t* twi_ = nullptr;  ///< simavr's object, for its interrupt vector.
  State state_ = State::kIdle;
  BusEvent event_;
  bool pending_ = false;
  bool powered_ = true, holds_ = false, acked_ = false, last_byte_ = false;
  std::uint8_t shift_ = 0xFF;
  Time released_ = 0;
};

}  // namespace taut::virtual_robot
