// Boxes on height fields and meshes (docs/theory/ground.md, section 3).
#include <gtest/gtest.h>

#include "sim/geometry/shape_contacts.h"
#include "sim/geometry/surface_build.h"
#include "tests/constants.h"
#include "tests/physics/lanes_alike.h"
#include "tests/physics/world.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rough_ground.h"

namespace taut::test {
namespace {

using Split = HeightFieldDef::Split;

void AddFlat(ModelDef& def, int form, const Material& material) {
  HeightFieldDef field = scenes::Field(60, 60, 0.04, material, [](double, double) { return 0.0; });
  field.split = form == 0 ? Split::kSame : form == 1 ? Split::kAlternating : Split::kShortest;
  if (form < 3) {
    def.height_fields.push_back(field);
  } else {  // upper face of a solid
    TerrainMeshDef slab;
    slab.name = "slab";
    slab.material = material;
    for (int i = 0; i < 8; ++i) {
      slab.corners_m.push_back({i & 1 ? 1.2 : -1.1, i & 2 ? 1.3 : -1.1, i & 4 ? 0.0 : -0.5});
    }
    slab.triangles = {{4, 5, 7}, {4, 7, 6}, {0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    def.terrain_meshes.push_back(slab);
  }
}

TEST(BoxOnGround, OnAFlatFieldABoxMovesAsOnAPlane) {
  const Material material{0.3, 0.3, 0};
  for (int form = 0; form < 4; ++form) {
    ModelDef ground, plane;
    for (ModelDef* def : {&ground, &plane}) {
      scenes::AddBox(*def, "box", 0.7, {0.1, 0.07, 0.05}, {-0.4, 0.013, 0.06},
                     scenes::Turn({0, 0, 1}, 0.4), material);
      def->bodies[0].velocity_m_per_s = {1.2, 0.3, 0};
      def->bodies[0].angular_velocity_rad_per_s = {0, 0, 2};
    }
    AddFlat(ground, form, material);
    plane.planes.push_back({"plane", {0, 0, 1}, {}, material});
    WorldBatch a = MakeBatch(ground), b = MakeBatch(plane);
    for (int i = 0; i < 10; ++i) {
      a.Step(1e-3, 60);
      b.Step(1e-3, 60);
      EXPECT_LE(Distance(a.Body(0, 0).position_m, b.Body(0, 0).position_m),
                SolverError(60 * (i + 1)))
          << form << " after " << a.Time(0);
    }
    EXPECT_LT(Norm(a.Body(0, 0).velocity_m_per_s), 1e-9);
  }
}

TEST(BoxOnGround, ThreePeaksCarryTheirSharesOfABox) {
  // Statics: the center of mass is at (0.02, 0.01); the moments of the loads about it vanish.
  const double p[3][2] = {{-0.06, -0.05}, {0.08, -0.04}, {0.01, 0.07}};
  ModelDef def;
  TerrainMeshDef mesh;
  mesh.name = "peaks";
  mesh.material = {0.5, 0.5, 0};
  for (const auto& peak : p) {
    const int first = static_cast<int>(mesh.corners_m.size());
    for (const auto& [x, y] :
         {std::pair{-0.02, -0.02}, {0.02, -0.02}, {0.02, 0.02}, {-0.02, 0.02}}) {
      mesh.corners_m.push_back({peak[0] + x, peak[1] + y, -0.05});
    }
    mesh.corners_m.push_back({peak[0], peak[1], 0});
    mesh.triangles.push_back({first, first + 2, first + 1});
    mesh.triangles.push_back({first, first + 3, first + 2});
    for (int k = 0; k < 4; ++k) {
      mesh.triangles.push_back({first + k, first + (k + 1) % 4, first + 4});
    }
  }
  def.terrain_meshes.push_back(mesh);
  scenes::AddBox(def, "box", 2, {0.12, 0.12, 0.03}, {0.02, 0.01, 0.03}, {}, {0.5, 0.5, 0});
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 500);
  EXPECT_LE(Norm(world.Body(0, 0).velocity_m_per_s), 1e-9);
  EXPECT_NEAR(world.Body(0, 0).position_m.z, 0.03, 1e-8);
  const std::vector<ContactState> contacts = world.Contacts(0);
  ASSERT_EQ(contacts.size(), 3u);
  const double area =
      (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
  for (const ContactState& c : contacts) {
    int k = 0;
    while (std::abs(p[k][0] - c.point_m.x) > 1e-6) ASSERT_LT(++k, 3);
    const double* const q = p[(k + 1) % 3];
    const double* const r = p[(k + 2) % 3];
    const double share = ((q[0] - 0.02) * (r[1] - 0.01) - (r[0] - 0.02) * (q[1] - 0.01)) / area;
    EXPECT_NEAR(c.force_n.z, 2 * kG * share, 1e-6) << k;
  }
}

enum class Form { kField, kSheet, kSolid };

/// Returns the triangles of a height field as a mesh: as a solid with walls and a bottom, or as a
/// surface.
TerrainMeshDef AsMesh(const HeightFieldDef& field, bool solid) {
  TerrainMeshDef mesh = scenes::MeshOf(field);
  mesh.solid = solid;
  if (!solid) return mesh;
  const int w = field.columns, h = field.rows;
  std::vector<int> border;
  for (int i = 0; i + 1 < w; ++i) border.push_back(i);
  for (int j = 0; j + 1 < h; ++j) border.push_back(j * w + w - 1);
  for (int i = w - 1; i > 0; --i) border.push_back((h - 1) * w + i);
  for (int j = h - 1; j > 0; --j) border.push_back(j * w);
  const int below = static_cast<int>(mesh.corners_m.size()), n = static_cast<int>(border.size());
  for (const int c : border) {
    Vec3 p = mesh.corners_m[static_cast<std::size_t>(c)];
    p.z = -1;
    mesh.corners_m.push_back(p);
  }
  mesh.corners_m.push_back({0, 0, -1});
  for (int k = 0; k < n; ++k) {
    const int a = border[static_cast<std::size_t>(k)];
    const int b = border[static_cast<std::size_t>((k + 1) % n)];
    const int c = below + k, d = below + (k + 1) % n;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
    mesh.triangles.push_back({c, below + n, d});
  }
  return mesh;
}

ModelDef BoxesOverHills(std::uint64_t seed, Form form = Form::kField) {
  const Material material{0.6, 0.5, 0.0};
  ModelDef def;
  scenes::Chance chance(seed);
  for (int i = 0; i < 3; ++i) {
    const Vec3 half{chance.Within(0.01, 0.1), chance.Within(0.01, 0.1), chance.Within(0.01, 0.1)};
    scenes::AddBox(def, "box_" + std::to_string(i), 0.3, half,
                   {chance.Within(-0.6, 0.6), chance.Within(-0.6, 0.6), 0.25 + 0.3 * i},
                   scenes::Turn(chance.Direction(), chance.Within(0.0, 3.0)), material);
  }
  const HeightFieldDef hills = scenes::Hills(80, 80, material);
  if (form == Form::kField) {
    def.height_fields.push_back(hills);
  } else {
    def.terrain_meshes.push_back(AsMesh(hills, form == Form::kSolid));
  }
  return def;
}

/// Returns the deepest penetration of hills and a box [m], sampled along the edges of the triangles
/// and of the box.
double DeepestOf(const BoxDef& box, const BodyState& body, const BodyDef& start,
                 const sim::SurfaceTable& hills) {
  const Quat turn = body.orientation * box.orientation;
  const Vec3 center = body.position_m + Rotate(body.orientation, box.center_m - start.com_m);
  const Vec3 half = box.half_extents_m;
  double deepest_m = 0;
  const auto along = [&](const Vec3& from, const Vec3& to, const auto& depth_at) {
    for (int i = 0; i <= 16; ++i) {
      deepest_m = std::max(deepest_m, depth_at(from + (i / 16.0) * (to - from)));
    }
  };
  const auto corner = [&](int bits) {
    return center + Rotate(turn, {bits & 1 ? half.x : -half.x, bits & 2 ? half.y : -half.y,
                                  bits & 4 ? half.z : -half.z});
  };
  Vec3 low = center, high = center;
  for (int a = 0; a < 8; ++a) {
    const Vec3 p = corner(a);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    for (int axis = 0; axis < 3; ++axis) {
      // The steepest slope of these hills is 1 in 2: below it the shortest way out is upwards.
      along(p, corner(a | 1 << axis),
            [&](const Vec3& x) { return std::sqrt(0.8) * sim::DepthBelow(hills, x); });
    }
  }
  sim::EachTriangle(hills, low, high, [&](const sim::SurfaceTriangle& t) noexcept {
    for (int k = 0; k < 3; ++k) {
      along(t.p[k], t.p[(k + 1) % 3], [&](const Vec3& x) {
        const Vec3 at = Rotate(Conjugate(turn), x - center);
        return std::min(
            {half.x - std::abs(at.x), half.y - std::abs(at.y), half.z - std::abs(at.z)});
      });
    }
  });
  return deepest_m;
}

class BoxesOnHills : public testing::TestWithParam<Form> {};

TEST_P(BoxesOnHills, EnergyNeverRisesAndNothingSinksIn) {
  double highest_m = 0, deepest_m = 0;
  const sim::Surface hills(scenes::Hills(80, 80, {}));
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const ModelDef def = BoxesOverHills(seed, GetParam());
    WorldBatch world = MakeBatch(def);
    double least_j = EnergyOf(world);
    for (int i = 0; i < 2000; ++i) {
      world.Step(1e-3, 1);
      const double now_j = EnergyOf(world);
      highest_m = std::max(highest_m, (now_j - least_j) / (0.9 * kG));
      least_j = std::min(least_j, now_j);
      for (std::size_t b = 0; b < 3; ++b) {
        const BodyState body = world.Body(0, static_cast<int>(b));
        deepest_m =
            std::max(deepest_m, DeepestOf(def.boxes[b], body, def.bodies[b], hills.table()));
      }
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk) << "seed " << seed;
    for (int b = 0; b < 3; ++b) EXPECT_GT(world.Body(0, b).position_m.z, -0.02) << seed << " " << b;
  }
  EXPECT_LE(highest_m, 1e-4);
  EXPECT_LE(deepest_m, 2e-4);
  RecordProperty("highest_um", std::to_string(1e6 * highest_m));
  RecordProperty("deepest_um", std::to_string(1e6 * deepest_m));
}

INSTANTIATE_TEST_SUITE_P(Forms, BoxesOnHills,
                         testing::Values(Form::kField, Form::kSheet, Form::kSolid));

TEST(BoxOnGround, LanesHaveTheBitsOfAWorldAlone) {
  for (const Form form : {Form::kField, Form::kSheet}) {
    const ModelDef def = BoxesOverHills(5, form);
    ExpectLanesLikeWorldsAlone(def, {0.07, -0.05, 0}, 600);
  }
}

TEST(BoxOnGround, WhenItIsLookedAtChangesNothing) {
  const ModelDef def = BoxesOverHills(3);
  WorldBatch goes_on = MakeBatch(def), looks = MakeBatch(def);
  for (int i = 0; i < 900; ++i) {
    goes_on.Step(1e-3, 1);
    ASSERT_TRUE(looks.Restore(0, looks.Save(0)));
    looks.Step(1e-3, 1);
    ASSERT_EQ(goes_on.Hash(0), looks.Hash(0)) << i;
  }
}

}  // namespace
}  // namespace taut::test
