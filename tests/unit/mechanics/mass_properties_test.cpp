// Mass properties of solids, and loads at the start, against closed forms and point clouds
#include "mechanics/mass_properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "math/vec.h"
#include "taut/statics.h"

namespace taut {
namespace {

void ExpectNear(const Inertia& got, const Inertia& wanted, double tolerance) {
  EXPECT_NEAR(got.xx, wanted.xx, tolerance);
  EXPECT_NEAR(got.yy, wanted.yy, tolerance);
  EXPECT_NEAR(got.zz, wanted.zz, tolerance);
  EXPECT_NEAR(got.xy, wanted.xy, tolerance);
  EXPECT_NEAR(got.xz, wanted.xz, tolerance);
  EXPECT_NEAR(got.yz, wanted.yz, tolerance);
}

/// Independent oracle: the inertia of many equal points, by definition.
Inertia PointCloud(const std::vector<Vec3>& points, double mass) {
  Vec3 com;
  for (const Vec3& p : points) com = com + (1.0 / static_cast<double>(points.size())) * p;
  const double m = mass / static_cast<double>(points.size());
  Inertia i;
  for (const Vec3& p : points) {
    const Vec3 r = p - com;
    i.xx += m * (r.y * r.y + r.z * r.z);
    i.yy += m * (r.x * r.x + r.z * r.z);
    i.zz += m * (r.x * r.x + r.y * r.y);
    i.xy -= m * r.x * r.y;
    i.xz -= m * r.x * r.z;
    i.yz -= m * r.y * r.z;
  }
  return i;
}

TEST(MassProperties, ASphereHasTwoFifthsOfMRSquared) {
  const MassProperties s = SolidSphere({1, 2, 3}, 0.5, 4.0);
  ExpectNear(s.inertia_kg_m2, {0.4, 0.4, 0.4, 0, 0, 0}, 1e-15);
  EXPECT_EQ(s.com_m.z, 3.0);
}

TEST(MassProperties, ACylinderAlongAnAxisHasTheTextbookMoments) {
  const MassProperties c = SolidCylinder({0, 0, 1}, {0, 0, 3}, 0.5, 12.0);
  ExpectNear(c.inertia_kg_m2, {4.75, 4.75, 1.5, 0, 0, 0},
             1e-14);  // m (3 r^2 + l^2) / 12, m r^2 / 2
  EXPECT_EQ(c.com_m.z, 2.0);
}

TEST(MassProperties, ASlantedCylinderIsTheSumOfItsPoints) {
  // Points of a cylinder about z, rotated like the cylinder's ends.
  const double half = 0.25 * std::numbers::pi, s = std::sin(half) / std::sqrt(14.0);
  const Quat q{std::cos(half), s, 2 * s, 3 * s};
  const double r = 0.3, l = 2.0;
  std::vector<Vec3> points;
  const int n = 60;  // midpoints of equal volumes
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      for (int c = 0; c < 12; ++c) {
        const double rho = r * std::sqrt((a + 0.5) / n), phi = 2 * std::numbers::pi * c / 12;
        points.push_back(
            Rotate(q, {rho * std::cos(phi), rho * std::sin(phi), l * ((b + 0.5) / n - 0.5)}));
      }
    }
  }
  const MassProperties c =
      SolidCylinder(Rotate(q, {0, 0, -l / 2}), Rotate(q, {0, 0, l / 2}), r, 5.0);
  ExpectNear(c.inertia_kg_m2, PointCloud(points, 5.0),
             1e-3);  // discretization error of the grid: 5 l^2 / 12 n^2
}

TEST(MassProperties, ATurnedBoxIsTheSumOfItsPoints) {
  const double half = 0.3, s = std::sin(half) / std::sqrt(3.0);
  const Quat q{std::cos(half), s, s, s};
  const Vec3 h{0.1, 0.2, 0.4};
  std::vector<Vec3> points;
  const int n = 40;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      for (int c = 0; c < n; ++c) {
        const auto at = [&](int i, double e) { return e * ((2 * i + 1.0) / n - 1); };
        points.push_back(Rotate(q, {at(a, h.x), at(b, h.y), at(c, h.z)}));
      }
    }
  }
  ExpectNear(SolidBox({}, q, h, 3.0).inertia_kg_m2, PointCloud(points, 3.0), 2e-4);
}

TEST(MassProperties, CombiningFollowsParallelAxes) {
  // A dumbbell: two spheres of 2 kg, 1 m apart, and a massless third sphere
  const MassProperties whole =
      Combine({SolidSphere({0, 0, 0}, 0.1, 2), SolidSphere({1, 0, 0}, 0.1, 2),
               SolidSphere({5, 5, 5}, 0.1, 0)});
  EXPECT_EQ(whole.mass_kg, 4.0);
  EXPECT_EQ(whole.com_m.x, 0.5);
  ExpectNear(whole.inertia_kg_m2, {0.016, 1.016, 1.016, 0, 0, 0}, 1e-15);
}

TEST(MassProperties, TwoHalvesOfABoxMakeTheBox) {
  const double half = 0.7;
  const Quat q{std::cos(half), 0, std::sin(half), 0};
  const Vec3 arm = Rotate(q, {0.5, 0, 0});
  const MassProperties whole = Combine(
      {SolidBox(arm, q, {0.5, 0.2, 0.3}, 1.5), SolidBox(-1.0 * arm, q, {0.5, 0.2, 0.3}, 1.5)});
  ExpectNear(whole.inertia_kg_m2, SolidBox({}, q, {1.0, 0.2, 0.3}, 3.0).inertia_kg_m2, 1e-15);
}

TEST(MassProperties, NothingCombinesToNothing) {
  EXPECT_EQ(Combine({}).mass_kg, 0.0);
  EXPECT_EQ(Combine({SolidSphere({1, 1, 1}, 1, 0)}).com_m.x, 0.0);
}

TEST(MassProperties, PrincipalMomentsAreThoseOfTheUnturnedBody) {
  const double half = 0.9, s = std::sin(half) / std::sqrt(14.0);
  const Quat q{std::cos(half), 3 * s, 2 * s, s};
  const Vec3 turned = PrincipalMoments(SolidBox({}, q, {0.1, 0.2, 0.4}, 3.0).inertia_kg_m2);
  EXPECT_NEAR(turned.x, 0.01 + 0.04, 1e-15);  // m (hx^2 + hy^2) / 3 is the smallest
  EXPECT_NEAR(turned.y, 0.01 + 0.16, 1e-15);
  EXPECT_NEAR(turned.z, 0.04 + 0.16, 1e-15);
  const Vec3 diagonal = PrincipalMoments({3, 1, 2, 0, 0, 0});
  EXPECT_EQ(diagonal.x, 1.0);
  EXPECT_EQ(diagonal.z, 3.0);
}

TEST(Bounds, OfATurnedBoxTouchItsCorners) {
  const Quat quarter{std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  const Bounds b = BoxBounds({1, 0, 0}, quarter, {0.5, 0.1, 0.2});
  EXPECT_NEAR(b.low.x, 0.9, 1e-15);
  EXPECT_NEAR(b.high.y, 0.5, 1e-15);
  EXPECT_NEAR(b.high.z, 0.2, 1e-15);
}

TEST(Bounds, OfARodPointingDownAreThoseOfARodPointingUp) {
  const Bounds up = BulletCylinderBounds({0, 0, 0}, {0, 0, 1}, 0.1);
  const Bounds down = BulletCylinderBounds({0, 0, 1}, {0, 0, 0}, 0.1);
  EXPECT_NEAR(up.high.z, 1.0, 1e-15);
  EXPECT_NEAR(down.high.z, 1.0, 1e-15);
  EXPECT_NEAR(down.low.x, -0.1, 1e-15);
}

TEST(BoundingBoxInertia, IsThatOfASolidBox) {
  Bounds bounds;
  bounds.Add({7, 8, 9}, {0.5, 1.0, 1.5});
  ExpectNear(BoundingBoxInertia(bounds, 12.0), {4 + 9, 1 + 9, 1 + 4, 0, 0, 0}, 1e-14);
}

// --- loads at the start ----------------------------------------------------------------------

TEST(StartLoads, ACablePullsItsEndsTogetherAndTurnsThem) {
  ModelDef def;
  def.bodies.resize(2);
  def.bodies[0].mass_kg = 2.0;
  def.bodies[1].com_m = {3, 0, 0};
  def.cables.push_back({"c", {{0, {0, 1, 0}}, {1, {3, 1, 0}}}, 100.0, 0.0, 2.5, {}, {}});
  EXPECT_DOUBLE_EQ(CableLength(def.cables[0]), 3.0);
  EXPECT_DOUBLE_EQ(CableTension(def.cables[0]), 50.0);
  const std::vector<BodyLoad> loads = StartLoads(def);
  EXPECT_DOUBLE_EQ(loads[0].cable_force_n.x, 50.0);
  EXPECT_DOUBLE_EQ(loads[1].cable_force_n.x, -50.0);
  EXPECT_DOUBLE_EQ(loads[0].cable_torque_n_m.z, -50.0);
  EXPECT_DOUBLE_EQ(loads[0].weight_n.z, -19.62);
}

TEST(StartLoads, AViaPointIsPressedByBothLegs) {
  ModelDef def;
  def.bodies.resize(1);
  def.cables.push_back(
      {"c", {{kWorld, {-1, 0, 1}}, {0, {0, 0, 0}}, {kWorld, {1, 0, 1}}}, 100.0, 0.0, 2.0, {}, {}});
  const double tension = 100.0 * (2.0 * std::sqrt(2.0) - 2.0);
  const BodyLoad load = StartLoads(def)[0];
  EXPECT_NEAR(load.cable_force_n.x, 0.0, 1e-12);
  EXPECT_NEAR(load.cable_force_n.z, std::sqrt(2.0) * tension, 1e-12);
}

TEST(StartLoads, ASlackCableDoesNothing) {
  ModelDef def;
  def.bodies.resize(1);
  def.cables.push_back({"c", {{kWorld, {0, 0, 1}}, {0, {0, 0, 0}}}, 100.0, 0.0, 2.0, {}, {}});
  EXPECT_EQ(CableTension(def.cables[0]), 0.0);
  EXPECT_EQ(StartLoads(def)[0].cable_force_n.z, 0.0);
}

TEST(Counting, OnlyCollidingShapesAndMovingMassesCount) {
  ModelDef def;
  def.bodies.resize(2);
  def.bodies[0].mass_kg = 2.0;
  def.bodies[1].mass_kg = 3.0;
  def.bodies[1].fixed = true;
  def.spheres.push_back({"a", 0, {}, 0.1, {}, true});
  def.spheres.push_back({"b", 0, {}, 0.1, {}, false});
  def.capsules.push_back({"c", 1, {}, {1, 0, 0}, 0.1, {}, true});
  EXPECT_EQ(TotalMass(def), 2.0);
  const auto counts = CollidingShapes(def);
  std::map<std::string, int> first, second;
  for (const ShapeCount& of_kind : counts[0]) first[of_kind.name.many] = of_kind.count;
  for (const ShapeCount& of_kind : counts[1]) second[of_kind.name.many] = of_kind.count;
  EXPECT_EQ(first,
            (std::map<std::string, int>{{"spheres", 1}, {"rods", 0}, {"boxes", 0}, {"hulls", 0}}));
  EXPECT_EQ(second,
            (std::map<std::string, int>{{"spheres", 0}, {"rods", 1}, {"boxes", 0}, {"hulls", 0}}));
}

}  // namespace
}  // namespace taut
