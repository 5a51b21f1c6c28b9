/// The board's own code behind a bus, run natively: the firmware's main loop around it, and two
/// motors on a bench (board/bench_motor.h).
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "board/bench_motor.h"

namespace taut::link {

class FakeBoard {
 public:
  explicit FakeBoard(int number) : number_(static_cast<std::uint8_t>(number)) {
    Begin(board::kPowerOn);
  }

  /// Resets the board: RAM is lost, motors keep their state.
  void Begin(std::uint8_t cause) {
    const board::Parameters parameters = core.parameters;
    core = {};
    core.parameters = parameters;
    if (nonce == 0) board::SetDefaults(core.parameters);
    board::Boot boot;
    boot.board = number_;
    boot.nonce = ++nonce;
    boot.reset_cause = cause;
    board::Start(boot, core);
    for (int m = 0; m < board::kMotors; ++m) {  // the encoder's counter is 0 at the board's start
      core.loops[m].encoder = motors[m].Encoder();
      core.loops[m].tension_counts = motors[m].Adc();
    }
    Publish();
  }
  /// Steps one millisecond.
  void Tick() {
    if (!there) return;
    if (looks_in_ticks_ > 0 && --looks_in_ticks_ == 0) {
      board::Receive(request_.data(), request_.size(), false, core);
      if (core.reply_due) Publish();
    }
    board::Inputs in{};
    in.elapsed = 1;
    in.driver_fault = driver_fault;
    for (int m = 0; m < board::kMotors; ++m) {
      in.adc[m] = motors[m].Adc();
      in.encoder[m] = motors[m].Encoder();
    }
    board::Tick(in, core);
    board::Feel(core);
    board::DoSlowWork(core);
    for (int m = 0; m < board::kMotors; ++m) {
      for (int i = 0; i < 10; ++i) {
        motors[m].Advance(core.loops[m].width / double{board::kFullWidth}, board::IsPowered(core),
                          1e-4);
      }
    }
    if (core.status_due) Publish();
  }
  /// Receives bytes; returns true if they are acknowledged.
  bool Hear(const std::vector<std::uint8_t>& bytes, bool to_all) {
    if (!there || (to_all ? deaf : mute)) return false;
    if (to_all) {
      board::Receive(bytes.data(), bytes.size(), true, core);
    } else {
      request_ = bytes;
      looks_in_ticks_ = 3;
    }
    return true;
  }
  /// Returns the frame for a read; nothing: the address is not acknowledged.
  std::optional<std::vector<std::uint8_t>> Say() {
    if (!there) return std::nullopt;
    std::vector<std::uint8_t> bytes(frame_, frame_ + sizeof frame_);
    if (core.reply_due && !always_replies) {
      core.reply_due = false;
      Publish();
    }
    return bytes;
  }
  bool IsPowered() const { return there && board::IsPowered(core); }

  board::Board core;
  board::BenchMotor motors[board::kMotors];
  bool there = true;            ///< Connected to the bus and powered.
  bool deaf = false;            ///< Ignores broadcasts.
  bool mute = false;            ///< Ignores requests.
  bool always_replies = false;  ///< Repeats the same reply forever.
  bool driver_fault = false;
  std::uint16_t nonce = 0;

 private:
  void Publish() {
    core.status_due = false;
    board::MakeFrame(core, frame_);
  }

  std::uint8_t number_;
  std::vector<std::uint8_t> request_;
  int looks_in_ticks_ = 0;  ///< Delay until the board handles a request.
  std::uint8_t frame_[board::kFrameSize] = {};
};

}  // namespace taut::link
