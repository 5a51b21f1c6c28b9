// Guessed mappings of logs as measurement programs write them. All logs in tests/data/logs contain
// the same motion, so each must read as the same values.
#include <cmath>
#include <fstream>
#include <numbers>

#include "taut/compare.h"
#include "taut/guess_mapping.h"
#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

constexpr std::size_t kRows = 11;
double Time_s(std::size_t row) { return 0.02 * static_cast<double>(row); }
double Tension_n(int cable, std::size_t row) {
  return 7.75 + 0.05 * static_cast<double>(row) + 1.5 * cable;
}
double Position_m(int axis, std::size_t row) {
  const double i = static_cast<double>(row);
  return axis == 0 ? 0.1 + 0.002 * i : axis == 1 ? -0.05 + 0.001 * i : 0.3 - 0.004 * i;
}

class GuessedLogs : public TraceFolder {
 protected:
  const RobotNames robot_{{"a0-c0", "a1-c1"}, {"strut"}, {"a0", "c0", "a1", "c1"}, {"knee"}};
  GuessedMapping guess_;

  /// Returns the log as the guessed mapping reads it.
  Trace Read(const std::string& path) {
    Diagnostics out;
    const auto guess = GuessMapping(path, robot_, out);
    EXPECT_TRUE(guess) << out.Format();
    if (!guess) return {};
    guess_ = *guess;
    const std::string map = WriteFile("guess.json", guess->text);
    const auto mapping = LoadMapping(map, out);
    const auto trace = mapping ? ReadMapped(path, *mapping, map, out) : std::nullopt;
    EXPECT_TRUE(trace) << out.Format() << guess->text;
    return trace.value_or(Trace{});
  }
  static std::string Log(const std::string& name) {
    return std::string(TAUT_SOURCE_DIR) + "/tests/data/logs/" + name;
  }
  static const std::vector<double>& Values(const Trace& trace, const std::string& name) {
    static const std::vector<double> none(kRows, NAN);
    const auto at = trace.Find(name);
    EXPECT_TRUE(at) << name;
    return at ? trace.values[*at] : none;
  }
  void ExpectTensions(const std::string& name, std::size_t doubts) {
    SCOPED_TRACE(name);
    const Trace trace = Read(Log(name));
    ASSERT_EQ(trace.time_s.size(), kRows);
    EXPECT_EQ(trace.channels.size(), 2u) << guess_.text;
    EXPECT_EQ(guess_.doubts.size(), doubts) << guess_.text;
    for (int cable = 0; cable < 2; ++cable) {
      const auto& values =
          Values(trace, cable == 0 ? "cable/a0-c0/tension_n" : "cable/a1-c1/tension_n");
      for (std::size_t row = 0; row < kRows; ++row) {
        EXPECT_NEAR(trace.time_s[row], Time_s(row), 1e-6);
        EXPECT_NEAR(values[row], Tension_n(cable, row), 1e-6);
      }
    }
  }
};

TEST_F(GuessedLogs, TensionsOfAllFormsAreTheSame) {
  ExpectTensions("german.csv", 0);
  ExpectTensions("labview.lvm", 1);  // its column of comments
  ExpectTensions("pandas.csv", 0);
  ExpectTensions("imperial.csv", 1);  // remarks
  ExpectTensions("clock.txt", 0);
  ExpectTensions("excel_unicode.txt", 0);
  ExpectTensions("rosbag.csv", 2);    // no units
  ExpectTensions("rostopic.csv", 3);  // no units, a number of messages
  ExpectTensions("matlab.mat", 1);    // other variables
}

TEST_F(GuessedLogs, CablesWithoutNamesAreTakenInOrderWithAWarning) {
  ExpectTensions("nameless.csv", 1);
  EXPECT_NE(guess_.doubts[0].find("in the order of the model"), std::string::npos);
  EXPECT_NE(guess_.text.find("// CHECK the order"), std::string::npos);
}

TEST_F(GuessedLogs, AxesOfOptiTrackAreTurned) {
  const Trace trace = Read(Log("optitrack.csv"));
  ASSERT_EQ(trace.time_s.size(), kRows);
  for (std::size_t row = 0; row < kRows; ++row) {
    EXPECT_NEAR(trace.time_s[row], Time_s(row), 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name = std::string("body/strut/position_") + "xyz"[axis] + "_m";
      EXPECT_NEAR(Values(trace, name)[row], Position_m(axis, row), 1e-6) << guess_.text;
    }
    // a turn about taut's z axis
    const double half = 0.025 * static_cast<double>(row);
    EXPECT_NEAR(Values(trace, "body/strut/orientation_w")[row], std::cos(half), 1e-6);
    EXPECT_NEAR(Values(trace, "body/strut/orientation_z")[row], std::sin(half), 1e-6);
    EXPECT_NEAR(Values(trace, "body/strut/orientation_x")[row], 0, 1e-6);
  }
}

TEST_F(GuessedLogs, MarkersHaveTheRateOfTheFile) {
  for (const char* name : {"vicon.csv", "qualisys.tsv"}) {
    SCOPED_TRACE(name);
    const Trace trace = Read(Log(name));
    ASSERT_EQ(trace.time_s.size(), kRows);
    for (std::size_t row = 0; row < kRows; ++row) {
      EXPECT_NEAR(trace.time_s[row], Time_s(row), 1e-12);
      for (int axis = 0; axis < 3; ++axis) {
        const std::string end = std::string("/position_") + "xyz"[axis] + "_m";
        EXPECT_NEAR(Values(trace, "node/a0" + end)[row], Position_m(axis, row), 1e-6)
            << guess_.text;
        EXPECT_NEAR(Values(trace, "node/c0" + end)[row], Position_m(axis, row) + 0.1, 1e-6);
      }
    }
  }
}

TEST_F(GuessedLogs, BagsOfRos2AreTraces) {
  const Trace trace = Read(Log("rosbag.mcap"));
  // messages of forces and poses alternate, 1 ms apart
  ASSERT_EQ(trace.time_s.size(), 2 * kRows);
  for (std::size_t row = 0; row < kRows; ++row) {
    EXPECT_NEAR(trace.time_s[2 * row], Time_s(row), 1e-9);
    EXPECT_EQ(Values(trace, "cable/a0-c0/tension_n")[2 * row], Tension_n(0, row)) << guess_.text;
    EXPECT_EQ(Values(trace, "cable/a1-c1/tension_n")[2 * row], Tension_n(1, row));
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name = std::string("body/strut/position_") + "xyz"[axis] + "_m";
      EXPECT_NEAR(Values(trace, name)[2 * row + 1], Position_m(axis, row), 1e-15);
    }
    EXPECT_NEAR(Values(trace, "body/strut/orientation_w")[2 * row + 1],
                std::cos(0.025 * static_cast<double>(row)), 1e-15);
  }
}

TEST_F(GuessedLogs, UnitsOfAClockAreNeverAssumedSilently) {
  Read(WriteFile("t.csv", "time,a0-c0 [N],a1-c1 [N]\n0,1,2\n20,1,2\n40,1,2\n"));
  ASSERT_EQ(guess_.doubts.size(), 1u);
  EXPECT_EQ(guess_.doubts[0], "the clock \"time\" has no unit: its step of 20 suggests ms");
}

/// Each log passed without a remark, or with a wrong one, in an earlier version.
TEST_F(GuessedLogs, WhatMayBeWrongIsNamed) {
  const auto doubt = [&](const std::string& text) {
    Diagnostics out;
    const auto guess = GuessMapping(WriteFile("t.csv", text), robot_, out);
    EXPECT_TRUE(guess) << out.Format();
    std::string all;
    for (const std::string& one : guess ? guess->doubts : std::vector<std::string>()) {
      all += one + "; ";
    }
    return all;
  };
  const auto expect = [&](const std::string& text, const std::string& part) {
    const std::string found = doubt(text);
    EXPECT_NE(found.find(part), std::string::npos) << text << found;
  };
  const std::string rows = "1200000000,1\n1200005000,2\n1200010000,3\n";
  expect("timestamp,a0-c0 [N]\n" + rows, "has no unit: its step of 5000 suggests us");
  expect("time_s,a0-c0 [N]\n1777000000000,1\n1777000000010,2\n",
         "stated in s, but its values are ms since 1970");
  expect("t [s],a0-c0 [N]\n0,1\n1,2\nt [s],a0-c0 [N]\n2,3\n3,4\n",
         "2 rows of numbers before line 4 are left out");
  expect("t [s];a0-c0 [N]\n0,01;995\n0,02;1.000\n0,03;1.005\n", "separators of thousands");
  expect("t [s],a0-c0 [N]\n0.5,1\n0.51,2\n0.52,3\n", "the first time, 0.5 s, becomes 0 s");
  expect("Time (mm:ss),a0-c0 [N]\n00:00,1\n00:01,2\n", "no column of increasing times");
  expect("t [s],elongation a0-c0 [mm]\n0,1\n1,2\n", "not assigned because of \"elongation\"");
  expect("t [s],a0-c0 desired [N]\n0,1\n1,2\n", "not assigned because of \"desired\"");
  expect("t [s],a0-c0 [daN]\n0,1\n1,2\n", "has the unknown unit \"daN\"");
  expect("t [s],upper a0-c0 [N]\n0,1\n1,2\n", "in spite of \"upper\"");
  expect("Frame,a0-c0 [N]\n0,1\n1,2\n", "no column of increasing times");
  // no unit: "in" is an input, "m" a mean
  EXPECT_EQ(doubt("t [s],a0-c0_in,a1-c1_m\n0,1,2\n1,2,3\n").find("length"), std::string::npos);
  // names in brackets
  EXPECT_EQ(doubt("t [s],Force (a0-c0) [N],Force (a1-c1) [N]\n0,1,2\n1,2,3\n"), "");
}

TEST_F(GuessedLogs, NumbersOfCablesNeedAWordBeforeThem) {
  const RobotNames robot{{"1", "2", "12"}, {}, {}, {}};
  Diagnostics out;
  const auto guess = GuessMapping(
      WriteFile("t.csv", "t [s],Dev12/ai1 cable 1 [N],cable_02 [N],CH12 [N]\n0,1,2,3\n1,4,5,6\n"),
      robot, out);
  ASSERT_TRUE(guess);
  EXPECT_NE(guess->text.find(R"("to":"cable/1/tension_n")"), std::string::npos) << guess->text;
  EXPECT_NE(guess->text.find(R"("to":"cable/2/tension_n")"), std::string::npos) << guess->text;
  EXPECT_EQ(guess->text.find(R"("to":"cable/12/tension_n")"), std::string::npos) << guess->text;
}

TEST_F(GuessedLogs, ALongerNameWinsOverOneThatItContains) {
  const RobotNames robot{{"outer 1", "outer 10", "outer 1 left"}, {}, {}, {}};
  Diagnostics out;
  const std::string path =
      WriteFile("t.csv", "t [s],outer_10 [N],Outer 01 LEFT [N],outer1 [N]\n0,1,2,3\n1,4,5,6\n");
  const auto guess = GuessMapping(path, robot, out);
  ASSERT_TRUE(guess);
  for (const char* rule : {R"({"from":"outer_10 [N]","to":"cable/outer 10/tension_n"})",
                           R"({"from":"Outer 01 LEFT [N]","to":"cable/outer 1 left/tension_n"})",
                           R"({"from":"outer1 [N]","to":"cable/outer 1/tension_n"})"}) {
    EXPECT_NE(guess->text.find(rule), std::string::npos) << guess->text;
  }
}

TEST_F(GuessedLogs, FilesWithoutRowsAreRefused) {
  for (const char* text : {"", "\n\n", "a,b\nc,d\n", "\x89PNG\r\n\x1a\n"}) {
    Diagnostics out;
    EXPECT_FALSE(GuessMapping(WriteFile("t.csv", text), robot_, out));
    EXPECT_FALSE(out.ok()) << text;
  }
}

}  // namespace
}  // namespace taut::test
