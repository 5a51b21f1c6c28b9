// Fault scripts: values read, and errors, which are reported all at once with their places
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "taut/faults.h"

namespace taut {
namespace {

const std::vector<std::string> kCables{"front", "back", "left"};

class FaultFile : public testing::Test {
 protected:
  std::optional<FaultScript> Load(const std::string& faults) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("taut_faults_" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << "taut: 1\nkind: faults\nname: f\nparameters: {begin_s: 0.25}\n"
                        << "faults:\n  - {kind: bus_error, at_s: begin_s}\n"
                        << faults;
    out_ = {};
    auto script = LoadFaults(path.string(), kCables, out_);
    std::filesystem::remove(path);
    return script;
  }
  /// Returns the messages, without the file's name and line, for one more entry.
  std::string Wrong(const std::string& fault) {
    EXPECT_FALSE(Load("  - " + fault + "\n")) << fault;
    std::string messages;
    for (const Diagnostic& d : out_.items()) {
      EXPECT_EQ(d.at.line, 7) << d.what;
      EXPECT_GT(d.at.column, 0);
      messages += d.what + (d.hint.empty() ? "" : " (" + d.hint + ")") + "\n";
    }
    return messages;
  }
  Diagnostics out_;
};

TEST_F(FaultFile, IsRead) {
  const auto script = Load(
      "  - {kind: clock_drift, at_s: 1, for_s: 2, board: 1, drift_ppm: -20.5}\n"
      "  - {kind: bus_stuck, at_s: 3, line: clock}\n"
      "  - {kind: stuck_load_cell, at_s: 4, cable: back, force_n: 12}\n"
      "  - {kind: bus_noise, at_s: 5, flips_per_bit: 1e-3}\n");
  ASSERT_TRUE(script) << out_.Format();
  EXPECT_EQ(script->name, "f");
  ASSERT_EQ(script->faults.size(), 5U);
  const auto& f = script->faults;
  EXPECT_EQ(f[0].kind, FaultKind::kBusError);
  EXPECT_EQ(f[0].at_s, 0.25);
  EXPECT_EQ(f[0].for_s, std::numeric_limits<double>::infinity());
  EXPECT_EQ(f[1].board, 1);
  EXPECT_EQ(f[1].drift_ppm, -20.5);
  EXPECT_EQ(f[1].for_s, 2.0);
  EXPECT_EQ(f[2].line, BusLine::kClock);
  EXPECT_EQ(f[3].cable, 1);
  EXPECT_EQ(f[3].force_n, 12.0);
  EXPECT_EQ(f[4].flips_per_bit, 1e-3);
}

TEST_F(FaultFile, EveryKindHasAName) {
  for (const char* name :
       {"clock_drift", "board_loss", "brown_out", "firmware_hang", "bus_noise", "bus_error",
        "bus_stuck", "cut_cable", "stuck_load_cell", "stuck_encoder", "driver_fault",
        "motor_supply_loss", "usb_loss", "host_killed"}) {
    const auto script =
        Load(std::string("  - {kind: ") + name + ", at_s: 1, board: 0, cable: front, line: data, " +
             "drift_ppm: 1, flips_per_bit: 0.5}\n");
    EXPECT_FALSE(script) << "no kind has them all";
    EXPECT_EQ(out_.Format().find("cannot be"), std::string::npos) << out_.Format();
  }
}

TEST_F(FaultFile, WhatIsMissingIsNamed) {
  EXPECT_EQ(Wrong("{kind: board_loss, at_s: 1}"),
            "fault needs the key \"board\" (required by `kind: board_loss`)\n");
  EXPECT_EQ(Wrong("{kind: clock_drift, at_s: 1}"),
            "fault needs the key \"board\" (required by `kind: clock_drift`)\n"
            "fault needs the key \"drift_ppm\" (required by `kind: clock_drift`)\n");
  EXPECT_EQ(Wrong("{kind: cut_cable}"),
            "fault needs the key \"at_s\"\n"
            "fault needs the key \"cable\" (required by `kind: cut_cable`)\n");
  EXPECT_EQ(Wrong("{at_s: 1, line: data}"), "fault needs the key \"kind\"\n");
}

TEST_F(FaultFile, WhatHasNoEffectIsRefused) {
  EXPECT_EQ(Wrong("{kind: usb_loss, at_s: 1, board: 0}"),
            "fault.board has no effect here (it is for kind: clock_drift, board_loss, brown_out, "
            "firmware_hang, driver_fault)\n");
  EXPECT_EQ(Wrong("{kind: stuck_encoder, at_s: 1, cable: front, force_n: 2}"),
            "fault.force_n has no effect here (it is for kind: stuck_load_cell)\n");
  EXPECT_EQ(Wrong("{kind: cut_cable, at_s: 1, cable: front, for_s: 2}"),
            "fault.for_s has no effect here (cut_cable has no duration)\n");
}

TEST_F(FaultFile, NamesAndNumbersOfTheRobotAreChecked) {
  EXPECT_EQ(Wrong("{kind: cut_cable, at_s: 1, cable: bakc}"),
            "there is no actuated cable \"bakc\" (did you mean \"back\"?)\n");
  EXPECT_EQ(Wrong("{kind: brown_out, at_s: 1, board: 2}"),
            "there is no board 2 (the robot has 3 motors, two per board; the first board is 0)\n");
  EXPECT_TRUE(Load("  - {kind: brown_out, at_s: 1, board: 1}\n"));
}

TEST_F(FaultFile, RangesAreChecked) {
  EXPECT_NE(Wrong("{kind: bus_error, at_s: -1}").find("fault.at_s"), std::string::npos);
  EXPECT_NE(Wrong("{kind: usb_loss, at_s: 0, for_s: 0}").find("fault.for_s"), std::string::npos);
  EXPECT_NE(Wrong("{kind: bus_noise, at_s: 0, flips_per_bit: 1.5}").find("flips_per_bit"),
            std::string::npos);
  EXPECT_NE(Wrong("{kind: bus_stuck, at_s: 0, line: sda}").find("data"), std::string::npos);
  EXPECT_NE(Wrong("{kind: hiccup, at_s: 0}").find("fault.kind cannot be \"hiccup\""),
            std::string::npos);
}

TEST_F(FaultFile, AllMistakesAreSaidAtOnce) {
  EXPECT_EQ(Wrong("{kind: cut_cable, at_s: soon, cable: x, boards: 1, for_s: 3}").empty(), false);
  EXPECT_EQ(out_.items().size(), 3U) << out_.Format();
}

TEST(FaultScripts, ThatAreShippedLoad) {
  std::vector<std::string> cables;
  for (const char* joint : {"1", "2"}) {
    for (const char* name : {"outer_right_", "outer_left_", "outer_top_", "inner_right_",
                             "inner_left_", "inner_top_"}) {
      cables.push_back(std::string(name) + joint);
    }
  }
  Diagnostics out;
  const auto day = LoadFaults(TAUT_SOURCE_DIR "/share/faults/bad_day.yaml", cables, out);
  ASSERT_TRUE(day) << out.Format();
  EXPECT_EQ(day->faults.size(), 15U) << "each kind once, one of them twice";
}

}  // namespace
}  // namespace taut
