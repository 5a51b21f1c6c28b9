// Terrain of many boxes, selected by a bounding volume hierarchy (docs/theory/contact.md, section
// 7): the broad phase must miss no contact and change no bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim/data/tables.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

const Material kMaterial{0.6, 0.6, 0.2};

/// Returns boxes of many sizes in a square of 4 m, at random orientations, and one below all. With
/// `apart`, none touches another: touching terrain boxes would form one surface, unlike touching
/// bodies.
std::vector<TerrainBoxDef> Field(int count, std::uint64_t seed, bool apart = false) {
  scenes::Chance chance(seed);
  std::vector<TerrainBoxDef> boxes;
  while (static_cast<int>(boxes.size()) < count) {
    const Vec3 at{chance.Within(-2, 2), chance.Within(-2, 2), chance.Within(-0.1, 0.1)};
    const Quat q = scenes::Turn(chance.Direction(), chance.Within(-1.5, 1.5));
    const Vec3 half{chance.Within(0.02, 0.12), chance.Within(0.02, 0.12),
                    chance.Within(0.02, 0.12)};
    const bool meets = std::any_of(boxes.begin(), boxes.end(), [&](const TerrainBoxDef& box) {
      return Norm(box.center_m - at) < Norm(box.half_extents_m) + Norm(half);
    });
    if (apart && meets) continue;
    boxes.push_back({"box_" + std::to_string(boxes.size()), at, q, half, kMaterial});
  }
  const Vec3 below{0, 0, apart ? -0.85 : -0.5};
  boxes[static_cast<std::size_t>(count / 2)] = {"floor", below, {}, {4, 4, 0.45}, kMaterial};
  return boxes;
}

/// Adds a ball far from all others to `body`. The time span over which continuous collision
/// detection follows a pair depends, in the last bits, on the extents of both bodies; with this
/// ball all fixed bodies have the same extent.
void AddFarBall(int body, ModelDef& def) {
  def.spheres.push_back({"far", body, {0, 0, -60}, 0.01, kMaterial});
}

/// Adds the same boxes as fixed bodies: each is a separate partner with its own bounds, without the
/// hierarchy.
void AddAsBodies(const std::vector<TerrainBoxDef>& boxes, ModelDef& def) {
  for (const TerrainBoxDef& box : boxes) {
    BodyDef body;
    body.name = box.name;
    body.fixed = true;
    def.boxes.push_back({box.name, static_cast<int>(def.bodies.size()), box.center_m,
                         box.orientation, box.half_extents_m, box.material});
    AddFarBall(static_cast<int>(def.bodies.size()), def);
    def.bodies.push_back(body);
  }
}

/// Returns moving rods, balls and boxes above the field. Each has one shape, so that its contacts
/// are in the order of the boxes, with and without the hierarchy.
ModelDef Tumblers(std::uint64_t seed) {
  scenes::Chance chance(seed);
  ModelDef def;
  for (int i = 0; i < 9; ++i) {
    const Vec3 at{-1.2 + 1.2 * (i % 3), -1.2 + 1.2 * (i / 3), chance.Within(0.5, 0.8)};
    const std::string name = "body_" + std::to_string(i);
    if (i % 3 == 0) {
      scenes::AddBall(def, name, 0.3, 0.04, at, kMaterial);
    } else if (i % 3 == 1) {
      const Vec3 half = scenes::Scaled(0.2, chance.Direction());
      scenes::AddRod(def, name, 0.3, 0.02, at - half, at + half, kMaterial);
    } else {
      const Vec3 half{0.1, 0.05, 0.03};
      BodyDef body;
      body.name = name;
      body.mass_kg = 0.3;
      body.com_m = at;
      body.inertia_kg_m2 = scenes::BoxInertia(0.3, half);
      def.boxes.push_back({name, i, at, {}, half, kMaterial});
      def.bodies.push_back(body);
    }
    def.bodies.back().velocity_m_per_s = chance.Jolt(2.5);
    def.bodies.back().angular_velocity_rad_per_s = chance.Jolt(8);
  }
  return def;
}

void ExpectTheSameBits(const WorldBatch& a, const WorldBatch& b, int body) {
  const BodyState p = a.Body(0, body), q = b.Body(0, body);
  EXPECT_EQ(Norm(p.position_m - q.position_m), 0) << body;
  EXPECT_EQ(Norm(p.velocity_m_per_s - q.velocity_m_per_s), 0) << body;
  EXPECT_EQ(Norm(p.angular_velocity_rad_per_s - q.angular_velocity_rad_per_s), 0) << body;
}

TEST(ManyBoxes, GiveTheBitsOfAsManyFixedBodies) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const std::vector<TerrainBoxDef> boxes = Field(300, seed, true);
    ModelDef terrain = Tumblers(seed), bodies = terrain;
    const int moving = static_cast<int>(terrain.bodies.size());
    terrain.terrain_boxes = boxes;
    AddFarBall(kWorld, terrain);
    AddAsBodies(boxes, bodies);
    WorldBatch looked_up = MakeBatch(terrain), each = MakeBatch(bodies);
    std::set<int> touched;
    for (int step = 0; step < 1500; ++step) {
      looked_up.Step(1e-3), each.Step(1e-3);
      const auto found = looked_up.Contacts(0), all = each.Contacts(0);
      ASSERT_EQ(found.size(), all.size()) << seed << ", step " << step;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i].gap_m, all[i].gap_m) << seed << ", step " << step;
        if (all[i].body_b >= moving) touched.insert(all[i].body_b);
      }
    }
    for (int body = 0; body < moving; ++body) ExpectTheSameBits(looked_up, each, body);
    EXPECT_EQ(looked_up.Status(0).bits, each.Status(0).bits);
    EXPECT_GT(touched.size(), 15u);  // the bodies touched many boxes
  }
}

TEST(ManyBoxes, GiveTheBitsOfTheFewInReach) {
  // Bodies of several shapes have their contacts by shape, then by box. Seven boxes form a well
  // that holds the robot, 400 lie outside of it, before and after the seven in the list.
  const auto well = [](ModelDef& def) {
    scenes::Chance chance(5);
    const auto add = [&](const Vec3& at, const Vec3& half, const Quat& q) {
      def.terrain_boxes.push_back({"near", at, q, half, kMaterial});
    };
    add({0, 0, -0.5}, {0.6, 0.6, 0.5}, {});
    for (const double side : {-1.0, 1.0}) {
      add({0.65 * side, 0, 0.5}, {0.05, 0.6, 1}, {});
      add({0, 0.65 * side, 0.5}, {0.6, 0.05, 1}, {});
    }
    for (int i = 0; i < 2; ++i) {
      add({chance.Within(-0.3, 0.3), chance.Within(-0.3, 0.3), 0}, {0.15, 0.1, 0.08},
          scenes::Turn(chance.Direction(), 0.7));
    }
  };
  ModelDef few;
  for (int i = 0; i < 3; ++i) {
    // A cross of three rods.
    scenes::Parts parts;
    scenes::Chance chance(static_cast<std::uint64_t>(10 + i));
    const Vec3 at{0.1 * i, -0.05 * i, 0.4 + 0.35 * i};
    for (int k = 0; k < 3; ++k) {
      const Vec3 half{k == 0 ? 0.15 : 0, k == 1 ? 0.15 : 0, k == 2 ? 0.15 : 0};
      parts.AddCylinder(0.1, at - half, at + half, 0.01);
      few.capsules.push_back({"rod", i, at - half, at + half, 0.01, kMaterial});
    }
    few.bodies.push_back(parts.Body("cross_" + std::to_string(i)));
    few.bodies.back().velocity_m_per_s = chance.Jolt(1);
    few.bodies.back().angular_velocity_rad_per_s = chance.Jolt(5);
  }
  ModelDef many = few;
  well(few);
  const auto add_far = [&](double x) {
    for (TerrainBoxDef box : Field(200, 7)) {
      box.center_m.x += x;
      many.terrain_boxes.push_back(box);
    }
  };
  add_far(-6), well(many), add_far(6);
  AddFarBall(kWorld, few), AddFarBall(kWorld, many);
  ASSERT_LE(few.terrain_boxes.size() + few.spheres.size(), 8u);
  WorldBatch looked_up = MakeBatch(many), each = MakeBatch(few);
  std::size_t most = 0;
  for (int step = 0; step < 2000; ++step) {
    looked_up.Step(1e-3), each.Step(1e-3);
    most = std::max(most, each.Contacts(0).size());
    ASSERT_EQ(looked_up.Contacts(0).size(), each.Contacts(0).size()) << step;
  }
  for (int body = 0; body < 3; ++body) ExpectTheSameBits(looked_up, each, body);
  EXPECT_GT(most, 6u);
}

TEST(ManyBoxes, LetNothingThrough) {
  // Overlaps are computed without the hierarchy.
  ModelDef def = Tumblers(8);
  def.terrain_boxes = Field(400, 8);
  WorldBatch world = MakeBatch(def);
  for (int step = 0; step < 1500; ++step) {
    world.Step(1e-3);
    for (const Overlap& overlap : world.Overlaps(0)) {
      ASSERT_LT(overlap.depth_m, 2e-3)
          << step << ": " << overlap.a.index << ", " << overlap.b.index;
    }
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
}

TEST(ManyBoxes, ABallThatIsSetDownElsewhereLooksAgain) {
  // The ball moves far from all boxes, so its clearance covers many steps.
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  def.restitution_combine = CombineRule::kMaximum;
  scenes::AddBall(def, "ball", 0.2, 0.1, {0, 0, 20}, kMaterial);
  def.bodies[0].velocity_m_per_s = {0, 0, -50};
  for (int i = 0; i < 20; ++i) {
    def.terrain_boxes.push_back({"tile", {i - 10.0, 0, -0.5}, {}, {0.5, 4, 0.5}, kMaterial});
  }
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3);
  BodyState at = world.Body(0, 0);
  at.position_m = {3.2, 0, 0.11};
  world.SetBodyState(0, 0, at);
  world.Step(1e-3, 10);
  EXPECT_NEAR(world.Body(0, 0).velocity_m_per_s.z, 0.2 * 50, 1e-9);
}

TEST(ManyBoxes, AreFoundInTheTreeByTheirBounds) {
  // Stones of millimeters next to walls of kilometers, some at the same place: exactly the boxes
  // whose bounds are near are marked.
  scenes::Chance chance(3);
  ModelDef def;
  scenes::AddBall(def, "ball", 0.2, 0.1, {0, 0, 20}, kMaterial);
  for (int i = 0; i < 333; ++i) {
    const double size = i % 50 == 0 ? 1e3 : 0.001 + 0.05 * (i % 7);
    const Vec3 at = i % 11 == 0 ? Vec3{0.5, 0, 0} : chance.Jolt(i % 5 == 0 ? 30 : 2);
    def.terrain_boxes.push_back({"stone",
                                 at,
                                 scenes::Turn(chance.Direction(), chance.Within(-3, 3)),
                                 {size, 0.3 * size, 0.02},
                                 kMaterial});
  }
  Diagnostics out;
  const auto model = Model::Compile(def, out);
  ASSERT_TRUE(model) << out.Format();
  const auto& tables = static_cast<const sim::Tables&>(*model);
  ASSERT_EQ(tables.tree_shapes, 333);
  std::size_t near = 0;
  for (int look = 0; look < 2000; ++look) {
    const Vec3 at = chance.Jolt(look % 3 == 0 ? 40 : 2);
    const double half = chance.Within(0, 0.3), reach = look % 4 == 0 ? 0 : chance.Within(0, 0.2);
    const sim::Bounds bounds{{at.x - half, at.y - half, at.z}, {at.x + half, at.y + half, at.z}};
    std::uint64_t marks[6] = {};
    sim::MarkNear(tables.tree.data(), static_cast<int>(tables.tree.size()), bounds, reach, marks);
    for (int i = 0, world = 0; i < static_cast<int>(tables.shapes.size()); ++i) {
      const sim::ShapeTable& shape = tables.shapes[static_cast<std::size_t>(i)];
      if (shape.body != tables.body_count) continue;
      const sim::Bounds b = sim::BoundsOf(shape.shape_P);
      bool expected = true;
      for (int axis = 0; axis < 3; ++axis) {
        if (b.low[axis] - bounds.high[axis] > reach) expected = false;
        if (bounds.low[axis] - b.high[axis] > reach) expected = false;
      }
      ASSERT_EQ(marks[world / 64] >> (world % 64) & 1, expected ? 1u : 0u) << look << ' ' << world;
      near += expected ? 1 : 0;
      ++world;
    }
  }
  EXPECT_GT(near, 5000u);
}

}  // namespace
}  // namespace taut::test
