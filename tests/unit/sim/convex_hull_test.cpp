// Convex hulls, and mass properties of meshes
#include "math/convex_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "math/rotation.h"
#include "math/vec.h"
#include "mechanics/mass_properties.h"

namespace taut::math {
namespace {

Quat Unit(const Quat& q) {
  const double size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / size, q.x / size, q.y / size, q.z / size};
}

std::vector<Vec3> Ball(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> one;
  std::vector<Vec3> points;
  while (static_cast<int>(points.size()) < count) {
    const double x = one(random), y = one(random), z = one(random);
    const Vec3 p{x, y, z};
    points.push_back((1 / Length(p)) * p);
  }
  return points;
}

/// Checks that every edge occurs once in each direction, Euler's formula, and that no point is
/// outside.
void ExpectHullOf(const std::vector<Vec3>& points, const ConvexHull& hull, double out_m) {
  std::set<std::pair<int, int>> edges;
  std::size_t sides = 0;
  for (const std::vector<int>& face : hull.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      edges.insert({face[i], face[(i + 1) % face.size()]});
      ++sides;
    }
    const auto corner = [&](std::size_t i) {
      return hull.corners[static_cast<std::size_t>(face[i])];
    };
    const Vec3 n = Cross(corner(1) - corner(0), corner(2) - corner(0));
    for (const Vec3& p : points) EXPECT_LE(Dot(n, p - corner(0)), out_m * Length(n));
  }
  EXPECT_EQ(edges.size(), sides);
  for (const auto& [from, to] : edges) EXPECT_EQ(edges.count({to, from}), 1u);
  EXPECT_EQ(hull.corners.size() + hull.faces.size(), sides / 2 + 2);
  EXPECT_TRUE(FindFaults(hull.corners, TrianglesOf(hull), true, 1).empty());
}

TEST(ConvexHull, OfACubeItHasItsCornersOnly) {
  std::vector<Vec3> points;
  for (int x = 0; x <= 4; ++x) {
    for (int y = 0; y <= 4; ++y) {
      for (int z = 0; z <= 4; ++z) points.push_back({0.25 * x, 0.25 * y, 0.25 * z});
    }
  }
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-3, 3);
  for (int turn = 0; turn < 30; ++turn) {
    const double a = any(random), b = any(random), c = any(random);
    const Quat q = Unit({1, a, b, c});
    std::vector<Vec3> turned;
    for (const Vec3& p : points) {
      const Vec3 at = Rotate(q, p);
      // In single precision, as in STL files.
      turned.push_back(
          {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)});
    }
    const ConvexHull hull = HullOf(turned, 64);
    EXPECT_EQ(hull.corners.size(), 8u);
    EXPECT_EQ(hull.faces.size(), 6u);
    ExpectHullOf(turned, hull, 1e-6);
    EXPECT_NEAR(SixVolumes(hull.corners, TrianglesOf(hull)), 6, 1e-5);
  }
}

TEST(ConvexHull, HoldsAllPointsOrSaysByHowMuchNot) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<Vec3> few = Ball(seed, 5 + static_cast<int>(seed));
    const ConvexHull all = HullOf(few, 64);
    EXPECT_EQ(all.corners.size(), few.size());
    EXPECT_LE(all.left_out_m, 1e-6);
    ExpectHullOf(few, all, 1e-6);
    const std::vector<Vec3> many = Ball(seed, 400);
    const ConvexHull some = HullOf(many, 64);
    EXPECT_EQ(some.corners.size(), 64u);
    EXPECT_GT(some.left_out_m, 0.01);
    EXPECT_LT(some.left_out_m, 0.15);  // a regular one with as many faces: 0.04
    ExpectHullOf(many, some, some.left_out_m + 1e-6);
  }
}

TEST(ConvexHull, AThinDiscEndsAndSaysWhatItLeavesOut) {
  // As thin as the tolerance: added corners are dropped again, which must not loop.
  for (const double thickness : {3e-7, 7e-7, 1e-6, 2e-6}) {
    std::vector<Vec3> disc;
    for (int i = 0; i < 32; ++i) {
      const double angle = 2 * M_PI * i / 32;
      for (const double z : {0.0, thickness}) disc.push_back({std::cos(angle), std::sin(angle), z});
    }
    const ConvexHull hull = HullOf(disc, 64);
    if (hull.corners.empty()) continue;  // flat
    EXPECT_TRUE(hull.too_thin || hull.left_out_m <= 1e-6) << thickness;
  }
}

TEST(ConvexHull, ThereIsNoneOfWhatIsFlat) {
  EXPECT_TRUE(HullOf({}, 64).corners.empty());
  EXPECT_TRUE(HullOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 64).corners.empty());
  EXPECT_TRUE(HullOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 3, 0}}, 64).corners.empty());
  EXPECT_TRUE(HullOf({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, 64).corners.empty());
  EXPECT_TRUE(HullOf({{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}, {1, 1, 1}}, 64).corners.empty());
}

void ExpectNear(const MassProperties& a, const MassProperties& b, double share) {
  EXPECT_NEAR(a.mass_kg, b.mass_kg, share * b.mass_kg);
  EXPECT_LE(Length(a.com_m - b.com_m), share);
  const Inertia &i = a.inertia_kg_m2, &j = b.inertia_kg_m2;
  const double size = share * (j.xx + j.yy + j.zz);
  EXPECT_NEAR(i.xx, j.xx, size);
  EXPECT_NEAR(i.yy, j.yy, size);
  EXPECT_NEAR(i.zz, j.zz, size);
  EXPECT_NEAR(i.xy, j.xy, size);
  EXPECT_NEAR(i.xz, j.xz, size);
  EXPECT_NEAR(i.yz, j.yz, size);
}

TEST(SolidMesh, OfABoxWeighsAsTheBoxDoesAnywhere) {
  const Vec3 half{0.3, 0.2, 0.05};
  const Quat q = Unit({0.7, 0.3, -0.5, 0.2});
  for (const Vec3& center : {Vec3{0.1, 0.2, 0.3}, Vec3{100, -50, 20}}) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back(center + Rotate(q, {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
                                            i & 4 ? half.z : -half.z}));
    }
    const ConvexHull hull = HullOf(corners, 64);
    const double volume = 8 * half.x * half.y * half.z;
    ExpectNear(SolidMesh(hull.corners, TrianglesOf(hull), 700),
               SolidBox(center, q, half, 700 * volume), 1e-11);
  }
}

TEST(SolidMesh, OfATetrahedronHasTheMomentsOfTheBooks) {
  // Corner of a cube: mass rho a^3 / 6, center of mass at a quarter of each edge; about the corner
  // Ixx = m a^2 / 5, and x y has the mean a^2 / 20.
  const double a = 0.4, m = 3;
  const std::vector<Vec3> corners{{0, 0, 0}, {a, 0, 0}, {0, a, 0}, {0, 0, a}};
  const MassProperties mass =
      SolidMesh(corners, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, 6 * m / (a * a * a));
  EXPECT_NEAR(mass.mass_kg, m, 1e-14);
  EXPECT_LE(Length(mass.com_m - Vec3{a / 4, a / 4, a / 4}), 1e-15);
  EXPECT_NEAR(mass.inertia_kg_m2.xx, m * a * a / 5 - m * 2 * a * a / 16, 1e-14);
  EXPECT_NEAR(mass.inertia_kg_m2.xy, -m * a * a / 20 + m * a * a / 16, 1e-14);
}

TEST(SolidMesh, WithAHollowIsTheDifference) {
  const auto box = [](double half, std::vector<Vec3>& corners, Triangles& triangles, bool inner) {
    std::vector<Vec3> own;
    for (int i = 0; i < 8; ++i) {
      own.push_back({i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half});
    }
    const ConvexHull hull = HullOf(own, 64);
    const int first = static_cast<int>(corners.size());
    for (auto t : TrianglesOf(hull)) {
      if (inner) std::swap(t[0], t[1]);
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    corners.insert(corners.end(), hull.corners.begin(), hull.corners.end());
  };
  std::vector<Vec3> corners;
  Triangles triangles;
  box(0.5, corners, triangles, false);
  box(0.25, corners, triangles, true);
  EXPECT_TRUE(FindFaults(corners, triangles, true, 1).empty());
  const MassProperties mass = SolidMesh(corners, triangles, 8);
  EXPECT_NEAR(mass.mass_kg, 7, 1e-13);
  EXPECT_NEAR(mass.inertia_kg_m2.xx, 8.0 / 6 - 0.25 / 6, 1e-13);
}

}  // namespace
}  // namespace taut::math
