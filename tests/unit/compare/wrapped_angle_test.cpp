// Comparisons of recordings whose angles wrap or whose counters overflow
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "compare/wrapped_angle.h"
#include "taut/compare.h"

namespace taut {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Trace Angles(double from_s, double to_s, double step_s, const std::function<double(double)>& f,
             double period = 0) {
  Trace trace;
  trace.channels = {{"joint/hip/angle_rad", "rad", period}};
  trace.values.resize(1);
  for (int i = 0; from_s + step_s * i <= to_s + 1e-9; ++i) {
    trace.time_s.push_back(from_s + step_s * i);
    trace.values[0].push_back(f(trace.time_s.back()));
  }
  return trace;
}

/// A hinge that spins: 6.4 turns in 10 s. Chords between rows are exact.
double Spin(double t) { return 1.5 + 4.0 * t; }
double From0(double angle) { return angle - kTurn * std::floor(angle / kTurn); }
double FromMinusPi(double angle) { return std::remainder(angle, kTurn); }

void ExpectEqual(const Trace& a, const Trace& b, double rounding = 1e-12) {
  for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
    const Comparison found = Compare(one, other, {});
    ASSERT_EQ(found.channels.size(), 1u);
    EXPECT_LE(found.channels[0].rmse, rounding);
    EXPECT_LE(std::abs(found.channels[0].error.value), rounding);
    EXPECT_NEAR(found.channels[0].max_a.value, found.channels[0].max_b.value, 0.05);
    EXPECT_TRUE(found.wrapped_angles.empty());
  }
}

TEST(WrappedAngles, OfAPerfectRunCompareWithoutError) {
  const Trace run = Angles(0, 10, 0.01, Spin);
  for (const auto wrap : {From0, FromMinusPi}) {
    ExpectEqual(run, Angles(
                         0, 10, 0.01, [&](double t) { return wrap(Spin(t)); }, kTurn));
    // Other rows: a row between two others, of which one is a turn lower.
    ExpectEqual(run, Angles(
                         0.003, 10, 0.05, [&](double t) { return wrap(Spin(t)); }, kTurn));
    ExpectEqual(run, Angles(
                         0.003, 10, 0.002, [&](double t) { return wrap(Spin(t)); }, kTurn));
    // Missing rows hide turns.
    const auto with_gap = [&](double t) {
      return t > 3 && t < 7 ? std::numeric_limits<double>::quiet_NaN() : wrap(Spin(t));
    };
    ExpectEqual(run, Angles(0, 10, 0.01, with_gap, kTurn));
  }
}

TEST(WrappedAngles, OfTwoLogsCompareWithoutError) {
  ExpectEqual(Angles(
                  0, 10, 0.01, [](double t) { return From0(Spin(t)); }, kTurn),
              Angles(
                  0.002, 10, 0.03, [](double t) { return FromMinusPi(Spin(t)); }, kTurn));
}

TEST(WrappedAngles, KeepTheDifferenceOfARunThatIsWrong) {
  const Trace run = Angles(0, 10, 0.01, [](double t) { return Spin(t) + 0.25 + 3 * kTurn; });
  const Trace log = Angles(
      0, 10, 0.01, [](double t) { return From0(Spin(t)); }, kTurn);
  const ChannelComparison found = Compare(run, log, {}).channels.at(0);
  EXPECT_NEAR(found.bias, 0.25, 1e-12);
  EXPECT_NEAR(found.rmse, 0.25, 1e-12);
  EXPECT_NEAR(found.max_a.value - found.max_b.value, 0.25, 1e-12);
}

TEST(WrappedAngles, WithoutAPeriodAreReportedWithTheRemedy) {
  const Trace run = Angles(0, 10, 0.01, Spin);
  const Trace log = Angles(0, 10, 0.01, [](double t) { return From0(Spin(t)); });
  const Comparison found = Compare(run, log, {});
  EXPECT_GT(found.channels[0].rmse, 10);
  ASSERT_EQ(found.wrapped_angles.size(), 1u);
  EXPECT_TRUE(found.wrapped_angles[0].in_b);
  EXPECT_NEAR(found.wrapped_angles[0].time_s, (kTurn - 1.5) / 4, 0.01);
  const std::string table = ComparisonTable(found, "a", "b");
  EXPECT_NE(table.find("warning: angles of b that jump by a turn, first at 1.19 s (1): "
                       "joint/hip/angle_rad\n"
                       "  if they wrap, set \"wrap\": \"turn\" in their rule of a mapping (--map)"),
            table.npos)
      << table;
  const std::vector<std::string> lines = ComparisonLines(found, "a", "b");
  ASSERT_GT(lines.size(), 2u);
  EXPECT_EQ(lines[1],
            "warning: angles of b that jump by a turn, first at 1.19 s (1): joint/hip/angle_rad");
  EXPECT_EQ(lines[2], "if they wrap, set \"wrap\": \"turn\" in their rule of a mapping (--map)");
  EXPECT_NE(ComparisonJson(found, "a", "b").find(R"("wrapped_angles": [
    {
      "name": "joint/hip/angle_rad",
      "trace": "b",)"),
            std::string::npos);
  EXPECT_FALSE(Compare(log, run, {}).wrapped_angles.at(0).in_b);
}

TEST(WrappedAngles, AreAnglesWithJumpsWithinOneTurn) {
  const auto row = [](const char* name, const char* unit, std::vector<double> values) {
    return compare::FindWrap({name, unit}, values);
  };
  EXPECT_EQ(row("yaw_deg", "1", {350, 355, 1, 6}), 1u);
  EXPECT_EQ(row("yaw", "deg", {-170, -179, 178}), 1u);
  EXPECT_EQ(row("yaw_rad", "rad", {-3, NAN, 3.1}), 0u);
  EXPECT_FALSE(row("yaw_rad", "rad", {3, 3.1, 3.2, 6.2}));             // no jump of a turn
  EXPECT_FALSE(row("yaw_rad", "rad", {0, 1, 2, 7}));                   // more than a turn
  EXPECT_FALSE(row("cable/a/tension_n", "N", {350, 355, 1, 6}));       // no angle
  EXPECT_FALSE(compare::FindWrap({"yaw_rad", "rad", kTurn}, {6, 0}));  // its period is known
}

}  // namespace
}  // namespace taut
