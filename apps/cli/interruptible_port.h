/// Serial port that closes at a deadline after an interrupt: later operations fail. So no command
/// hangs on an adapter that is silent, slow or flooding.
#pragma once

#include <memory>
#include <utility>

#include "interrupt.h"
#include "taut/link/port.h"

namespace taut::cli {

class InterruptiblePort final : public link::Port {
 public:
  explicit InterruptiblePort(std::unique_ptr<link::Port> port) : port_(std::move(port)) {}

  bool Write(std::span<const std::uint8_t> frame) override {
    return !IsOver() && port_->Write(frame);
  }
  link::Bytes Read() override { return port_->Read(); }
  void Wait(double until_s) override { port_->Wait(until_s); }
  double now_s() const override { return port_->now_s(); }
  bool is_open() const override { return !IsOver() && port_->is_open(); }
  bool Reopen() override { return !IsOver() && port_->Reopen(); }

 private:
  /// Time after the interrupt for an emergency stop and the boards' confirmation.
  static constexpr double kGrace_s = 0.7;

  bool IsOver() const {
    if (!interrupt_asked) return false;
    if (asked_s_ < 0) asked_s_ = port_->now_s();
    return port_->now_s() > asked_s_ + kGrace_s;
  }

  std::unique_ptr<link::Port> port_;
  mutable double asked_s_ = -1;
};

}  // namespace taut::cli
