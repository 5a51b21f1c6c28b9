// Load-displacement paths: von Mises truss against its closed form, slackening cables
#include "taut/load_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::test {
namespace {

constexpr double kHalf_m = 1, kRise_m = 0.25, kStiffness = 4e4;

/// Two bars from supports at (-+1, 0, 0) to a mass at height `rise_m`. Without weight.
ModelDef VonMisesTruss(double rise_m) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  BodyDef top;
  top.name = "top", top.mass_kg = 1, top.com_m = {0, 0, rise_m};
  top.inertia_kg_m2 = {.xx = 1e-3, .yy = 1e-3, .zz = 1e-3};
  def.bodies.push_back(top);
  def.nodes.push_back({.name = "top", .body = 0, .position_m = top.com_m});
  for (const double side : {-1.0, 1.0}) {
    JointDef bar;
    bar.name = side < 0 ? "left" : "right", bar.kind = JointKind::kDistance;
    bar.body_a = kWorld, bar.body_b = 0;
    bar.from_m = {side * kHalf_m, 0, 0}, bar.to_m = top.com_m;
    bar.stiffness = kStiffness, bar.rest = std::hypot(kHalf_m, rise_m);
    def.joints.push_back(bar);
  }
  AddJoint(def, JointKind::kPlane, kWorld, top.com_m, 0, top.com_m, {0, 1, 0});
  return def;
}

/// Downward force on the mass at a displacement w: both bars along z.
double ClosedForm(double w_m) {
  const double z = kRise_m - w_m, l0 = std::hypot(kHalf_m, kRise_m), l = std::hypot(kHalf_m, z);
  return 2 * kStiffness * (l0 - l) * z / l;
}

TEST(LoadPath, OfAVonMisesTrussPassesBothLimitPoints) {
  const ModelDef def = VonMisesTruss(kRise_m);
  LoadCaseSpec loads;
  loads.forces.push_back({0, {0, 0, -1}});
  LoadPathOptions options;
  options.to_factor = 1000, options.most_displacement = 2;
  const LoadPath path = FollowLoads(def, loads, options);
  EXPECT_EQ(path.why, "");
  ASSERT_GT(path.points.size(), 10u);
  double largest = 0;
  for (const LoadedPoint& point : path.points) {
    EXPECT_NEAR(point.displacement_m, kRise_m - point.pose.bodies[0].position_m.z, 1e-12);
    EXPECT_NEAR(point.load_factor, ClosedForm(point.displacement_m), 1e-6);
    largest = std::max(largest, point.displacement_m);
  }
  EXPECT_GT(largest, 2 * kRise_m);
  EXPECT_NEAR(path.points.back().load_factor, 1000, 1e-6);
  // Limit points: cos^3 a = cos a0, P = 2 k l0 (1 - cos^(2/3) a0)^(3/2)
  const double l0 = std::hypot(kHalf_m, kRise_m), cos0 = kHalf_m / l0;
  const double limit = 2 * kStiffness * l0 * std::pow(1 - std::pow(cos0, 2.0 / 3), 1.5);
  std::vector<double> limits;
  for (const LoadedPoint& point : path.points) {
    if (point.limit) limits.push_back(point.load_factor);
  }
  ASSERT_EQ(limits.size(), 2u);
  EXPECT_NEAR(limits[0], limit, 1e-8 * limit);
  EXPECT_NEAR(limits[1], -limit, 1e-8 * limit);
  for (const LoadedPoint& point : path.points) {
    const double slope =
        ClosedForm(point.displacement_m + 1e-6) - ClosedForm(point.displacement_m - 1e-6);
    if (std::fabs(slope) > 1e-4) {
      EXPECT_EQ(point.stable, slope > 0) << point.displacement_m;
    }
  }
}

// A mass between two vertical prestressed cables: under a load down, the lower one goes slack.
TEST(LoadPath, ContinuesWhenACableGoesSlack) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  BodyDef mass;
  mass.name = "mass", mass.mass_kg = 1, mass.com_m = {0, 0, 0};
  mass.inertia_kg_m2 = {.xx = 1e-3, .yy = 1e-3, .zz = 1e-3};
  def.bodies.push_back(mass);
  def.nodes.push_back({.name = "mass", .body = 0, .position_m = {}});
  for (const double side : {1.0, -1.0}) {
    CableDef cable;
    cable.name = side > 0 ? "upper" : "lower";
    cable.stiffness_n_per_m = 1000, cable.rest_length_m = 0.95;  // 50 N at 1 m
    cable.attachments = {{.body = kWorld, .position_m = {0, 0, side}},
                         {.body = 0, .position_m = {}}};
    def.cables.push_back(cable);
  }
  LoadCaseSpec loads;
  loads.forces.push_back({0, {0, 0, -10}});
  LoadPathOptions options;
  options.to_factor = 30;
  const LoadPath path = FollowLoads(def, loads, options);
  EXPECT_EQ(path.why, "");
  for (const LoadedPoint& point : path.points) {
    const double load_n = 10 * point.load_factor;
    // both cables act up to 100 N, then the upper one alone
    const double w = load_n <= 100 ? load_n / 2000 : 0.05 + (load_n - 100) / 1000;
    EXPECT_NEAR(point.displacement_m, w, 1e-9);
    EXPECT_NEAR(point.cable_tension_n[0], 50 + 1000 * w, 1e-6);
    EXPECT_NEAR(point.cable_tension_n[1], std::max(0.0, 50 - 1000 * w), 1e-6);
    if (!point.went_slack.empty()) {
      EXPECT_NEAR(point.load_factor, 10, 1e-6);
    }
  }
  EXPECT_EQ(std::count_if(path.points.begin(), path.points.end(),
                          [](const LoadedPoint& p) { return p.went_slack == std::vector{1}; }),
            1);
  EXPECT_NEAR(path.points.back().load_factor, 30, 1e-9);
}

// Half of a T-bar: a strut and two prestressed strings; a load sideways slackens one of them.
// Places and forces at two loads: TsgFEM, example 06_half_Tbar, 9 digits.
TEST(LoadPath, OfAHalfTBarIsThatOfTsgFem) {
  struct Reference {
    double load_n, x_m, z_m, strut_n, string_n;
  };
  constexpr double kE = 206043956043.95602, kString = kE * 1.1785113019775802e-06;
  for (const Reference& r :
       {Reference{5050.50505050505, 0.061647444, 0.997660736, -5048.300904179, 7357.846164379},
        Reference{10000, 0.128026789, 0.990895489, -9991.319866599, 15014.387454102}}) {
    ModelDef def;
    def.gravity_m_per_s2 = {};
    AddPoint(def, "top", {0, 0, 1}, 1);
    JointDef& strut = AddJoint(def, JointKind::kDistance, kWorld, {0, 0, 0}, 0, {0, 0, 1});
    strut.rest = 1.0000043656799977;
    strut.stiffness = kE * 5.558532146071175e-05 / strut.rest;
    constexpr double kRest = 1.4140076828544716;
    AddCable(def, {{kWorld, {-1, 0, 0}}, {0, {0, 0, 1}}}, kString / kRest, kRest);
    AddCable(def, {{kWorld, {1, 0, 0}}, {0, {0, 0, 1}}}, kString / kRest, kRest);
    LoadCaseSpec loads;
    loads.forces.push_back({0, {r.load_n, 0, 0}});
    const LoadPath path = FollowLoads(def, loads, {});
    ASSERT_EQ(path.why, "");
    const LoadedPoint& end = path.points.back();
    EXPECT_NEAR(end.pose.bodies[0].position_m.x, r.x_m, 1e-8);
    EXPECT_NEAR(end.pose.bodies[0].position_m.z, r.z_m, 1e-8);
    EXPECT_NEAR(end.bar_force_n[0], r.strut_n, 0.02);
    EXPECT_NEAR(end.cable_tension_n[0], r.string_n, 0.02);
    EXPECT_EQ(end.cable_tension_n[1], 0);
  }
}

TEST(LoadPath, OfASupportSettlesWithTheFactor) {
  LoadCaseSpec loads;
  loads.bars.push_back({0, 0.01}), loads.bars.push_back({1, 0.01});
  const LoadPath path = FollowLoads(VonMisesTruss(kRise_m), loads, {});
  EXPECT_EQ(path.why, "");
  const Equilibrium at = FindEquilibrium(VonMisesTruss(kRise_m), loads);
  ASSERT_TRUE(at.found);
  EXPECT_NEAR(path.points.back().pose.bodies[0].position_m.z, at.pose.bodies[0].position_m.z, 1e-9);
}

}  // namespace
}  // namespace taut::test
