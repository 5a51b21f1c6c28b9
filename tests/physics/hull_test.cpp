// Convex hulls: statics and slopes in closed form, comparison with boxes, conservation in flight.
#include <numbers>

#include <gtest/gtest.h>

#include "math/convex_hull.h"
#include "mechanics/mass_properties.h"
#include "tests/constants.h"
#include "tests/physics/lanes_alike.h"
#include "tests/physics/world.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rough_ground.h"

namespace taut::test {
namespace {

/// Adds the convex hull of corners about the origin, of 700 kg/m^3, moved to `at_m`. Returns the
/// body's index.
int AddHull(ModelDef& def, const std::string& name, std::vector<Vec3> corners_m, const Vec3& at_m,
            const Quat& q, const Material& material) {
  for (Vec3& p : corners_m) p = at_m + Rotate(q, p);
  const math::ConvexHull hull = math::HullOf(corners_m, HullDef::kMostCorners);
  const MassProperties mass = SolidMesh(hull.corners, math::TrianglesOf(hull), 700);
  BodyDef body;
  body.name = name;
  body.mass_kg = mass.mass_kg, body.com_m = mass.com_m, body.inertia_kg_m2 = mass.inertia_kg_m2;
  const int index = static_cast<int>(def.bodies.size());
  def.bodies.push_back(body);
  def.hulls.push_back({name, index, corners_m, material});
  return index;
}

std::vector<Vec3> BoxCorners(const Vec3& half_m) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {i & 1 ? half_m.x : -half_m.x, i & 2 ? half_m.y : -half_m.y, i & 4 ? half_m.z : -half_m.z});
  }
  return corners;
}

/// Returns the corners of a prism about y that stands on a side; `count` even.
std::vector<Vec3> PrismCorners(int count, double radius_m, double width_m) {
  std::vector<Vec3> corners;
  for (int i = 0; i < count; ++i) {
    const double angle = (2 * i + 1) * std::numbers::pi / count;
    const double x = radius_m * std::sin(angle), z = -radius_m * std::cos(angle);
    corners.push_back({x, -0.5 * width_m, z});
    corners.push_back({x, 0.5 * width_m, z});
  }
  return corners;
}

/// Returns a regular tetrahedron with a face in the plane z = 0 and the front edge of that face at
/// right angles to x.
std::vector<Vec3> TetrahedronCorners(double edge_m) {
  const double r = edge_m / std::sqrt(3.0), h = edge_m * std::sqrt(2.0 / 3.0);
  return {{0.5 * r, 0.5 * edge_m, 0}, {0.5 * r, -0.5 * edge_m, 0}, {-r, 0, 0}, {0, 0, h}};
}

std::vector<Vec3> AnyCorners(scenes::Chance& chance, int count, double size_m) {
  std::vector<Vec3> corners;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = chance.Direction();
    const double far_m = chance.Within(0.7, 1.0) * size_m;
    corners.push_back(far_m * p);
  }
  return corners;
}

enum class Floor { kPlane, kBox, kField, kHull };
constexpr Floor kFloors[] = {Floor::kPlane, Floor::kBox, Floor::kField, Floor::kHull};

/// Adds a level floor at z = 0.
void AddFloor(ModelDef& def, Floor floor, const Material& material) {
  switch (floor) {
    case Floor::kPlane:
      def.planes.push_back({"floor", {0, 0, 1}, {}, material});
      break;
    case Floor::kBox:
      def.terrain_boxes.push_back({"floor", {0.01, 0.02, -0.5}, {}, {2, 2, 0.5}, material});
      break;
    case Floor::kField:
      def.height_fields.push_back(
          scenes::Field(40, 40, 0.1, material, [](double, double) { return 0.0; }));
      break;
    case Floor::kHull: {
      const int body =
          AddHull(def, "floor", BoxCorners({2, 2, 0.5}), {0.03, 0.04, -0.5}, {}, material);
      def.bodies[static_cast<std::size_t>(body)].fixed = true;
      break;
    }
  }
}

/// Sets gravity as on a slope of this angle that descends along x.
void Slope(ModelDef& def, double angle_rad) {
  def.gravity_m_per_s2 = {kG * std::sin(angle_rad), 0, -kG * std::cos(angle_rad)};
}

TEST(Hull, OfABoxSlidesAndSpinsAsTheBox) {
  const Material material{0.3, 0.3, 0};
  const Vec3 half{0.1, 0.07, 0.05};
  for (const Floor floor : kFloors) {
    ModelDef box, hull;
    const Vec3 at{-0.4, 0.013, 0.06};
    const Quat q = scenes::Turn({0, 0, 1}, 0.4);
    scenes::AddBox(box, "a", 700 * 8 * half.x * half.y * half.z, half, at, q, material);
    AddHull(hull, "a", BoxCorners(half), at, q, material);
    for (ModelDef* def : {&box, &hull}) {
      AddFloor(*def, floor, material);
      def->bodies[0].velocity_m_per_s = {1.2, 0.3, 0};
      def->bodies[0].angular_velocity_rad_per_s = {0, 0, 2};
    }
    WorldBatch a = MakeBatch(box), b = MakeBatch(hull);
    for (int i = 0; i < 10; ++i) {
      a.Step(1e-3, 60);
      b.Step(1e-3, 60);
      EXPECT_LE(Distance(a.Body(0, 0).position_m, b.Body(0, 0).position_m),
                SolverError(60 * (i + 1)))
          << static_cast<int>(floor) << " after " << a.Time(0);
    }
    EXPECT_LT(Norm(b.Body(0, 0).velocity_m_per_s), 1e-9);
  }
}

TEST(Hull, ATetrahedronTipsOverWhereItsWeightPassesItsEdge) {
  // The center is at a quarter of the height a sqrt(2/3), a / sqrt(12) behind the edge: tan = sqrt
  // 2.
  const double tips = std::atan(std::sqrt(2.0));
  const Material material{3, 3, 0};
  for (const Floor floor : kFloors) {
    for (const double angle : {tips - 2e-3, tips + 2e-3}) {
      ModelDef def;
      AddHull(def, "a", TetrahedronCorners(0.2), {}, {}, material);
      AddFloor(def, floor, material);
      Slope(def, angle);
      WorldBatch world = MakeBatch(def);
      const Vec3 start = world.Body(0, 0).position_m;
      world.Step(1e-3, 1500);
      const double moved = Distance(world.Body(0, 0).position_m, start);
      if (angle < tips) {
        EXPECT_LT(moved, 1e-7) << static_cast<int>(floor);
        EXPECT_LT(Norm(world.Body(0, 0).velocity_m_per_s), 1e-9);
      } else {
        EXPECT_GT(moved, 0.1) << static_cast<int>(floor);
      }
    }
  }
}

TEST(Hull, APrismRollsFromHalfTheAngleOfASide) {
  const int sides = 16;
  const Material material{0.8, 0.8, 0};
  for (const Floor floor : kFloors) {
    for (const double more : {-2e-3, 2e-3}) {
      ModelDef def;
      const double radius = 0.05;
      AddHull(def, "a", PrismCorners(sides, radius, 0.08),
              {0, 0, radius * std::cos(std::numbers::pi / sides)}, {}, material);
      AddFloor(def, floor, material);
      Slope(def, std::numbers::pi / sides + more);
      WorldBatch world = MakeBatch(def);
      const Vec3 start = world.Body(0, 0).position_m;
      world.Step(1e-3, 1000);
      const Vec3 now = world.Body(0, 0).position_m;
      if (more < 0) {
        EXPECT_LT(Distance(now, start), 1e-7) << static_cast<int>(floor);
      } else {
        EXPECT_GT(now.x - start.x, 0.02) << static_cast<int>(floor);
        EXPECT_LT(std::fabs(now.y), 1e-6);  // straight
      }
    }
  }
}

TEST(Hull, ALeverCarriesItsLoadsOnTwoPrisms) {
  // A rod on two ridges at x = -0.3 and 0.2, its center at 0: they carry 2/5 and 3/5.
  const Material material{0.5, 0.5, 0};
  ModelDef def;
  for (const double x : {-0.3, 0.2}) {
    const std::vector<Vec3> roof{{-0.05, -0.1, -0.1}, {0.05, -0.1, -0.1}, {0, -0.1, 0},
                                 {-0.05, 0.1, -0.1},  {0.05, 0.1, -0.1},  {0, 0.1, 0}};
    const int body = AddHull(def, x < 0 ? "left" : "right", roof, {x, 0, 0}, {}, material);
    def.bodies[static_cast<std::size_t>(body)].fixed = true;
  }
  BodyDef rod;
  rod.name = "rod";
  rod.mass_kg = 2;
  rod.com_m = {0, 0, 0.01};
  rod.inertia_kg_m2 = {1e-4, 0.1, 0.1};
  def.bodies.push_back(rod);
  def.capsules.push_back({"rod", 2, {-0.5, 0, 0.01}, {0.5, 0, 0.01}, 0.01, material});
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 500);
  EXPECT_LT(Norm(world.Body(0, 2).velocity_m_per_s), 1e-9);
  double left = 0, right = 0;
  for (const ContactState& c : world.Contacts(0)) {
    (c.point_m.x < 0 ? left : right) += (c.body_a == 2 ? 1 : -1) * c.force_n.z;
  }
  EXPECT_NEAR(left, 0.4 * 2 * kG, 1e-6);
  EXPECT_NEAR(right, 0.6 * 2 * kG, 1e-6);
}

TEST(Hull, TwoInFlightKeepMomentumAndLoseNoEnergyIfElastic) {
  scenes::Chance chance(4);
  for (int round = 0; round < 12; ++round) {
    const double e = round % 2 == 0 ? 1.0 : 0.0;
    const Material material{0, 0, e};
    ModelDef def;
    def.gravity_m_per_s2 = {};
    for (int i = 0; i < 2; ++i) {
      const Vec3 at{i == 0 ? -0.2 : 0.2, chance.Within(-0.03, 0.03), chance.Within(-0.03, 0.03)};
      AddHull(def, i == 0 ? "a" : "b", AnyCorners(chance, 14, 0.08), at, {}, material);
      def.bodies.back().velocity_m_per_s = {i == 0 ? 1.0 : -1.0, 0, 0};
      const double speed = chance.Within(0, 5);
      def.bodies.back().angular_velocity_rad_per_s = speed * chance.Direction();
    }
    const auto moments = [&](const WorldBatch& world, Vec3& linear, Vec3& angular) {
      linear = angular = {};
      for (int b = 0; b < 2; ++b) {
        const BodyState s = world.Body(0, b);
        const BodyDef& body = def.bodies[static_cast<std::size_t>(b)];
        const Inertia& j = body.inertia_kg_m2;
        const Vec3 w = Rotate(Conjugate(s.orientation), s.angular_velocity_rad_per_s);
        const Vec3 own{j.xx * w.x + j.xy * w.y + j.xz * w.z, j.xy * w.x + j.yy * w.y + j.yz * w.z,
                       j.xz * w.x + j.yz * w.y + j.zz * w.z};
        linear = linear + body.mass_kg * s.velocity_m_per_s;
        angular = angular + Rotate(s.orientation, own) +
                  body.mass_kg * Cross(s.position_m, s.velocity_m_per_s);
      }
    };
    WorldBatch world = MakeBatch(def);
    Vec3 linear, angular, linear_now, angular_now;
    moments(world, linear, angular);
    const double before = EnergyOf(world);
    bool met = false;
    double most = before;
    for (int i = 0; i < 400; ++i) {
      world.Step(1e-3);
      met = met || !world.Contacts(0).empty();
      most = std::max(most, EnergyOf(world));
    }
    moments(world, linear_now, angular_now);
    EXPECT_TRUE(met) << round;
    EXPECT_LE(Distance(linear, linear_now), 1e-12) << round;
    EXPECT_LE(Distance(angular, angular_now), 1e-10) << round;
    EXPECT_LE(most, before * (1 + 1e-5)) << round;
    if (e == 0.0) {
      EXPECT_LT(EnergyOf(world), before) << round;
    }
  }
}

ModelDef Heap(std::uint64_t seed, bool on_hills) {
  const Material material{0.6, 0.5, 0};
  scenes::Chance chance(seed);
  ModelDef def;
  for (int i = 0; i < 5; ++i) {
    // In separate statements: the evaluation order of arguments is unspecified.
    const std::vector<Vec3> corners = AnyCorners(chance, 8 + 3 * i, 0.06);
    const Vec3 at{chance.Within(-0.1, 0.1), chance.Within(-0.1, 0.1), 0.15 + 0.15 * i};
    const Vec3 axis = chance.Direction();
    const double angle = chance.Within(0.0, 3.0);
    AddHull(def, "hull_" + std::to_string(i), corners, at, scenes::Turn(axis, angle), material);
  }
  scenes::AddBox(def, "box", 0.4, {0.05, 0.04, 0.03}, {0.02, 0.03, 0.95}, {}, material);
  BodyDef rod;
  rod.name = "rod";
  rod.mass_kg = 0.3;
  rod.com_m = {0, 0, 1.1};
  rod.inertia_kg_m2 = {1e-5, 2e-3, 2e-3};
  def.bodies.push_back(rod);
  def.capsules.push_back({"rod", 6, {-0.12, 0, 1.1}, {0.12, 0, 1.1}, 0.01, material});
  if (on_hills) {
    def.height_fields.push_back(scenes::Hills(60, 60, material));
  } else {
    AddFloor(def, Floor::kPlane, material);
    for (int side = 0; side < 4; ++side) {
      const double x = side == 0   ? 0.32
                       : side == 1 ? -0.32
                                   : 0,
                   y = side == 2   ? 0.32
                       : side == 3 ? -0.32
                                   : 0;
      def.terrain_boxes.push_back({"wall_" + std::to_string(side),
                                   {x, y, 0.2},
                                   {},
                                   {x != 0 ? 0.1 : 0.45, y != 0 ? 0.1 : 0.45, 0.25},
                                   material});
    }
  }
  return def;
}

TEST(Hull, AHeapComesToRestAndNothingIsInEachOther) {
  for (const bool on_hills : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const ModelDef def = Heap(seed, on_hills);
      double weight_n = 0;
      for (const BodyDef& body : def.bodies) weight_n += body.mass_kg * kG;
      WorldBatch world = MakeBatch(def);
      double most = EnergyOf(world), deepest = 0, last = 0;
      for (int i = 0; i < 400; ++i) {
        world.Step(1e-3, 10);
        const double energy = EnergyOf(world);
        EXPECT_LE(energy, most + 5e-5 * weight_n) << i;  // 5e-5 * weight_n: a lift by 50 um
        most = std::min(most, energy);
        for (const Overlap& overlap : world.Overlaps(0))
          deepest = std::max(deepest, overlap.depth_m);
      }
      EXPECT_LT(deepest, 5e-4) << seed;  // the bound for boxes that hit each other at 4 m/s
      if (on_hills) continue;            // some hulls roll on
      EXPECT_LT(last, 2e-5) << seed;
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
      for (int b = 0; b < 7; ++b) {
        EXPECT_LT(Norm(world.Body(0, b).velocity_m_per_s), 1e-6) << seed << " " << b;
      }
    }
  }
}

TEST(Hull, LanesHaveTheBitsOfWorldsAlone) {
  ExpectLanesLikeWorldsAlone(Heap(2, false), {0.003, -0.002, 0.001}, 500);
  ExpectLanesLikeWorldsAlone(Heap(3, true), {0.03, -0.02, 0.01}, 500);
}

TEST(Hull, OnBoxesThatTouchEachOtherItSlidesAsOnAPlane) {
  const Material material{0.2, 0.2, 0};
  const std::vector<Vec3> wedge{
      {-0.1, -0.05, 0}, {0.1, -0.05, 0}, {-0.1, 0.05, 0}, {0.1, 0.05, 0}, {0, 0, 0.08}};
  ModelDef flags, plane;
  for (ModelDef* def : {&flags, &plane}) {
    AddHull(*def, "a", wedge, {-0.3, 0.013, 0.0}, scenes::Turn({0, 0, 1}, 0.3), material);
    def->bodies[0].velocity_m_per_s = {1, 0.1, 0};
  }
  AddFloor(plane, Floor::kPlane, material);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 8; ++j) {
      flags.terrain_boxes.push_back({"flag_" + std::to_string(8 * i + j),
                                     {-0.55 + 0.1 * i, -0.35 + 0.1 * j, -0.05},
                                     {},
                                     {0.05, 0.05, 0.05},
                                     material});
    }
  }
  WorldBatch a = MakeBatch(flags), b = MakeBatch(plane);
  a.Step(1e-3, 600);
  b.Step(1e-3, 600);
  EXPECT_LE(Distance(a.Body(0, 0).position_m, b.Body(0, 0).position_m), 1e-9);
}

TEST(Hull, BadOnesAreNamed) {
  const auto complaint = [](const std::vector<Vec3>& corners) {
    ModelDef def;
    AddHull(def, "good", BoxCorners({0.1, 0.1, 0.1}), {}, {}, {});
    def.hulls.push_back({"bad", 0, corners, {}});
    Diagnostics out;
    EXPECT_EQ(Model::Compile(def, out), nullptr);
    return out.Format();
  };
  EXPECT_NE(complaint({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).find("hull bad has no volume"),
            std::string::npos);
  EXPECT_NE(complaint(std::vector<Vec3>(65)).find("hull bad has more than 64 corners"),
            std::string::npos);
  EXPECT_NE(complaint({{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}, {1, 1, 1}}).find("hull bad: corner"),
            std::string::npos);
}

}  // namespace
}  // namespace taut::test
