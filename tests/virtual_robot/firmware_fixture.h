/// Fixture for the firmware on emulated boards: twelve motors on a bench, and a PC in virtual time
/// that communicates through the adapter
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_robot.h"
#include "board/bench_motor.h"

namespace taut::virtual_robot {

constexpr double kSpoolPerRotor_m = 6.8e-5;

inline std::shared_ptr<const AvrProgram> Firmware() {
  static const std::shared_ptr<const AvrProgram> program = [] {
    Diagnostics found;
    auto read = ReadAvrProgram(TAUT_FIRMWARE_ELF, found);
    EXPECT_TRUE(found.ok()) << found.Format();
    return read;
  }();
  return program;
}

struct Symbol {
  std::uint16_t address = 0;
  int size = 0;
};

/// Returns a variable of the firmware.
inline Symbol SymbolOf(const std::string& name) {
  std::ifstream in(TAUT_FIRMWARE_SYMBOLS);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string at, size, kind, is;
    if (words >> at >> size >> kind >> is && is == name) {
      return {static_cast<std::uint16_t>(std::stoul(at, nullptr, 16) & 0xffffu),
              std::stoi(size, nullptr, 16)};
    }
  }
  ADD_FAILURE() << "the firmware has no " << name;
  return {};
}

/// Motors and springs in closed form (board/bench_motor.h)
class BenchPlant : public Plant {
 public:
  BenchPlant() : motors(board::kCables) {}
  int motor_count() const override { return board::kCables; }
  void Advance(double duration_s, std::span<const MotorDrive> drives) override {
    for (std::size_t i = 0; i < motors.size(); ++i) {
      motors[i].Advance(drives[i].duty, drives[i].enabled, duration_s);
      most_n = std::max(most_n, motors[i].Tension());
    }
  }
  double LoadCellForce(int motor) const override {
    return motors[static_cast<std::size_t>(motor)].Tension();
  }
  double RotorAngle(int motor) const override {
    return motors[static_cast<std::size_t>(motor)].wound_m / kSpoolPerRotor_m;
  }
  void CutCable(int motor) override { motors[static_cast<std::size_t>(motor)].cut = true; }

  std::vector<board::BenchMotor> motors;
  double most_n = 0;
};

/// A PC: one broadcast and two reads of three boards each every 10 ms, as three frames over USB
class Master {
 public:
  explicit Master(Robot& robot) : robot_(robot) {}
  /// Starts the boards and configures the adapter. Must be called first.
  void Begin() {
    robot_.AdvanceTo(100 * kMillisecond);  // boards start
    const std::uint8_t mode[] = {0x5a, 0x02, 0x70, 0x04};
    robot_.Transfer(mode);
    start_ = robot_.now();
  }

  void Broadcast() {
    ++say.sequence;
    std::uint8_t frame[board::kCyclicSize];
    board::Encode(say, frame);
    Write(board::kBroadcastAddress, frame);
    say.clear_faults = false;
    sent.push_back({frame, frame + sizeof frame});
  }
  /// Reads all statuses. Unanswered frames leave a board's status unchanged.
  void ReadAll() {
    for (std::uint8_t first = 0; first < board::kBoards;
         first = static_cast<std::uint8_t>(first + 3)) {
      Bytes frame{0x57};
      for (std::uint8_t b = first; b < first + 3; ++b) {
        const auto address = static_cast<std::uint8_t>(board::BoardAddress(b) << 1 | 1);
        frame.insert(frame.end(), {0x01, 0x30, address, 0x2e, 0x04, 0x20, 0x03});
      }
      const auto reply = robot_.Transfer(frame, kPatience);
      const bool good = reply && reply->size() == 2 + 3 * board::kFrameSize && (*reply)[0] == 0xff;
      for (std::uint8_t b = first; b < first + 3; ++b) {
        std::uint8_t got[board::kFrameSize] = {};
        if (good)
          std::copy_n(reply->begin() + 2 + (b - first) * static_cast<int>(sizeof got), sizeof got,
                      got);
        if (!good || !board::IsFrame(got, sizeof got, b)) {
          ++bad_frames;
        } else if (!board::IsReply(got)) {
          status[b] = board::DecodeStatus(got);
          more[b][status[b].sequence % board::kMores] = status[b].more;
        }
      }
    }
  }
  void Cycle() {
    ++cycles_;
    Broadcast();
    ReadAll();
    longest = std::max(longest, robot_.now() - (start_ + (cycles_ - 1) * 10 * kMillisecond));
    if (robot_.now() >
        start_ + cycles_ * 10 * kMillisecond) {  // late: the next cycles are not shortened
      start_ = robot_.now() - cycles_ * 10 * kMillisecond;
    }
    robot_.AdvanceTo(start_ + cycles_ * 10 * kMillisecond);
  }
  void Run(double seconds) {
    const Time end = robot_.now() + static_cast<Time>(seconds * 1e9 + 0.5) * kNanosecond;
    while (robot_.now() < end - kMillisecond) Cycle();
  }
  void Silence(double seconds) {
    robot_.AdvanceTo(robot_.now() + static_cast<Time>(seconds * 1e9) * kNanosecond);
    start_ = robot_.now() - cycles_ * 10 * kMillisecond;
  }
  void ArmInto(board::Mode mode) {
    say.clear_faults = true;
    say.mode = board::Mode::kOff;
    say.arm = board::Arm::kReady;
    Run(0.03);
    say.arm = board::Arm::kGo;
    say.mode = mode;
    say.capture = mode == board::Mode::kImpedance;
    Run(0.03);
    say.capture = false;
  }
  /// As `ArmInto`, after a fault.
  void Recover(board::Mode mode) {
    const std::uint8_t adapter[] = {0x5a, 0x02, 0x70, 0x04};  // it may have been reset
    robot_.Transfer(adapter, kPatience);
    ArmInto(mode);
  }
  std::optional<board::Reply> Ask(std::uint8_t board, board::Asking asking) {
    std::uint8_t frame[board::kDoSize];
    const std::size_t size = board::Encode(asking, frame);
    Write(board::BoardAddress(board), {frame, size});
    robot_.AdvanceTo(robot_.now() + 3 * kMillisecond);
    const Bytes read{0x54, static_cast<std::uint8_t>(board::BoardAddress(board) << 1 | 1),
                     board::kFrameSize};
    const auto reply = robot_.Transfer(read);
    std::uint8_t got[board::kFrameSize] = {};
    if (!reply || reply->size() != sizeof got) return std::nullopt;
    std::copy(reply->begin(), reply->end(), got);
    if (!board::IsFrame(got, sizeof got, board) || !board::IsReply(got)) return std::nullopt;
    return board::DecodeReply(got);
  }
  /// Sets the reference of all motors at encoder count 0.
  void Reference() {
    for (std::uint8_t b = 0; b < board::kBoards; ++b) {
      const auto info = Ask(b, {board::Request::kAsk, 0xf0, board::kMotors, 0, 0});
      ASSERT_TRUE(info.has_value()) << int{b};
      for (std::uint8_t m = 0; m < board::kMotors; ++m) {
        const auto set =
            Ask(b, {board::Request::kDo, 0xe4, m, 0, board::DecodeInfo(info->payload).nonce});
        ASSERT_TRUE(set && set->answer == board::Answer::kGood) << int{b};
      }
    }
    start_ = robot_.now() - cycles_ * 10 * kMillisecond;
  }

  board::Cyclic say;
  board::Status status[board::kBoards];
  std::map<int, std::uint8_t> more[board::kBoards];
  std::vector<std::vector<std::uint8_t>> sent;  ///< Broadcasts.
  int bad_frames = 0;
  Time longest = 0;  ///< Longest time from a cycle's start to its last frame.

 private:
  void Write(std::uint8_t address, std::span<const std::uint8_t> bytes) {
    Bytes frame{0x54, static_cast<std::uint8_t>(address << 1),
                static_cast<std::uint8_t>(bytes.size())};
    frame.insert(frame.end(), bytes.begin(), bytes.end());
    robot_.Transfer(frame, kPatience);
  }

  static constexpr Time kPatience = 30 * kMillisecond;
  Robot& robot_;
  Time start_ = 0;
  std::int64_t cycles_ = 0;
};

}  // namespace taut::virtual_robot
