// Edges and corners of a surface that touch the side of a rod, and the rod's distance from the
// surface
#include <gtest/gtest.h>

#include <array>

#include "sim/geometry/shape_contacts.h"
#include "unit/sim/surface_helpers.h"

namespace taut::sim {
namespace {

TEST(NearestAlong, ARodAcrossARidgeTouchesItWhereTheyCross) {
  // A roof along y, 45 degrees.
  const Known roof(scenes::Field(3, 5, 1.0, {}, [](double x, double) { return -std::abs(x); }));
  LinePlace found[4];
  const int count = NearestAlong(
      roof.table(), ReachOfLine(roof.table(), {-0.5, 0.3, 0.05}, {0.5, 0.3, 0.05}, 0.06), 0.05,
      found, 4);
  ASSERT_EQ(count, 1);
  EXPECT_NEAR(found[0].share, 0.5, 1e-12);
  EXPECT_LT(Length(found[0].place.at - Vec3{0, 0.3, 0}), 1e-12);
  EXPECT_LT(Length(found[0].place.normal - Vec3{0, 0, 1}), 1e-12);
  EXPECT_NEAR(found[0].place.distance_m, 0.05, 1e-12);
  // Slightly below it, the direction out is the same.
  ASSERT_EQ(NearestAlong(roof.table(),
                         ReachOfLine(roof.table(), {-0.5, 0.3, -0.01}, {0.5, 0.3, -0.01}, 0.06),
                         0.05, found, 4),
            1);
  EXPECT_LT(Length(found[0].place.normal - Vec3{0, 0, 1}), 1e-12);
  EXPECT_NEAR(found[0].place.distance_m, -0.01, 1e-12);
  // In a valley only its ends touch.
  const Known valley(scenes::Field(3, 5, 1.0, {}, [](double x, double) { return std::abs(x); }));
  EXPECT_EQ(NearestAlong(valley.table(),
                         ReachOfLine(valley.table(), {-0.5, 0.3, 0.52}, {0.5, 0.3, 0.52}, 0.06),
                         0.05, found, 4),
            0);
}

TEST(NearestAlong, OnAPlaneOfTrianglesThereIsNothingBetweenTheEnds) {
  const Known flat(scenes::MeshOf(
      scenes::Field(20, 20, 0.1, {}, [](double x, double y) { return 0.3 * x - 0.2 * y; }), 3));
  Points3 random(8);
  for (int k = 0; k < 200; ++k) {
    Vec3 ends[2];
    for (Vec3& end : ends) {
      end = random.Within(0.7, 0, 0);
      end.z = 0.3 * end.x - 0.2 * end.y + 0.02 * std::sqrt(1 + 0.13);
    }
    LinePlace found[4];
    EXPECT_EQ(NearestAlong(flat.table(), ReachOfLine(flat.table(), ends[0], ends[1], 0.03), 0.02,
                           found, 4),
              0)
        << k;
  }
}

TEST(NearestAlong, WhatIsFoundIsTheDistanceOfTheLineWhereItIsLeast) {
  int between = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Known field(RoughField(seed));
    Points3 random(seed);
    for (int k = 0; k < 60; ++k) {
      Vec3 a = random.Within(0.3, 0.06, 0.12), b = random.Within(0.3, 0.06, 0.12);
      const Vec3 origin{0.3, -0.2, 0.1};
      a = a + origin, b = b + origin;
      // The reference distance, by sampling the line.
      double least = kInf, at = 0;
      constexpr int kSamples = 400;
      for (int i = 0; i <= kSamples; ++i) {
        const Vec3 p = a + (static_cast<double>(i) / kSamples) * (b - a);
        if (p.z < HeightAt(field.table(), p.x, p.y)) least = -1;
        const double distance = Length(p - field.NearestTo(p));
        if (distance < least) least = distance, at = static_cast<double>(i) / kSamples;
      }
      if (least < 0.005) continue;
      const double step_m = Length(b - a) / kSamples;
      const RoundShape rod{{a.x, a.y, a.z}, {b.x, b.y, b.z}, 1e-3};
      const double bound = DistanceUpTo(rod, SurfaceShape{&field.table()}, 0.3);
      EXPECT_LE(bound, least);
      EXPECT_EQ(DistanceUpTo(rod, SurfaceShape{&field.table()}, 0.0), 0.0);
      // Beyond a sixteenth of the rod's size, the distance is only a bound.
      const double near = (Length(b - a) + 1e-3) / 16;
      if (least - 1e-3 < near) {
        EXPECT_GE(bound, least - 1e-3 - 1e-5 - step_m);
      }
      if (at < 0.03 || at > 0.97 || least > 0.08) continue;
      ++between;
      LinePlace found[8];
      const int count =
          NearestAlong(field.table(), ReachOfLine(field.table(), a, b, 0.1), 0.01, found, 8);
      double nearest = kInf;
      for (int i = 0; i < count; ++i) nearest = std::min(nearest, found[i].place.distance_m);
      EXPECT_NEAR(nearest, least, step_m) << "seed " << seed << ", line " << k;
      EXPECT_LE(nearest, least + 1e-12);
    }
  }
  EXPECT_GT(between, 50);
}

TEST(NearestAlong, AFieldAndItsMeshAreTheSame) {
  int found_along = 0, found_places = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    HeightFieldDef def = RoughField(seed, 30, 25);
    def.split = HeightFieldDef::Split::kAlternating;  // as in the mesh
    const Known field(def), mesh(scenes::MeshOf(def));
    const Vec3 middle = def.origin_m;
    Points3 random(seed);
    for (int k = 0; k < 300; ++k) {
      const Vec3 a = middle + random.Within(1.0, 0.0, 0.4),
                 b = middle + random.Within(1.0, 0.0, 0.4);
      const double radius_m = 0.02;
      // Lines through the surface differ: an open mesh has no inside.
      bool above = true;
      for (int i = 0; i <= 1000; ++i) {
        const Vec3 p = a + 1e-3 * i * (b - a);
        above = above && p.z > HeightAt(field.table(), p.x, p.y) + 0.003;
      }
      if (!above) continue;
      LinePlace of_field[16], of_mesh[16];
      const double limit_m = 0.03;
      const int count = NearestAlong(field.table(), ReachOfLine(field.table(), a, b, limit_m),
                                     radius_m, of_field, 16);
      ASSERT_EQ(NearestAlong(mesh.table(), ReachOfLine(mesh.table(), a, b, limit_m), radius_m,
                             of_mesh, 16),
                count);
      for (int i = 0; i < count; ++i) {
        EXPECT_NEAR(of_field[i].share, of_mesh[i].share, 1e-9);
        EXPECT_LT(Length(of_field[i].place.at - of_mesh[i].place.at), 1e-9);
        EXPECT_LT(Length(of_field[i].place.normal - of_mesh[i].place.normal), 1e-9);
      }
      found_along += count;
      SurfacePlace at_field[8], at_mesh[8];
      const int places = NearestPlaces(field.table(), a, 0.1, at_field, 8);
      ASSERT_EQ(NearestPlaces(mesh.table(), a, 0.1, at_mesh, 8), places);
      for (int i = 0; i < places; ++i) {
        EXPECT_LT(Length(at_field[i].at - at_mesh[i].at), 1e-9);
      }
      found_places += places;
    }
  }
  EXPECT_GT(found_along, 30);
  EXPECT_GT(found_places, 200);
}

TEST(NearestAlong, ARodLyingOnRidgesTouchesEachOfThem) {
  // Roofs along y, 0.2 m apart, at different heights: the expected contacts are known without a
  // search.
  const auto height = [](double x) {
    const double at = x / 0.2 - std::floor(x / 0.2);
    return 0.1 * (1 - std::abs(2 * at - 1)) + 0.01 * std::floor(x / 0.2);
  };
  const Known roofs(
      scenes::Field(41, 21, 0.1, {}, [&](double x, double) { return height(x + 1e-9); }));
  const double radius_m = 0.02;
  // Along the line through their ridges, at x = 0.1 + 0.2 k.
  const Vec3 a{-0.85, 0.33, 0.1 - 0.05 + radius_m + 0.0025},
      b{0.85, 0.38, 0.1 + 0.035 + radius_m + 0.0025};
  LinePlace found[16];
  const int count =
      NearestAlong(roofs.table(), ReachOfLine(roofs.table(), a, b, 0.03), radius_m, found, 16);
  ASSERT_EQ(count, 8);
  for (int i = 0; i < count; ++i) {
    EXPECT_NEAR(found[i].place.at.x, -0.7 + 0.2 * i, 1e-3);
    EXPECT_GT(found[i].place.normal.z, 0.99);
  }
}

TEST(NearestAlong, OfTwoRidgesInOnePlaceOfARodTheNearerCounts) {
  // A roof above another, as one mesh, in either order.
  for (const bool upper_first : {false, true}) {
    TerrainMeshDef mesh;
    mesh.solid = false;
    for (const double z : {upper_first ? 0.0 : -0.01, upper_first ? -0.01 : 0.0}) {
      const int first = static_cast<int>(mesh.corners_m.size());
      for (const double y : {-1.0, 1.0}) {
        for (const double x : {-1.0, 0.0, 1.0}) {
          mesh.corners_m.push_back({x, y, z - std::abs(x)});
        }
      }
      for (const auto& t : {std::array{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}) {
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      }
    }
    const Known roofs(mesh);
    LinePlace found[4];
    const auto line = ReachOfLine(roofs.table(), {-0.5, 0.3, 0.05}, {0.5, 0.3, 0.05}, 0.07);
    ASSERT_EQ(NearestAlong(roofs.table(), line, 0.05, found, 4), 1) << upper_first;
    EXPECT_NEAR(found[0].place.distance_m, 0.05, 1e-12) << upper_first;
  }
}

}  // namespace
}  // namespace taut::sim
