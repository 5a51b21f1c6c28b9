#include "virtual_robot/load_host.h"

#include <algorithm>

namespace taut::virtual_robot {
namespace {

constexpr Time kPeriod = 10 * kMillisecond;
constexpr std::uint8_t kMessageSize = 29, kFrameSize = 16, kFirstAddress = 0x10;

}  // namespace

bool LoadHost::Start() {
  const Bytes mode{0x5A, 0x02, 0x70, 0x04};  // 400 kHz
  return robot_.Transfer(mode) == Bytes{0xFF, 0x00};
}

void LoadHost::Cycle() {
  const Time begun = robot_.now();
  Bytes frame{0x54, 0x00, kMessageSize};
  frame.resize(3 + kMessageSize, 0);
  frame[3] = 0xC1;
  frame[4] = ++sequence_;
  robot_.Transfer(frame);
  for (int board = 0; board < robot_.board_count(); ++board) {
    const auto address = static_cast<std::uint8_t>((kFirstAddress + board) << 1 | 1);
    robot_.Transfer(Bytes{0x54, address, kFrameSize});
  }
  const double took_s = ToSeconds(robot_.now() - begun);
  ++cycles_;
  sum_s_ += took_s;
  longest_s_ = std::max(longest_s_, took_s);
  robot_.AdvanceTo(std::max(robot_.now(), begun + kPeriod));
}

}  // namespace taut::virtual_robot
