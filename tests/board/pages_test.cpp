// Agreement of docs/hardware with the headers of the boards.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>

#include "taut/board/board.h"

namespace taut::board {
namespace {

std::string Page(const std::string& name) {
  std::ifstream in(std::string(TAUT_SOURCE_DIR) + "/docs/hardware/" + name);
  std::ostringstream text;
  text << in.rdbuf();
  EXPECT_FALSE(text.str().empty()) << name;
  return text.str();
}

std::string Row(int number, const char* key, const Range& range) {
  char row[200];
  std::snprintf(row, sizeof row, "| %d | `%s` | %g | %g | %g |", number, key, double{range.value},
                double{range.least}, double{range.greatest});
  return row;
}

TEST(HardwarePages, HaveEveryParameterWithItsNumbers) {
  const std::string page = Page("parameters.md");
#define TAUT_CHECK(name, key, value, least, greatest)                                    \
  EXPECT_NE(page.find(Row(name, key, Range{value, least, greatest})), std::string::npos) \
      << Row(name, key, Range{value, least, greatest});
  TAUT_MOTOR_PARAMETERS(TAUT_CHECK)
  TAUT_BOARD_PARAMETERS(TAUT_CHECK)
#undef TAUT_CHECK
  char version[40];
  std::snprintf(version, sizeof version, "`0x%04x`", kParametersVersion);
  EXPECT_NE(page.find(version), std::string::npos) << version;
}

TEST(HardwarePages, HaveTheBytesOfTheirExamples) {
  const std::string page = Page("protocol.md");
  const auto hex = [](const std::uint8_t* bytes, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) {
      char byte[8];
      std::snprintf(byte, sizeof byte, "%s%02x", i == 0 ? "" : " ", bytes[i]);
      text += byte;
    }
    return text;
  };
  Cyclic cyclic;
  cyclic.sequence = 5;
  cyclic.mode = Mode::kImpedance;
  cyclic.capture = true;
  cyclic.arm = Arm::kGo;
  cyclic.values[0] = 500;
  cyclic.values[11] = -500;
  std::uint8_t broadcast[kCyclicSize], stop[kStopSize], frame[kFrameSize], request[kDoSize];
  Encode(cyclic, broadcast);
  EncodeStop(stop);
  Status status;
  status.sequence = 5;
  status.mode = Mode::kImpedance;
  status.motors[0] = {638, 640, 1000, 32};
  status.motors[1] = {400, 412, 65535, -3};
  Encode(status, 2, frame);
  EXPECT_NE(page.find(hex(broadcast, sizeof broadcast)), std::string::npos)
      << hex(broadcast, sizeof broadcast);
  EXPECT_NE(page.find(hex(stop, sizeof stop)), std::string::npos) << hex(stop, sizeof stop);
  EXPECT_NE(page.find(hex(frame, sizeof frame)), std::string::npos) << hex(frame, sizeof frame);
  for (const Asking& asking :
       {Asking{Request::kSet, kPositionGain, 1, 0x43fa0000u, 0},
        Asking{Request::kAsk, 0xf0, 2, 0, 0}, Asking{Request::kDo, 0xe4, 0, 1000, 7}}) {
    const std::size_t size = Encode(asking, request);
    EXPECT_NE(page.find(hex(request, size)), std::string::npos) << hex(request, size);
  }
}

}  // namespace
}  // namespace taut::board
