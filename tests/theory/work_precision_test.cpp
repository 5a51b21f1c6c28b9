/// Conclusions of docs/theory/work_precision.md as tests.

#include "tests/theory/work_precision.h"

#include <gtest/gtest.h>

#include <map>

namespace taut::test {
namespace {

using Curve = std::vector<WorkPoint>;

std::map<std::string, Curve> CurvesOf(const std::vector<WorkPoint>& points,
                                      const std::string& problem) {
  std::map<std::string, Curve> curves;
  for (const WorkPoint& point : points) {
    if (point.problem == problem) curves[point.scheme].push_back(point);
  }
  return curves;
}

TEST(WorkPrecision, OnSoftCablesTautIsOnTheLowestCurveAndLosesNothing) {
  const auto points = MeasureSoft();
  auto period = CurvesOf(points, "soft, period"), amplitude = CurvesOf(points, "soft, amplitude");
  const Curve &taut = period["taut"], &midpoint = period["implicit midpoint rows"];
  ASSERT_EQ(taut.size(), 9u);
  for (std::size_t i = 3; i < taut.size(); ++i) {  // explicit from w h = 0.16 on
    const double angle = taut[i].step_s * std::sqrt(400 / 0.1);
    EXPECT_DOUBLE_EQ(taut[i].visits_per_s * taut[i].step_s, 1) << angle;
    EXPECT_NEAR(taut[i].error / (angle * angle / 24), 1, 0.1) << angle;
    EXPECT_GE(midpoint[i].visits_per_s, 2 * taut[i].visits_per_s);
    EXPECT_NEAR(midpoint[i].error / taut[i].error, 2, 0.2) << angle;
    EXPECT_LT(amplitude["taut"][i].error, 1e-4) << angle;
    EXPECT_GT(amplitude["implicit Euler rows"][i].error, 0.7) << angle;
  }
  EXPECT_LT(amplitude["taut"][4].error, 1e-9);
}

TEST(WorkPrecision, OnStiffCablesTautIsStableRightAndKeepsTheEnergyAtEveryStep) {
  const auto points = MeasureStiff();
  auto tension = CurvesOf(points, "stiff, tension"), energy = CurvesOf(points, "stiff, energy");
  for (const WorkPoint& point : energy["taut"]) EXPECT_LT(point.error, 0.005) << point.step_s;
  for (const WorkPoint& point : tension["taut"]) {
    if (point.step_s > 1.5e-3) continue;
    EXPECT_LT(point.error, 1e-6) << point.step_s;
  }
  // The other schemes fail: they are unstable at a millisecond, or lose the energy.
  const auto at_1ms = [](const Curve& curve) { return curve[3]; };
  ASSERT_DOUBLE_EQ(at_1ms(energy["taut"]).step_s, 1e-3);
  EXPECT_FALSE(at_1ms(energy["symplectic Euler"]).error < 1);
  EXPECT_GT(at_1ms(energy["implicit Euler rows"]).error, 0.99);
  EXPECT_GT(at_1ms(energy["theta = 0.6 rows"]).error, 0.99);
}

}  // namespace
}  // namespace taut::test
