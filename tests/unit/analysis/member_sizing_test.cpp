// Lightest rods and cables: they are exactly at their limits, computed from discretized beams.
#include "taut/member_sizing.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace taut {
namespace {

SizingTask Aluminium(double length_m, const std::vector<double>& force_n) {
  SizingTask task;
  task.name = "strut";
  task.material = {70e9, 200e6, 2700};
  task.length_m = length_m;
  task.force_n = force_n;
  return task;
}

/// Returns the least N with E I w'' + N w = 0 and w = 0 at both ends, by finite differences over n
/// pieces, which lower it by the fraction (pi / n)^2 / 12.
double BucklingLoad(double bending_stiffness, double length_m, int n) {
  const double piece = length_m / n;
  Eigen::MatrixXd curve = Eigen::MatrixXd::Zero(n - 1, n - 1);
  for (int i = 0; i + 1 < n; ++i) {
    curve(i, i) = 2;
    if (i > 0) curve(i, i - 1) = curve(i - 1, i) = -1;
  }
  return bending_stiffness / (piece * piece) *
         Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(curve).eigenvalues()[0];
}

TEST(MemberSizing, ALongRodIsAtTheLoadAtWhichItBuckles) {
  SizingTask task = Aluminium(3, {-2000, 500, -1200});
  task.buckling_factor = 2.5;
  for (const double inner : {0.0, 0.8}) {
    task.inner_radius_share = inner;
    Diagnostics out;
    const auto rod = LightestRod(task, out);
    ASSERT_TRUE(rod) << out.Format();
    EXPECT_EQ(rod->limit, SizingLimit::kBuckling);
    const double load = BucklingLoad(70e9 * rod->member.second_moment_m4, 3, 60);
    EXPECT_NEAR(load / (2.5 * 2000), 1 - std::numbers::pi * std::numbers::pi / (12 * 60 * 60),
                1e-7);
    // Second moment of the section, by summing rings
    double moment = 0, area = 0;
    constexpr int kRings = 20000;
    for (int i = 0; i < kRings; ++i) {
      const double width = rod->radius_m * (1 - inner) / kRings;
      const double r = rod->radius_m * inner + (i + 0.5) * width;
      area += 2 * std::numbers::pi * r * width, moment += std::numbers::pi * r * r * r * width;
    }
    EXPECT_NEAR(rod->member.second_moment_m4 / moment, 1, 1e-8);
    EXPECT_NEAR(rod->mass_kg, 2700 * area * 3, 1e-8);
  }
}

TEST(MemberSizing, AShortRodYieldsFirst) {
  SizingTask task = Aluminium(0.02, {-2000, 4000});
  task.yield_factor = 1.5;
  Diagnostics out;
  const auto rod = LightestRod(task, out);
  ASSERT_TRUE(rod);
  EXPECT_EQ(rod->limit, SizingLimit::kYield);
  EXPECT_NEAR(4000 / rod->member.area_m2, 200e6 / 1.5, 1e-3);
}

TEST(MemberSizing, ATubeOfTheSameStrengthIsLighter) {
  SizingTask task = Aluminium(2, {-1000});
  Diagnostics out;
  const double solid = LightestRod(task, out)->mass_kg;
  task.inner_radius_share = 0.9;
  // m ~ sqrt((1 - c^2) / (1 + c^2)) at the same Euler load
  EXPECT_NEAR(LightestRod(task, out)->mass_kg / solid, std::sqrt(0.19 / 1.81), 1e-12);
}

TEST(MemberSizing, SlendernessAndNothingAtAll) {
  SizingTask task = Aluminium(2, {});
  Diagnostics out;
  EXPECT_EQ(LightestRod(task, out)->limit, SizingLimit::kNothing);
  EXPECT_EQ(LightestRod(task, out)->mass_kg, 0);
  task.slenderness = 150;
  const auto rod = LightestRod(task, out);
  EXPECT_EQ(rod->limit, SizingLimit::kSlenderness);
  const double gyration = std::sqrt(rod->member.second_moment_m4 / rod->member.area_m2);
  EXPECT_NEAR(2 / gyration, 150, 1e-9);
}

TEST(MemberSizing, ACableBearsItsLargestTension) {
  SizingTask task = Aluminium(2, {100, 700, 0});
  task.material.young_pa = 0;
  task.yield_factor = 3;
  Diagnostics out;
  const auto cable = LightestCable(task, out);
  ASSERT_TRUE(cable) << out.Format();
  EXPECT_NEAR(cable->member.strength_n, 2100, 1e-9);
  EXPECT_NEAR(cable->mass_kg, 2700 * 2 * 2100 / 200e6, 1e-12);
}

TEST(MemberSizing, WrongTasksAreComplainedOfAllAtOnce) {
  SizingTask task;
  task.name = "a";
  task.force_n = {-1};
  task.inner_radius_share = 1;
  task.slenderness = 0;
  task.buckling_length_m = -1;
  task.yield_factor = task.buckling_factor = 0;
  Diagnostics out;
  EXPECT_FALSE(LightestRod(task, out));
  EXPECT_EQ(out.Format(),
            "error: a: Young's modulus must be a number above 0\n"
            "error: a: the buckling length must be a finite number of at least 0\n"
            "error: a: the density must be a number above 0\n"
            "error: a: the length must be a number above 0\n"
            "error: a: the ratio of inner to outer radius must be at least 0 and below 1\n"
            "error: a: the safety factor of buckling must be a number above 0\n"
            "error: a: the safety factor of yielding must be a number above 0\n"
            "error: a: the slenderness must be a number above 0\n"
            "error: a: the yield stress must be a number above 0\n");
  Diagnostics cable;
  task = Aluminium(1, {-1, std::nan("")});
  EXPECT_FALSE(LightestCable(task, cable));
  EXPECT_EQ(cable.Format(),
            "error: strut: forces must be finite numbers\n"
            "error: strut: forces of a cable must not be compressive (negative)\n");
}

}  // namespace
}  // namespace taut
