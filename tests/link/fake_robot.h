/// A simple fake robot: boards that run natively, a USB-ISS adapter with scripted faults, and a
/// simulated clock. It needs no emulator.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "link/fake_board.h"
#include "taut/link/driver.h"
#include "taut/link/port.h"

namespace taut::link {

class FakeRobot final : public Port {
 public:
  explicit FakeRobot(int board_count = board::kBoards) {
    for (int b = 0; b < board_count; ++b) boards.push_back(std::make_unique<FakeBoard>(b));
  }

  // --- Port interface ----------------------------------------------------------------------------
  bool Write(std::span<const std::uint8_t> bytes) override {
    if (gone) open_ = false;
    if (!open_) return false;
    const Bytes frame(bytes.begin(), bytes.end());
    frames.emplace_back(now_s(), frame);
    // A frame sent before the reply to the last one would be lost.
    EXPECT_TRUE(!under_way_ || now_s() - written_s_ >= 0.03)
        << "a frame before the reply to the last";
    under_way_ = true;
    frame_ = frame;
    written_s_ = now_s();
    acts_us_ = now_us_ + 250;
    arrives_us_ = kNever;
    return true;
  }
  Bytes Read() override { return std::exchange(arrived_, {}); }
  void Wait(double until_s) override {
    const auto until_us =
        std::max(static_cast<std::int64_t>(std::ceil(until_s * 1e6 - 1e-3)), now_us_ + 1);
    while (now_us_ < until_us && arrived_.empty()) {
      GoTo(std::min({until_us, next_tick_us_, acts_us_, arrives_us_}));
    }
  }
  double now_s() const override { return static_cast<double>(now_us_) * 1e-6; }
  bool is_open() const override { return open_ && !gone; }
  bool Reopen() override {
    ++reopened;
    open_ = !gone;
    if (open_) mode_ = 0x40;  // it has been without power
    under_way_ = false;
    acts_us_ = arrives_us_ = kNever;
    arrived_.clear();
    return open_;
  }

  // --- Faults ------------------------------------------------------------------------------------
  /// Changes or replaces the adapter's reply; the adapter has executed the frame by then.
  std::function<void(const Bytes& frame, Bytes& reply)> spoil;
  /// Frames that are dropped: neither executed nor answered.
  std::function<bool(const Bytes& frame)> swallow;
  double delay_s = 0;  ///< Delay of replies.
  bool gone = false;   ///< Unplugged.
  std::uint8_t module_id = 7, firmware_version = 8;
  bool refuses_mode = false;
  int reopened = 0;

  // --- Record ------------------------------------------------------------------------------------
  std::vector<std::pair<double, Bytes>> frames;  ///< All frames written, with their times [s].
  /// Returns the broadcasts among them, from frame number `from` on.
  std::vector<board::Cyclic> Broadcasts(std::size_t from = 0) const {
    std::vector<board::Cyclic> all;
    for (std::size_t i = from; i < frames.size(); ++i) {
      const Bytes& frame = frames[i].second;
      if (frame.size() != 3 + board::kCyclicSize || frame[0] != 0x54 || frame[1] != 0) continue;
      board::Cyclic said;
      board::Command part;
      for (std::uint8_t first = 0; first < board::kCables; first += board::kMotors) {
        EXPECT_EQ(board::Decode(frame.data() + 3, board::kCyclicSize, first, part),
                  board::Decoded::kGood);
        for (int m = 0; m < board::kMotors; ++m) said.values[first + m] = part.values[m];
      }
      said.sequence = part.sequence;
      said.mode = part.mode;
      said.capture = part.capture;
      said.clear_faults = part.clear_faults;
      said.arm = part.arm;
      all.push_back(said);
    }
    return all;
  }
  static bool IsStopFrame(const Bytes& frame) {
    return frame == Bytes{0x54, 0x00, 0x04, 0xce, 'S', 'T', 0x39};
  }
  bool AnyPower() const {
    return std::any_of(boards.begin(), boards.end(), [](const auto& b) { return b->IsPowered(); });
  }

  std::vector<std::unique_ptr<FakeBoard>> boards;

 private:
  static constexpr std::int64_t kNever = INT64_MAX;

  void GoTo(std::int64_t us) {
    now_us_ = std::max(now_us_, us);
    if (now_us_ >= next_tick_us_) {
      for (const auto& board : boards) board->Tick();
      next_tick_us_ += 1000;
    }
    if (now_us_ >= acts_us_) {
      acts_us_ = kNever;
      Act();
    }
    if (now_us_ >= arrives_us_) {
      arrives_us_ = kNever;
      under_way_ = false;
      if (!gone) arrived_.insert(arrived_.end(), reply_.begin(), reply_.end());
    }
  }
  FakeBoard* At(std::uint8_t address) {
    const std::size_t b = static_cast<std::size_t>(address) - 0x10;
    return b < boards.size() ? boards[b].get() : nullptr;
  }
  void Act() {
    if (gone || (swallow && swallow(frame_))) return;
    reply_.clear();
    const std::size_t before = frame_.size();
    if (frame_[0] == 0x5a) {
      Identify();
    } else if (mode_ != 0x70) {
      return;
    } else if (frame_[0] == 0x54) {
      Transfer();
    } else if (frame_[0] == 0x57) {
      Direct();
    } else if (frame_[0] == 0x58) {
      const auto* const board = At(frame_[1] >> 1);
      reply_ = {static_cast<std::uint8_t>(board != nullptr && board->there ? 0xff : 0)};
    }
    if (spoil) spoil(frame_, reply_);
    if (reply_.empty()) return;
    const std::size_t bytes = before + reply_.size();
    arrives_us_ = now_us_ + 250 + 23 * static_cast<std::int64_t>(bytes) +
                  static_cast<std::int64_t>(delay_s * 1e6);
  }
  void Identify() {
    if (frame_[1] == 1) reply_ = {module_id, firmware_version, mode_};
    if (frame_[1] == 3) reply_ = {'0', '0', '0', '4', '2', '1', '0', '7'};
    if (frame_[1] != 2) return;
    if (refuses_mode) {
      reply_ = {0x00, 0x05};
    } else {
      mode_ = frame_[2];
      reply_ = {0xff, 0x00};
    }
  }
  void Transfer() {
    const std::uint8_t address = frame_[1] >> 1;
    FakeBoard* const board = At(address);
    if ((frame_[1] & 1) != 0) {
      const auto said = board != nullptr ? board->Say() : std::nullopt;
      reply_ = said.value_or(Bytes(frame_[2], 0xff));
      reply_.resize(frame_[2], 0xff);
      return;
    }
    const std::vector<std::uint8_t> bytes(frame_.begin() + 3, frame_.end());
    bool acknowledged = false;
    if (address == board::kBroadcastAddress) {
      for (const auto& one : boards) acknowledged = one->Hear(bytes, true) || acknowledged;
    } else if (board != nullptr) {
      acknowledged = board->Hear(bytes, false);
    }
    reply_ = {static_cast<std::uint8_t>(acknowledged ? 0xff : 0)};
  }
  void Direct() {
    reply_ = {0xff, 0};
    for (std::size_t at = 1; at + 6 < frame_.size(); at += 7) {
      FakeBoard* const board = At(frame_[at + 2] >> 1);
      const auto said = board != nullptr ? board->Say() : std::nullopt;
      if (!said) {
        reply_ = {0x00, 0x01};
        return;
      }
      reply_.insert(reply_.end(), said->begin(), said->end());
      reply_[1] = static_cast<std::uint8_t>(reply_.size() - 2);
    }
  }

  std::int64_t now_us_ = 1'000'000, next_tick_us_ = 1'000'100;
  std::int64_t acts_us_ = kNever, arrives_us_ = kNever;
  double written_s_ = 0;
  bool open_ = true, under_way_ = false;
  std::uint8_t mode_ = 0x40;
  Bytes frame_, reply_, arrived_;
};

/// A driver with such a robot of six boards, and its events.
struct Rig {
  explicit Rig(DriverOptions options = {}, int motors = board::kCables)
      : robot((motors + board::kMotors - 1) / board::kMotors) {
    options.motors = motors;
    driver = std::make_unique<Driver>(robot, options);
    driver->on_event = [this](double time_s, const std::string& text) {
      events.emplace_back(time_s, text);
    };
  }
  bool Configure(std::vector<Setting> settings = {}) {
    out = {};
    return driver->Configure(settings, out);
  }
  /// Configures and references the robot and enables this mode.
  void Run(board::Mode mode, bool capture = false) {
    ASSERT_TRUE(Configure()) << out.Format();
    for (std::size_t m = 0; m < state().motors.size(); ++m) {
      ASSERT_TRUE(driver->SetReference(static_cast<int>(m), 0.2, out)) << out.Format();
    }
    driver->ClearFaults();
    driver->Cycle(3);
    ASSERT_TRUE(driver->Enable(mode, capture, out)) << out.Format();
    driver->ForgetStatistics();
    events.clear();
  }
  int Heard(const std::string& text) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const auto& event) {
      return event.second.find(text) != std::string::npos;
    }));
  }
  std::string Events() const {
    std::string all;
    for (const auto& [time_s, text] : events) all += std::to_string(time_s) + " " + text + "\n";
    return all;
  }
  void ExpectAll(board::Mode mode) const {
    for (std::size_t b = 0; b < state().boards.size(); ++b) {
      EXPECT_EQ(ModeName(state().boards[b].status.mode), std::string(ModeName(mode))) << b;
    }
  }
  const State& state() const { return driver->state(); }
  FakeBoard& board(std::size_t b) { return *robot.boards.at(b); }

  FakeRobot robot;
  std::unique_ptr<Driver> driver;
  Diagnostics out;
  std::vector<std::pair<double, std::string>> events;
};

}  // namespace taut::link
