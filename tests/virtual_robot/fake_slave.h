/// Minimal I2C slave: reacts immediately, or holds the clock for a given time
#pragma once

#include <cstdint>
#include <vector>

#include "apps/virtual_robot/i2c_bus.h"

namespace taut::virtual_robot {

class FakeSlave : public I2cSlave {
 public:
  explicit FakeSlave(std::uint8_t address) : address_(address) {}

  void Schedule(const BusEvent& event) override {
    events.push_back(event);
    if (now && event.at < *now) late = true;
    acked_ = false;
    released_ = event.at;
    switch (event.kind) {
      case BusEvent::Kind::kAddress:
        sending_ = event.byte == (address_ << 1 | 1);
        receiving_ = event.byte == address_ << 1 || (event.byte == 0 && general_call);
        acked_ = sending_ || receiving_;
        break;
      case BusEvent::Kind::kByte:
        if (receiving_) received.push_back(event.byte);
        acked_ = receiving_ && received.size() <= takes;
        if (sending_) ++sent_;
        if (sending_ && !event.master_acked) sending_ = false;
        break;
      case BusEvent::Kind::kStart:
      case BusEvent::Kind::kStop:
      case BusEvent::Kind::kError:
        sending_ = receiving_ = false;
        return;
    }
    if (sending_ || receiving_) released_ += hold;
  }
  bool Powered() const override { return true; }
  bool HoldsClock() const override { return false; }
  Time ReleasedAt() const override { return released_; }
  bool Acked() const override { return acked_; }
  std::uint8_t NextByte() const override {
    return sending_ ? static_cast<std::uint8_t>(send_from + sent_) : 0xFF;
  }

  bool general_call = false;
  const Time* now = nullptr;     ///< Time up to which the slaves have run.
  bool late = false;             ///< True if an event came with a time before that.
  std::size_t takes = SIZE_MAX;  ///< Number of bytes to acknowledge.
  Time hold = 0;
  std::uint8_t send_from = 0x40;
  std::vector<std::uint8_t> received;
  std::vector<BusEvent> events;

 private:
  std::uint8_t address_;
  bool sending_ = false, receiving_ = false, acked_ = false;
  std::uint8_t sent_ = 0;
  Time released_ = 0;
};

}  // namespace taut::virtual_robot
