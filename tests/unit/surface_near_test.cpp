// Where a surface is nearest: beside a look at every triangle, and beside what the words say, tried
// by sampling the surface around.
#include "sim/surface_near.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scenes/rough_ground.h"
#include "sim/shape_contacts.h"
#include "sim/surface_build.h"
#include "unit/shape_helpers.h"

namespace taut::sim {
namespace {

constexpr double kInf = 1e300;

/// A surface and all of its triangles.
struct Known {
  Surface surface;
  std::vector<SurfaceTriangle> triangles;

  template <class Def>
  explicit Known(const Def& def) : surface(def) {
    const Vec3 everywhere{1e6, 1e6, 1e6};
    EachTriangle(table(), Vec3{} - everywhere, everywhere,
                 [&](const SurfaceTriangle& t) noexcept { triangles.push_back(t); });
  }
  const SurfaceTable& table() const { return surface.table(); }

  /// The place nearest to a point, by trying all triangles: faces, edges, corners.
  Vec3 NearestTo(const Vec3& p) const {
    Vec3 best;
    double least = kInf;
    const auto take = [&](const Vec3& q) {
      if (Length(p - q) < least) least = Length(p - q), best = q;
    };
    for (const SurfaceTriangle& t : triangles) {
      const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
      const Vec3 foot = p - (Dot(n, p - t.p[0]) / Dot(n, n)) * n;
      bool within = true;
      for (int k = 0; k < 3; ++k) {
        const Vec3 edge = t.p[(k + 1) % 3] - t.p[k];
        within = within && Dot(Cross(edge, foot - t.p[k]), n) >= 0;
        const double share = std::clamp(Dot(p - t.p[k], edge) / Dot(edge, edge), 0.0, 1.0);
        take(t.p[k] + share * edge);
      }
      if (within) take(foot);
    }
    return best;
  }
};

HeightFieldDef RoughField(unsigned seed, int columns = 9, int rows = 8) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> height(-0.05, 0.05);
  HeightFieldDef field =
      scenes::Field(columns, rows, 0.1, {}, [&](double, double) { return height(random); });
  field.split = static_cast<HeightFieldDef::Split>(seed % 3);
  field.origin_m = {0.3, -0.2, 0.1};
  return field;
}

/// A cube with corners at +-0.2, seen from outside.
TerrainMeshDef CubeMesh() {
  TerrainMeshDef mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.corners_m.push_back({i & 1 ? 0.2 : -0.2, i & 2 ? 0.2 : -0.2, i & 4 ? 0.2 : -0.2});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

class Points3 {
 public:
  explicit Points3(unsigned seed) : random_(seed) {}
  Vec3 Within(double x, double low, double high) {
    return {Between(-x, x), Between(-x, x), Between(low, high)};
  }
  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937 random_;
};

TEST(NearestPlaces, TheFirstIsTheNearestOfAllTriangles) {
  int inside = 0, outside = 0;
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
      if (!below && Length(p - nearest) > limit_m) {
        EXPECT_EQ(count, 0);
        continue;
      }
      (below ? inside : outside) += 1;
      ASSERT_GT(count, 0);
      EXPECT_EQ(places[0].distance_m < 0, below);
      EXPECT_NEAR(std::abs(places[0].distance_m), Length(p - nearest), 1e-12);
      EXPECT_TRUE(!below || count == 1);
    }
  }
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
      // A sample that is clearly nearer than those around it lies beside a place that was found.
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
    // The way out, or away.
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

TEST(NearestPlaces, APointDeepInAFieldIsFoundHoweverSmallTheLimit) {
  const Known flat(scenes::Field(12, 12, 0.1, {}, [](double, double) { return 0.0; }));
  SurfacePlace place;
  ASSERT_EQ(NearestPlaces(flat.table(), {0.03, 0.04, -0.35}, 0.001, &place, 1), 1);
  EXPECT_NEAR(place.distance_m, -0.35, 1e-15);
  EXPECT_LT(Length(place.normal - Vec3{0, 0, 1}), 1e-15);
}

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
  // A little under it, it is to leave the same way.
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
      // By sampling the line.
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
      // Beyond a sixteenth of its size it goes by bounds.
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
    def.split = HeightFieldDef::Split::kAlternating;  // as that of the mesh
    const Known field(def), mesh(scenes::MeshOf(def));
    const Vec3 middle = def.origin_m;
    Points3 random(seed);
    for (int k = 0; k < 300; ++k) {
      const Vec3 a = middle + random.Within(1.0, 0.0, 0.4),
                 b = middle + random.Within(1.0, 0.0, 0.4);
      const double radius_m = 0.02;
      // Lines through it are other ones: a mesh that is not closed has no inside.
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
  // Roofs along y, 0.2 m apart, each at its height: what is looked for is known without a search.
  const auto height = [](double x) {
    const double at = x / 0.2 - std::floor(x / 0.2);
    return 0.1 * (1 - std::abs(2 * at - 1)) + 0.01 * std::floor(x / 0.2);
  };
  const Known roofs(
      scenes::Field(41, 21, 0.1, {}, [&](double x, double) { return height(x + 1e-9); }));
  const double radius_m = 0.02;
  // Along the line that their ridges, at x = 0.1 + 0.2 k, have in common.
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

}  // namespace
}  // namespace taut::sim
