// Contacts of boxes with ground, against known cases and against all pairs of features
// (docs/theory/ground.md, section 3)
#include <gtest/gtest.h>

#include "unit/sim/surface_helpers.h"

namespace taut::sim {
namespace {

/// Returns one of a box's 8 corners.
Vec3 CornerOf(const BoxShape& box, int corner) {
  Vec3 p = AsVec(box.center);
  for (int axis = 0; axis < 3; ++axis) {
    p = p +
        ((corner >> axis & 1) != 0 ? 1.0 : -1.0) * box.half_m[axis] * AsVec(box.axes + 3 * axis);
  }
  return p;
}
template <class Use>
void EachEdge(const BoxShape& box, const Use& use) {
  for (int from = 0; from < 8; ++from) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((from >> axis & 1) == 0) use(CornerOf(box, from), CornerOf(box, from | 1 << axis));
    }
  }
}

/// The least of |a + s u - b - t v|^2 over the unit square: in its interior, or on its sides.
double SegmentDistance(const Vec3& a, const Vec3& a_end, const Vec3& b, const Vec3& b_end) {
  const Vec3 u = a_end - a, v = b_end - b, w = a - b;
  const double uu = Dot(u, u), vv = Dot(v, v), uv = Dot(u, v), det = uu * vv - uv * uv;
  double least = kInf;
  const auto take = [&](double s, double t) {
    if (s < 0 || s > 1 || t < 0 || t > 1) return;
    least = std::min(least, Length(w + s * u - t * v));
  };
  if (det > 1e-14 * uu * vv) {
    const double s = (uv * Dot(v, w) - vv * Dot(u, w)) / det;
    take(s, (Dot(v, w) + s * uv) / vv);
  }
  for (const double end : {0.0, 1.0}) {
    take(end, std::clamp(Dot(w + end * u, v) / vv, 0.0, 1.0));
    take(std::clamp(Dot(end * v - w, u) / uu, 0.0, 1.0), end);
  }
  return least;
}

bool Pierces(const Vec3& from, const Vec3& to, const SurfaceTriangle& t) {
  const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  const double a = Dot(n, from - t.p[0]), b = Dot(n, to - t.p[0]);
  if ((a > 0) == (b > 0)) return false;
  const Vec3 x = from + (a / (a - b)) * (to - from);
  for (int k = 0; k < 3; ++k) {
    if (Dot(Cross(t.p[(k + 1) % 3] - t.p[k], x - t.p[k]), n) < 0) return false;
  }
  return true;
}

double DistanceToBox(const BoxShape& box, const Vec3& p) {
  Vec3 away;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 u = AsVec(box.axes + 3 * axis);
    const double at = Dot(p - AsVec(box.center), u);
    away = away + (at - std::clamp(at, -box.half_m[axis], box.half_m[axis])) * u;
  }
  return Length(away);
}

/// Returns whether p is inside, by counting crossings of a ray upward in a general direction.
bool IsIn(const Known& ground, const Vec3& p) {
  if (!ground.table().solid) return false;
  int crossings = 0;
  for (const SurfaceTriangle& t : ground.triangles) {
    if (Pierces(p, p + Vec3{0.0031, 0.0047, 5.3}, t)) ++crossings;
  }
  return crossings % 2 == 1;
}

/// Returns the distance by all pairs of corners, edges and faces; below 0 if they overlap.
double DistanceOfAll(const Known& ground, const BoxShape& box) {
  double least = kInf;
  bool meet = false;
  for (int c = 0; c < 8; ++c) {
    const Vec3 p = CornerOf(box, c);
    least = std::min(least, Length(p - ground.NearestTo(p)));
  }
  for (const SurfaceTriangle& t : ground.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 &p = t.p[k], &q = t.p[(k + 1) % 3];
      least = std::min(least, DistanceToBox(box, p));
      EachEdge(box, [&](const Vec3& from, const Vec3& to) {
        least = std::min(least, SegmentDistance(from, to, p, q));
      });
      for (int i = 0; i <= 20; ++i) {
        meet = meet || DistanceToBox(box, p + (i / 20.0) * (q - p)) == 0.0;
      }
    }
    EachEdge(box, [&](const Vec3& from, const Vec3& to) { meet = meet || Pierces(from, to, t); });
  }
  return meet ? -1.0 : least;
}

Points TouchesOf(const BoxShape& box, const SurfaceTable& table, double margin_m) {
  Points points(kMaxPointsPerPair);
  const int count = Touch(box, SurfaceShape{&table}, margin_m, points.data());
  points.resize(static_cast<std::size_t>(count));
  return points;
}

/// Lowers boxes of all shapes, from above and next to a surface, until they are near to it.
template <class Def>
void ExpectLeastGaps(const Def& def, unsigned seed, int boxes) {
  const Known ground(def);
  Points3 random(seed);
  const Vec3 low = ground.table().low, high = ground.table().high;
  const auto above = [&](Points3& r) {
    return Vec3{r.Between(low.x, high.x), r.Between(low.y, high.y), high.z + r.Between(-0.1, 0.2)};
  };
  int near = 0, through = 0;
  for (int i = 0; i < boxes; ++i) {
    BoxShape box =
        Box({random.Between(0.01, 0.1), random.Between(0.01, 0.1), random.Between(0.01, 0.1)},
            Turn(random.Within(1, -1, 1), random.Between(0, 3), above(random)));
    double distance = DistanceOfAll(ground, box);
    if (distance < 0 || IsIn(ground, AsVec(box.center))) continue;
    const double end_m = std::pow(10.0, random.Between(-7, -2.5));
    for (int k = 0; k < 30 && distance > end_m; ++k) {
      box.center[2] -= distance - 0.5 * end_m;
      distance = DistanceOfAll(ground, box);
    }
    if (distance > end_m) continue;
    const double margin_m = distance * random.Between(1.01, 2);
    const Points points = TouchesOf(box, ground.table(), margin_m);
    double least = kInf;
    for (const TouchPoint& p : points) {
      least = std::min(least, p.gap_m);
      EXPECT_NEAR(Length(AsVec(p.normal)), 1, 1e-12);
      EXPECT_GE(p.feature, 0);
      EXPECT_LT(p.feature, kMaxPointsPerPair);
      EXPECT_LT(DistanceToBox(box, AsVec(p.point)), 1e-12);
    }
    EXPECT_NEAR(least, distance, 1e-9) << "seed " << seed << " box " << i;
    EXPECT_TRUE(TouchesOf(box, ground.table(), 0.99 * distance).empty()) << seed << " " << i;
    const double clear =
        DistanceUpTo(box, SurfaceShape{&ground.table()}, random.Between(0.5, 2) * distance);
    EXPECT_LE(clear, distance) << seed << " " << i;
    EXPECT_EQ(DistanceUpTo(box, SurfaceShape{&ground.table()}, 0.0), 0.0);
    ++near;
    // After a further move by the same distance, the box slightly penetrates. The direction out is
    // the same, unless the nearest feature was a corner next to an edge.
    const TouchPoint& last = *std::min_element(
        points.begin(), points.end(),
        [](const TouchPoint& a, const TouchPoint& b) { return a.gap_m < b.gap_m; });
    const Vec3 n = AsVec(last.normal);
    const double depth_m = 1e-6;
    for (int k = 0; k < 3; ++k) box.center[k] -= (distance + depth_m) * last.normal[k];
    double deepest = 0, same = 0;
    for (const TouchPoint& p : TouchesOf(box, ground.table(), 1e-5)) {
      deepest = std::min(deepest, p.gap_m);
      if (Dot(AsVec(p.normal), n) > 1 - 1e-9) same = std::min(same, p.gap_m);
    }
    EXPECT_GE(deepest, -1.5 * depth_m) << "seed " << seed << " box " << i;
    if (same < 0) {
      EXPECT_NEAR(same, -depth_m, 1e-12) << "seed " << seed << " box " << i;
      ++through;
    }
  }
  EXPECT_GT(through, near / 2);
  EXPECT_GT(near, boxes / 4);
}

TEST(BoxOnSurface, TheLeastGapIsTheDistance) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const HeightFieldDef field = RoughField(seed);
    ExpectLeastGaps(field, seed, 40);
    ExpectLeastGaps(scenes::MeshOf(field, seed), 100 + seed, 40);
    ExpectLeastGaps(CubeMesh(), 200 + seed, 40);
  }
}

/// Returns the contact points of a box 0.2 x 0.2 x 0.1 whose bottom is at z = 0.
Points Touches(const TerrainMeshDef& mesh, double turn_rad = 0) {
  const Surface surface(mesh);
  return TouchesOf(Box({0.1, 0.1, 0.05}, Turn({0, 0, 1}, turn_rad, {0, 0, 0.05})), surface.table(),
                   1e-3);
}

TerrainMeshDef Roof(double height_m) {  // its ridge along y
  TerrainMeshDef mesh;
  mesh.solid = false;
  mesh.corners_m = {{-1, -1, height_m - 1}, {0, -1, height_m}, {1, -1, height_m - 1},
                    {-1, 1, height_m - 1},  {0, 1, height_m},  {1, 1, height_m - 1}};
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  return mesh;
}

TEST(BoxOnSurface, ARidgeTouchesTheTwoEdgesThatItCrosses) {
  for (const double height_m : {-5e-4, 0.0, 5e-4}) {
    for (const double turn : {0.0, 0.3}) {
      const Points points = Touches(Roof(height_m), turn);
      ASSERT_EQ(points.size(), 2u) << height_m << " " << turn;
      double sum = 0;
      for (const TouchPoint& p : points) {
        EXPECT_NEAR(p.gap_m, -height_m, 1e-12);
        EXPECT_NEAR(p.normal[2], 1, 1e-12);
        EXPECT_NEAR(p.point[0], 0, 1e-9);
        EXPECT_NEAR(std::abs(p.point[1]), 0.1 / std::cos(turn), 1e-12);
        sum += p.point[1];
      }
      EXPECT_NEAR(sum, 0, 1e-12);
      EXPECT_NE(points[0].feature, points[1].feature);
    }
  }
}

TEST(BoxOnSurface, APeakTouchesTheFaceAboveIt) {
  TerrainMeshDef mesh;
  mesh.solid = false;
  mesh.corners_m = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {0.02, -0.03, 3e-4}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const Points points = Touches(mesh);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].gap_m, -3e-4, 1e-15);
  EXPECT_NEAR(points[0].point[0], 0.02, 1e-15);
  EXPECT_NEAR(points[0].point[1], -0.03, 1e-15);
  EXPECT_NEAR(points[0].point[2], 0, 1e-15);
  EXPECT_EQ(points[0].normal[2], 1);
}

TEST(BoxOnSurface, OfAPeakItsFlankDoesNotTouch) {
  // A corner on the flank, level with the face; the peak is 3 mm inside it.
  TerrainMeshDef mesh;
  mesh.solid = false;
  mesh.corners_m = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {0, 0, 3e-3}, {0.03, 0, 0}};
  mesh.triangles = {{0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 4, 5}, {2, 3, 4}, {3, 0, 4}};
  const Points points = Touches(mesh);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].gap_m, -3e-3, 1e-15);
}

TEST(BoxOnSurface, ACornerInAGrooveHasBothItsSides) {
  // A cube on its corner, in a groove along y, just free of its sides or just penetrating them.
  TerrainMeshDef groove;
  groove.corners_m = {{-1, -1, 0.5}, {0, -1, 0}, {1, -1, 0.5}, {0, -1, -1},
                      {-1, 1, 0.5},  {0, 1, 0},  {1, 1, 0.5},  {0, 1, -1}};
  groove.triangles = {{0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {3, 0, 4}, {3, 4, 7},
                      {2, 3, 7}, {2, 7, 6}, {0, 3, 1}, {1, 3, 2}, {4, 5, 7}, {5, 6, 7}};
  const Surface surface(groove);
  const double half = 0.1, a = std::sqrt(0.5), b = std::sqrt(1.0 / 6), c = std::sqrt(1.0 / 3);
  for (const double height_m : {-1e-6, 1e-6}) {
    BoxShape cube{
        {0, 0, half / c + height_m}, {a, b, c, -a, b, c, 0, -2 * b, c}, {half, half, half}};
    TouchPoint points[kMaxPointsPerPair];
    const int count = Touch(cube, SurfaceShape{&surface.table()}, 1e-4, points);
    int sides[2] = {0, 0};
    for (int i = 0; i < count; ++i) {
      if (std::abs(points[i].point[2] - height_m) > 1e-12) continue;
      EXPECT_NEAR(points[i].normal[2], 2 / std::sqrt(5), 1e-12);
      EXPECT_NEAR(points[i].gap_m, height_m * 2 / std::sqrt(5), 1e-12);
      ++sides[points[i].normal[0] > 0];
    }
    EXPECT_EQ(sides[0], 1) << height_m;
    EXPECT_EQ(sides[1], 1) << height_m;
  }
}

TEST(BoxOnSurface, OnAPlateauOnlyItsCornersCount) {
  // 3 x 3 corners at z = 0 under the box, surrounded by lower ground: four of them carry it.
  HeightFieldDef field = scenes::Field(9, 9, 0.05, {}, [](double x, double y) {
    return std::max(std::abs(x), std::abs(y)) < 0.06 ? 0.0 : -0.1;
  });
  const Points points = Touches(scenes::MeshOf(field, 3));
  ASSERT_EQ(points.size(), 4u);
  for (const TouchPoint& p : points) {
    EXPECT_NEAR(std::abs(p.point[0]), 0.05, 1e-12);
    EXPECT_NEAR(std::abs(p.point[1]), 0.05, 1e-12);
    EXPECT_NEAR(p.gap_m, 0, 1e-12);
  }
}

TerrainMeshDef Square(double size_m) {  // horizontal, at x < 0
  TerrainMeshDef mesh;
  mesh.solid = false;
  mesh.corners_m = {{-size_m, -size_m, 0}, {0, -size_m, 0}, {0, size_m, 0}, {-size_m, size_m, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(BoxOnSurface, ASheetHoldsABoxOnTheSideWhereItIs) {
  const Surface sheet(Square(1));
  for (const double side : {-1.0, 1.0}) {
    for (const double gap_m : {-1e-4, -1e-12, 0.0, 1e-12, 1e-4}) {
      const Points points = TouchesOf(
          Box({0.1, 0.1, 0.05}, Shift({-0.4, 0.03, side * (0.05 + gap_m)})), sheet.table(), 1e-3);
      ASSERT_EQ(points.size(), 4u) << side << " " << gap_m;
      for (const TouchPoint& p : points) {
        EXPECT_NEAR(p.gap_m, gap_m, 1e-15);
        EXPECT_NEAR(p.normal[2], side, 1e-15);
      }
    }
  }
}

TEST(BoxOnSurface, CornersPastTheBorderOfASheetAreFree) {
  // The box's bottom is 0.1 mm above the border of the sheet, and lower than the sheet beyond the
  // border.
  const Surface sheet(Square(1));
  for (const double angle : {0.02, 0.1, 0.4}) {
    const Motion turned = Turn({0, 1, 0}, angle);
    for (const double beyond_m : {0.001, 0.02, 0.09}) {
      BoxShape box = Box({0.1, 0.1, 0.05}, turned);
      const Vec3 foot = turned({0.1 - beyond_m, 0, -0.05});
      const Vec3 at = Vec3{} - foot + 1e-4 * turned({0, 0, 1});
      box.center[0] = at.x, box.center[1] = at.y, box.center[2] = at.z;
      const Points points = TouchesOf(box, sheet.table(), 1e-3);
      EXPECT_FALSE(points.empty());
      for (const TouchPoint& p : points) {
        EXPECT_GT(p.gap_m, 0.99e-4) << angle << " " << beyond_m;
      }
    }
  }
}

TEST(BoxOnSurface, WhatHangsOverASteepSlopeIsNotThroughIt) {
  // A long horizontal box on a ridge: its end is slightly above the plane of a side, while its
  // center is below that plane.
  for (const double end_m : {0.001, 0.01, 0.05}) {
    const Points points = [&] {
      const Surface roof(Roof(0));
      return TouchesOf(Box({0.2, 0.02, 0.01}, Shift({end_m - 0.2 + 0.02, 0, 0.01})), roof.table(),
                       1e-4);
    }();
    ASSERT_FALSE(points.empty());
    for (const TouchPoint& p : points) EXPECT_NEAR(p.gap_m, 0, 1e-12) << end_m;
  }
}

TEST(BoxOnSurface, WhatLeansOverARidgeIsNotHeldByItsFarSide) {
  // A ridge, 60 degrees steep on the right, with a floor next to it; a box leans over it, its
  // lowest edge 4 mm above the start of the floor. Its center is below the plane of the ridge's
  // right side.
  TerrainMeshDef mesh;
  mesh.solid = false;
  for (const double y : {-1.0, 1.0}) {
    for (const auto& [x, z] : {std::pair{-0.2, -0.1}, {0.0, 0.017}, {0.01, 0.0}, {1.0, 0.0}}) {
      mesh.corners_m.push_back({x, y, z});
    }
  }
  for (int k = 0; k < 3; ++k) {
    mesh.triangles.push_back({k, k + 1, k + 5});
    mesh.triangles.push_back({k, k + 5, k + 4});
  }
  const Surface surface(mesh);
  const Motion turned = Turn({0, 1, 0}, std::atan2(0.0131, 0.01));
  const Vec3 foot = turned({0.1, 0, -0.01});
  const Points points = TouchesOf(Box({0.1, 0.02, 0.01}, {turned.q, Vec3{0.01, 0.3, 0.004} - foot}),
                                  surface.table(), 6e-3);
  EXPECT_FALSE(points.empty());
  for (const TouchPoint& p : points) EXPECT_GT(p.gap_m, 0) << p.feature;
}

}  // namespace
}  // namespace taut::sim
