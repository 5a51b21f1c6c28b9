// Nearest places of a surface: against a search of every triangle, and against the definition, by
// sampling the surface
#include "unit/sim/surface_helpers.h"

#include <gtest/gtest.h>

namespace taut::sim {
namespace {

/// Returns the distance of a point from the border walls of a field: the way out if it is inside;
/// else to the nearest wall point at its height.
double DistanceToWalls(const SurfaceTable& s, const Vec3& p, bool below) {
  if (below) {
    return std::min({p.x - s.low.x, s.high.x - p.x, p.y - s.low.y, s.high.y - p.y});
  }
  const double x = std::clamp(p.x, s.low.x, s.high.x), y = std::clamp(p.y, s.low.y, s.high.y);
  return p.z < HeightAt(s, x, y) ? std::hypot(p.x - x, p.y - y) : 1e300;
}

TEST(Surface, TrianglesAcrossTheWholeMeshFillFewBuckets) {
  // 236 kB as an STL. In all buckets of their bounding boxes they would be 4.3e9 entries.
  TerrainMeshDef mesh;
  const int count = 4720;
  mesh.corners_m = {{0, 0, 0}, {1, 1, 1}};
  for (int i = 0; i < count; ++i) {
    mesh.corners_m.push_back({0, (i + 1.0) / (count + 1), 0.5});
    mesh.triangles.push_back({0, 1, i + 2});
  }
  const Surface surface(mesh);
  const SurfaceTable& t = surface.table();
  EXPECT_LE(t.first_in_bucket[t.buckets[0] * t.buckets[1] * t.buckets[2]], 16 * count + 1'000'000);
  // A mesh of ordinary triangles keeps its usual buckets.
  const Known usual(scenes::MeshOf(RoughField(1, 40, 40)));
  EXPECT_LE(usual.table().first_in_bucket[usual.table().buckets[0] * usual.table().buckets[1] *
                                          usual.table().buckets[2]],
            16 * 3042);
}

TEST(NearestPlaces, TheFirstIsTheNearestOfAllTrianglesAndWalls) {
  int inside = 0, outside = 0, walls = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const Known field(RoughField(seed));
    Points3 random(seed);
    for (int k = 0; k < 100; ++k) {
      const Vec3 p = Vec3{0.3, -0.2, 0.1} + random.Within(0.5, -0.15, 0.3);
      const Vec3 nearest = field.NearestTo(p);
      SurfacePlace places[8];
      const double limit_m = 0.25;
      const int count = NearestPlaces(field.table(), p, limit_m, places, 8);
      const bool within = std::abs(p.x - 0.3) <= 0.4 && std::abs(p.y + 0.2) <= 0.35;
      const bool below = within && p.z < HeightAt(field.table(), p.x, p.y);
      // From the inside a wall must be nearer by a tenth (docs/theory/ground.md, section 1).
      const double wall = DistanceToWalls(field.table(), p, below), face = Length(p - nearest);
      const bool at_wall = below ? wall < 0.9 * face - 1e-6 : wall < face;
      const double least = at_wall ? wall : face;
      if (!below && least > limit_m) {
        EXPECT_EQ(count, 0);
        continue;
      }
      walls += at_wall ? 1 : 0;
      (below ? inside : outside) += 1;
      ASSERT_GT(count, 0);
      EXPECT_EQ(places[0].distance_m < 0, below);
      EXPECT_NEAR(std::abs(places[0].distance_m), least, 1e-12);
      EXPECT_TRUE(!below || count == 1);
    }
  }
  EXPECT_GT(walls, 100);
  EXPECT_GT(inside, 300);
  EXPECT_GT(outside, 1000);
}

TEST(NearestPlaces, EachIsNearerThanAllAroundItAndNoneIsMissing) {
  int several = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Known field(RoughField(seed));
    Points3 random(100 + seed);
    // Samples of the surface, 4 mm apart.
    std::vector<Vec3> samples;
    constexpr int kParts = 25;
    for (const SurfaceTriangle& t : field.triangles) {
      for (int a = 0; a <= kParts; ++a) {
        for (int b = 0; a + b <= kParts; ++b) {
          const double u = static_cast<double>(a) / kParts, v = static_cast<double>(b) / kParts;
          samples.push_back(t.p[0] + u * (t.p[1] - t.p[0]) + v * (t.p[2] - t.p[0]));
        }
      }
    }
    for (int k = 0; k < 6; ++k) {
      const Vec3 p = Vec3{0.3, -0.2, 0.1} + random.Within(0.3, 0.05, 0.2);
      if (p.z < HeightAt(field.table(), p.x, p.y) + 0.01) continue;
      SurfacePlace places[8];
      const double limit_m = 0.2;
      const int count = NearestPlaces(field.table(), p, limit_m, places, 8);
      several += count > 1 ? 1 : 0;
      for (int i = 0; i < count; ++i) {
        for (int turn = 0; turn < 12; ++turn) {
          const Vec3 aside{1e-5 * std::cos(0.5236 * turn), 1e-5 * std::sin(0.5236 * turn), 0};
          const Vec3 q = field.NearestTo(places[i].at + aside);
          EXPECT_GE(Length(p - q), places[i].distance_m - 1e-12);
        }
      }
      // A sample that is clearly nearer than its neighbors is next to a place that was found.
      for (const Vec3& q : samples) {
        const double distance = Length(p - q);
        if (distance > limit_m - 0.01) continue;
        bool least = true, found = false;
        for (const Vec3& other : samples) {
          const double apart = Length(q - other);
          if (apart > 0.02) continue;
          least = least && Length(p - other) >= distance;
        }
        if (!least) continue;
        for (int i = 0; i < count; ++i) found = found || Length(q - places[i].at) < 0.01;
        EXPECT_TRUE(found) << "seed " << seed << ": " << q.x << " " << q.y << " " << q.z;
      }
    }
  }
  EXPECT_GT(several, 4);
}

TEST(NearestPlaces, AClosedMeshHasAnInside) {
  const Known cube(CubeMesh());
  Points3 random(5);
  for (int k = 0; k < 400; ++k) {
    const Vec3 p = random.Within(0.3, -0.3, 0.3);
    SurfacePlace places[4];
    const int count = NearestPlaces(cube.table(), p, 0.2, places, 4);
    const double out[3] = {std::abs(p.x) - 0.2, std::abs(p.y) - 0.2, std::abs(p.z) - 0.2};
    const double most = std::max({out[0], out[1], out[2]});
    ASSERT_EQ(count, 1) << "a convex thing has one nearest place";
    double beyond = 0;
    for (const double x : out) beyond += x > 0 ? x * x : 0;
    EXPECT_NEAR(places[0].distance_m, most < 0 ? most : std::sqrt(beyond), 1e-12);
    // The normal points along the way out, or away.
    EXPECT_NEAR(Length(p - places[0].at - places[0].distance_m * places[0].normal), 0, 1e-12);
  }
}

TEST(NearestPlaces, AboveAnEdgeOfOnePlaneThereIsOnePlace) {
  const Known flat(scenes::MeshOf(
      scenes::Field(12, 12, 0.1, {}, [](double x, double y) { return 0.37 * x - 0.21 * y; }), 3));
  const Vec3 up = (1 / std::sqrt(1 + 0.37 * 0.37 + 0.21 * 0.21)) * Vec3{-0.37, 0.21, 1};
  Points3 random(4);
  for (const SurfaceTriangle& t : flat.triangles) {
    for (int k = 0; k < 3; ++k) {
      for (const double share : {0.0, 1e-9, random.Between(0, 1)}) {
        const Vec3 foot = t.p[k] + share * (t.p[(k + 1) % 3] - t.p[k]);
        if (std::abs(foot.x) > 0.5 || std::abs(foot.y) > 0.5) continue;
        SurfacePlace places[8];
        for (const double height_m : {0.003, 0.05, 0.7}) {
          const Vec3 p = foot + height_m * up;
          ASSERT_EQ(NearestPlaces(flat.table(), p, height_m + 0.01, places, 8), 1);
          EXPECT_LT(Length(places[0].normal - up), 1e-12);
        }
      }
    }
  }
}

TEST(NearestPlaces, AboveACornerOfAStraightRidgeThereIsOnePlace) {
  // Two planes: no corner of their ridge protrudes, and its edges must leave no gap between them.
  for (const double rise : {0.0, 0.1, 0.37}) {
    const Known roof(scenes::Field(
        21, 41, 0.1, {}, [&](double x, double y) { return -0.7 * std::abs(x) + rise * y; }));
    const double length = std::sqrt(1 + rise * rise);
    const Vec3 up{0, -rise / length, 1 / length};
    for (int j = 5; j < 36; ++j) {
      const double y = (j - 20) * 0.1;
      for (const double height_m : {0.003, 0.02, 0.05}) {
        for (const double aside_m : {-1e-12, -1e-16, 0.0, 1e-16, 1e-12}) {
          const Vec3 p = Vec3{0, y + aside_m, rise * y} + height_m * up;
          SurfacePlace places[4];
          ASSERT_EQ(NearestPlaces(roof.table(), p, 1.1 * height_m, places, 4), 1);
          EXPECT_NEAR(places[0].distance_m, height_m, 1e-12);
        }
      }
    }
  }
}

TEST(NearestPlaces, APointDeepInAFieldIsFoundHoweverSmallTheLimit) {
  const Known flat(scenes::Field(12, 12, 0.1, {}, [](double, double) { return 0.0; }));
  SurfacePlace place;
  ASSERT_EQ(NearestPlaces(flat.table(), {0.03, 0.04, -0.35}, 0.001, &place, 1), 1);
  EXPECT_NEAR(place.distance_m, -0.35, 1e-15);
  EXPECT_LT(Length(place.normal - Vec3{0, 0, 1}), 1e-15);
}

}  // namespace
}  // namespace taut::sim
