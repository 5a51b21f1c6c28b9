// Gaps of recordings and signs of quaternions in comparisons
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "compare/gaps.h"
#include "compare/orientation.h"
#include "taut/compare.h"

namespace taut {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
using OfTime = std::function<double(double)>;

Trace At(const std::vector<double>& time_s, const OfTime& f) {
  Trace trace;
  trace.time_s = time_s;
  trace.channels = {{"cable/a/tension_n", "N"}};
  trace.values.resize(1);
  for (const double t : time_s) trace.values[0].push_back(f(t));
  return trace;
}

std::vector<double> Rows(double from_s, double to_s, double step_s) {
  std::vector<double> times;
  const int count = static_cast<int>(std::round((to_s - from_s) / step_s));
  for (int i = 0; i <= count; ++i) times.push_back(from_s + step_s * i);
  return times;
}

std::vector<double> Joined(std::vector<double> a, const std::vector<double>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Returns a rotation about z by `angle_rad` of time; `sign` selects the quaternion's sign per row.
Trace Turning(const std::vector<double>& time_s, const OfTime& angle_rad, const OfTime& sign,
              const std::string& stem = "body/m/orientation_") {
  Trace trace;
  trace.time_s = time_s;
  trace.values.resize(4);
  for (const char* letter : {"w", "x", "y", "z"}) trace.channels.push_back({stem + letter, "1"});
  for (const double t : time_s) {
    trace.values[0].push_back(sign(t) * std::cos(0.5 * angle_rad(t)));
    trace.values[1].push_back(0.0);
    trace.values[2].push_back(0.0);
    trace.values[3].push_back(sign(t) * std::sin(0.5 * angle_rad(t)));
  }
  return trace;
}

double Same(double) { return 1.0; }
double Negated(double) { return -1.0; }
double FlipsAt2s(double t) { return t < 2 ? 1.0 : -1.0; }
double Alternates(double t) { return std::lround(100 * t) % 2 == 0 ? 1.0 : -1.0; }

TEST(CompareOrientation, SignsOfWholeQuaternionsDoNotCount) {
  const auto turn = [](double t) { return 0.9 * t; };
  const Trace a = Turning(Rows(0, 4, 0.01), turn, Same);
  for (const auto& sign : {OfTime(Negated), OfTime(FlipsAt2s), OfTime(Alternates)}) {
    const Trace b = Turning(Rows(0, 4, 0.01), turn, sign);
    for (const Comparison& found : {Compare(a, b, {}), Compare(b, a, {})}) {
      ASSERT_EQ(found.channels.size(), 4u);
      for (const ChannelComparison& c : found.channels) {
        EXPECT_LE(c.rmse, 1e-15) << c.name;
        EXPECT_LE(std::abs(c.max_a.value - c.max_b.value), 1e-15) << c.name;
      }
      EXPECT_TRUE(found.unknown_signs.empty());
    }
  }
}

TEST(CompareOrientation, SignsAreAlignedBeforeRowsAreInterpolated) {
  const auto turn = [](double t) { return 0.9 * t; };
  const Trace a = Turning(Rows(0, 4, 0.01), turn, Same);
  const Trace b = Turning(Rows(0.005, 3.995, 0.01), turn, FlipsAt2s);
  // Chords of a rotation of 4.5 mrad (half of the angle) per row: at most h^2 / 8.
  for (const ChannelComparison& c : Compare(a, b, {}).channels) EXPECT_LE(c.rmse, 2.6e-6) << c.name;
}

TEST(CompareOrientation, SignsAreOneForAllFourComponents) {
  // b is rotated by a further 0.4 rad, so that single components near 0 have opposite signs.
  const Trace a = Turning(
      Rows(0, 4, 0.01), [](double t) { return 0.9 * t - 0.2; }, Same);
  const Trace b = Turning(
      Rows(0, 4, 0.01), [](double t) { return 0.9 * t + 0.2; }, Alternates);
  const auto found = Compare(a, b, {}).channels;
  // At 0 s: sin(-0.1) - sin(0.1), not differences of absolute values.
  EXPECT_NEAR(found[3].bias, 0.0, 0.2);
  EXPECT_NEAR(std::abs(found[3].error.value), 2 * std::sin(0.1), 1e-12);
  EXPECT_EQ(found[3].error.time_s, 0.0);
}

TEST(CompareOrientation, UnitQuaternionsOfOtherNamesAreOrientations) {
  const auto turn = [](double t) { return 0.9 * t; };
  const Trace a = Turning(Rows(0, 4, 0.01), turn, Same, "imu_q");
  const Trace b = Turning(Rows(0, 4, 0.01), turn, Negated, "imu_q");
  for (const ChannelComparison& c : Compare(a, b, {}).channels) EXPECT_EQ(c.rmse, 0.0);
  // Four numbers without unit length are not a quaternion.
  Trace forces = a, others = b;
  for (Trace* trace : {&forces, &others}) {
    for (auto& values : trace->values) {
      for (double& value : values) value *= 3;
    }
  }
  EXPECT_GT(Compare(forces, others, {}).channels[0].rmse, 1.0);
}

TEST(CompareOrientation, AMissingComponentIsNamed) {
  const auto turn = [](double t) { return 0.9 * t; };
  const Trace a = Turning(Rows(0, 4, 0.01), turn, Same);
  Trace b = Turning(Rows(0, 4, 0.01), turn, Negated);
  b.channels.erase(b.channels.begin());
  b.values.erase(b.values.begin());
  const Comparison found = Compare(a, b, {});
  EXPECT_EQ(found.unknown_signs.size(), 3u);
  EXPECT_NE(ComparisonTable(found, "a", "b")
                .find("signs not aligned (a component of the quaternion is missing) (3): "
                      "body/m/orientation_x\n"),
            std::string::npos)
      << ComparisonTable(found, "a", "b");
}

TEST(CompareGaps, AreSpansMuchLongerThanTheDistancesAroundThem) {
  const auto gaps = [](const std::vector<double>& times) {
    return compare::GapSpans(times, compare::FindGaps(times));
  };
  using Spans = std::vector<std::pair<double, double>>;
  EXPECT_EQ(gaps(Rows(0, 9, 0.01)), Spans{});
  EXPECT_EQ(gaps(Joined(Rows(0, 3, 0.5), Rows(8, 10, 0.5))), (Spans{{3, 8}}));
  EXPECT_EQ(gaps(Joined(Rows(0, 2, 0.01), Rows(2.1, 4, 0.1))), Spans{}) << "another rate";
  EXPECT_EQ(gaps(Joined(Rows(0, 2, 0.01), Joined({3}, Rows(4, 6, 0.01)))).size(), 2u)
      << "a single row between two gaps";
  EXPECT_EQ(gaps({0, 5}), Spans{});
  EXPECT_EQ(gaps({}), Spans{});
}

std::vector<double> Weights(const std::vector<double>& times) {
  return compare::TimeWeights(times, compare::FindGaps(times));
}

TEST(CompareGaps, WeightsAreTheTimeForWhichRowsStand) {
  EXPECT_EQ(Weights(Rows(0, 1, 0.1)), std::vector<double>(11, 1.0));
  const auto weights = Weights({0, 1, 2, 4, 6, 8});
  const std::vector<double> expected{1, 1, 1.5, 2, 2, 2};
  EXPECT_EQ(weights, expected);
}

TEST(CompareGaps, ASpanWithoutRowsIsNotCompared) {
  const auto f = [](double t) { return 10 + 5 * std::sin(6 * t); };
  const Trace a = At(Rows(0, 10, 0.01), [&](double t) { return t > 3 && t < 8 ? 99 : f(t); });
  const Trace b = At(Joined(Rows(0, 3, 0.001), Rows(8, 10, 0.001)), f);
  CompareOptions options;
  options.phases = {{"all", 0, 10}};
  for (const bool swapped : {false, true}) {
    const Comparison found = swapped ? Compare(b, a, options) : Compare(a, b, options);
    const ChannelComparison& c = found.channels.at(0);
    EXPECT_LE(c.rmse, 1e-9);
    EXPECT_NEAR(c.missing_s, 5, 1e-9);
    EXPECT_NEAR(c.max_a.value, c.max_b.value, 1e-3) << "of times that both cover";
    EXPECT_NEAR(c.phases[0].a.mean, c.phases[0].b.mean, 0.01);
    EXPECT_NEAR((swapped ? found.a : found.b).step_s, 0.001, 1e-9) << "the usual one";
    const std::string table = ComparisonTable(found, "a", "b");
    EXPECT_NE(table.find(swapped ? "gaps of a, not compared: 3 .. 8 s\n"
                                 : "gaps of b, not compared: 3 .. 8 s\n"),
              std::string::npos)
        << table;
  }
}

TEST(CompareGaps, MissingValuesAreGapsOfBoth) {
  const auto f = [](double t) { return t; };
  const Trace a = At(Rows(0, 4, 0.01), f);
  Trace b = At(Rows(0, 4, 0.01), f);
  for (std::size_t i = 201; i < 390; ++i) b.values[0][i] = kMissing;
  for (std::size_t i = 391; i < 401; ++i) b.values[0][i] = kMissing;
  CompareOptions options;
  options.phases = {{"all", 0, 4}};
  const Comparison found = Compare(a, b, options);
  const ChannelComparison& c = found.channels.at(0);
  EXPECT_EQ(c.rmse, 0.0);
  EXPECT_NEAR(c.max_a.value, c.max_b.value, 1e-12);
  EXPECT_NEAR(c.phases[0].a.mean, c.phases[0].b.mean, 1e-12);
  EXPECT_NEAR(c.missing_s, 1.9 + 0.1, 1e-9);
  const std::string table = ComparisonTable(found, "a", "b");
  EXPECT_NE(
      table.find(
          "channels with missing values (1), seconds missing of 4 s:\n  cable/a/tension_n: 2 s\n"),
      std::string::npos)
      << table;
}

TEST(CompareGaps, MeansAreOverTimeNotOverRows) {
  // A ramp: 100 Hz for 2 s, then 10 Hz. Its mean over 4 s is 2.
  const auto ramp = [](double t) { return t; };
  const std::vector<double> times = Joined(Rows(0, 2, 0.01), Rows(2.1, 4, 0.1));
  const Trace a = At(times, ramp), b = At(times, [](double) { return 0.0; });
  CompareOptions options;
  options.phases = {{"all", 0, 4}};
  const ChannelComparison c = Compare(a, b, options).channels.at(0);
  EXPECT_NEAR(c.phases[0].a.mean, 2, 0.03);  // half a step of 0.1 s at the end
  EXPECT_NEAR(c.bias, 2, 0.03);
  EXPECT_NEAR(c.rmse, std::sqrt(16.0 / 3), 0.04);
}

}  // namespace
}  // namespace taut
