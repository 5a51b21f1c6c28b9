// Verdict and page of a simulation compared with a measurement: known biases and delays
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "taut/compare.h"

namespace taut {
namespace {

/// Two tensions and a height, at 100 Hz for 4 s. `bias` is added to the tensions; all lag by
/// `late_s`.
Trace Measured(double bias_n, double late_s) {
  Trace trace;
  trace.channels = {
      {"cable/a/tension_n", "N"}, {"cable/b/tension_n", "N"}, {"body/x/position_z_m", "m"}};
  trace.values.resize(3);
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.01 * i, s = std::sin(3 * (t - late_s)) + 0.3 * std::sin(7 * (t - late_s));
    trace.time_s.push_back(t);
    trace.values[0].push_back(10 + 2 * s - bias_n);
    trace.values[1].push_back(8 + s - bias_n);
    trace.values[2].push_back(1 + 0.01 * s);
  }
  return trace;
}

std::vector<std::string> VerdictOf(const Trace& a, const Trace& b) {
  return MeasuredVerdict(Compare(a, b, {}), "run", "lab.csv");
}

TEST(MeasuredVerdictTest, AConstantBiasOfForcesIsNamedWithItsCauses) {
  const auto lines = VerdictOf(Measured(0, 0), Measured(0.6, 0));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0],
            "run (a) against lab.csv (b): 3 of 3 measured channels, 0 .. 4 s, 100 rows per second");
  EXPECT_EQ(lines[1].find("cable/*/tension_n [N]: median bias 0.6 (+"), 0u) << lines[1];
  EXPECT_NE(lines[1].find("RMSE 0.6 to 0.6"), std::string::npos) << lines[1];
  EXPECT_EQ(lines[2],
            "a is larger in all 2 channels by a nearly constant amount: check the prestress, and "
            "the zero and gain of the load cells");
}

TEST(MeasuredVerdictTest, ACommonDelayIsNamed) {
  const auto lines = VerdictOf(Measured(0, 0), Measured(0, 0.05));
  ASSERT_EQ(lines.size(), 3u) << lines.back();
  EXPECT_EQ(lines[2].find("b is later than a by 0.05 s (median of 2): check the clock"), 0u)
      << lines[2];
}

/// Tensions that settle from a start, with noise in the measurement and a gain of its load cells.
Trace Settling(double gain, double noise_n) {
  Trace trace;
  trace.channels = {{"cable/a/tension_n", "N"}, {"cable/b/tension_n", "N"}};
  trace.values.resize(2);
  std::uint64_t state = 7;
  const auto noise = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return noise_n * (static_cast<double>(state >> 11) / 4503599627370496.0 - 1);
  };
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.02 * i, left = std::exp(-t / 0.3) * std::cos(6 * t);
    trace.time_s.push_back(t);
    trace.values[0].push_back(gain * (20 + 16 * left) + noise());
    trace.values[1].push_back(gain * (15 - 12 * left) + noise());
  }
  return trace;
}

TEST(MeasuredVerdictTest, AGainOfCellsThatSettleIsNoDelay) {
  for (const std::string& line : VerdictOf(Settling(1, 0), Settling(0.93, 0.25))) {
    EXPECT_EQ(line.find("earlier"), std::string::npos) << line;
    EXPECT_EQ(line.find("later"), std::string::npos) << line;
  }
}

TEST(MeasuredVerdictTest, WithoutPatternsThereAreTwoLines) {
  Trace b = Measured(0, 0);
  for (double& x : b.values[0]) x += 0.5;
  for (double& x : b.values[1]) x -= 0.5;
  EXPECT_EQ(VerdictOf(Measured(0, 0), b).size(), 2u);
  Trace other;
  other.channels = {{"cable/z/tension_n", "N"}};
  other.time_s = {0, 1};
  other.values = {{1, 2}};
  EXPECT_TRUE(VerdictOf(Measured(0, 0), other).empty());
}

TEST(MeasuredVerdictTest, ThePageHasTheVerdictBarsScatterAndCurves) {
  const Trace a = Measured(0, 0), b = Measured(0.6, 0);
  const std::string page = ComparisonPage(Compare(a, b, {}), a, b, "run <1>", "lab.csv", true);
  for (const char* part :
       {"run &lt;1&gt;", "by a nearly constant amount", "bias (filled) and RMSE (outline)",
        "a (simulated)", "cable/a/tension_n [N]", "<th>lag [s]</th>", "polyline", "</html>"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page.find("run <1>"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(MeasuredVerdictTest, ThePageOfTwoRunsCallsNeitherAMeasurement) {
  const Trace a = Measured(0, 0), b = Measured(0.6, 0);
  const std::string page = ComparisonPage(Compare(a, b, {}), a, b, "runs/a", "runs/b", false);
  for (const char* part :
       {"<h1>Two runs</h1>", "runs/a and runs/b differ in", "cable/a/tension_n"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  for (const char* word : {"measure", "simulat", "clock of the log"}) {
    EXPECT_EQ(page.find(word, page.find("<main>")), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace taut
