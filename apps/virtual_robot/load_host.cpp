#include "apps/virtual_robot/load_host.h"

#include <algorithm>

#include "taut/board/protocol.h"

namespace taut::virtual_robot {
namespace {

constexpr Time kPeriod = 10 * kMillisecond;
constexpr int kBoardsPerRequest =
    3;  // number of boards whose frames fit into one reply of the adapter
constexpr int kArmingCycles = 6;

}  // namespace

bool LoadHost::Start() {
  robot_.AdvanceTo(100 * kMillisecond);      // time for the boards to boot
  const Bytes mode{0x5A, 0x02, 0x70, 0x04};  // I2C mode at 400 kHz
  if (robot_.Transfer(mode) != Bytes{0xFF, 0x00}) return false;
  for (int i = 0; i < 2 * kArmingCycles; ++i) Cycle();
  cycles_ = 0;
  sum_s_ = longest_s_ = 0;
  robot_.bus().ForgetStretch();
  return true;
}

void LoadHost::Exchange() {
  board::Cyclic say;
  say.sequence = ++sequence_;
  say.arm = sequence_ <= kArmingCycles ? board::Arm::kReady : board::Arm::kGo;
  say.clear_faults = sequence_ <= kArmingCycles;
  say.mode = sequence_ <= kArmingCycles ? board::Mode::kOff : board::Mode::kImpedance;
  say.capture = true;
  if (sequence_ == UINT8_MAX) sequence_ = kArmingCycles;
  std::uint8_t message[board::kCyclicSize];
  board::Encode(say, message);
  Bytes frame{0x54, board::kBroadcastAddress << 1, board::kCyclicSize};
  frame.insert(frame.end(), std::begin(message), std::end(message));
  robot_.Transfer(frame);
  for (int first = 0; first < robot_.board_count(); first += kBoardsPerRequest) {
    Bytes request{0x57};
    const int end = std::min(first + kBoardsPerRequest, robot_.board_count());
    for (int board = first; board < end; ++board) {
      const int address = board::BoardAddress(static_cast<std::uint8_t>(board)) << 1 | 1;
      // start, address, all bytes but the last, the last without an acknowledgement, stop
      request.insert(request.end(), {0x01, 0x30, static_cast<std::uint8_t>(address),
                                     0x20 + board::kFrameSize - 2, 0x04, 0x20, 0x03});
    }
    robot_.Transfer(request);
  }
}

void LoadHost::Cycle() {
  const Time begun = robot_.now();
  Exchange();
  const double took_s = ToSeconds(robot_.now() - begun);
  ++cycles_;
  sum_s_ += took_s;
  longest_s_ = std::max(longest_s_, took_s);
  robot_.AdvanceTo(std::max(robot_.now(), begun + kPeriod));
}

}  // namespace taut::virtual_robot
