// Contacts of convex hulls with rods, boxes and each other: against boxes, which have separate
// code, and against distances by alternating projection
#include <gtest/gtest.h>

#include "math/convex_hull.h"
#include "sim/geometry/convex.h"
#include "sim/geometry/hull_build.h"
#include "unit/sim/shape_helpers.h"

namespace taut::sim {

/// Returns the nearest point by all triangles of three corners without a corner above them.
inline Vec3 NearestOn(const HullShape& shape, const Vec3& p) {
  const Convex c(shape);
  bool inside = true;
  Vec3 best;
  double least = 1e300;
  for (int face = 0; face < c.table->face_count; ++face) {
    if (c.Above(face, p) > 0) inside = false;
    const int first = c.table->first_in_face[face], last = c.table->first_in_face[face + 1];
    const Vec3 a = c.corners[c.table->in_face[first]];
    for (int i = first + 2; i < last; ++i) {
      const Vec3 u = c.corners[c.table->in_face[i - 1]] - a, v = c.corners[c.table->in_face[i]] - a;
      const auto take = [&](double s, double t) {
        if (!(s >= 0 && t >= 0 && s + t <= 1 + 1e-15)) return;
        const Vec3 q = a + s * u + t * v;
        if (Length(q - p) < least) least = Length(q - p), best = q;
      };
      const double uu = Dot(u, u), uv = Dot(u, v), vv = Dot(v, v);
      const double pu = Dot(p - a, u), pv = Dot(p - a, v), det = uu * vv - uv * uv;
      take((vv * pu - uv * pv) / det, (uu * pv - uv * pu) / det);
      take(std::clamp(pu / uu, 0.0, 1.0), 0);
      take(0, std::clamp(pv / vv, 0.0, 1.0));
      const Vec3 w = v - u;
      const double along = std::clamp(Dot(p - a - u, w) / Dot(w, w), 0.0, 1.0);
      take(1 - along, along);
    }
  }
  return inside ? p : best;
}
inline double RadiusOf(const HullShape&) { return 0; }

namespace {

constexpr double kHullTiny = 1e-12;

/// A hull with its table
struct OwnHull {
  explicit OwnHull(const std::vector<Vec3>& points) : hull(math::HullOf(points, kMaxHullCorners)) {}
  HullShape At(const Motion& at = {}) const {
    HullShape shape{&hull.table(), {}};
    const Vec3 columns[3] = {Rotate(at.q, {1, 0, 0}), Rotate(at.q, {0, 1, 0}),
                             Rotate(at.q, {0, 0, 1})};
    for (int k = 0; k < 3; ++k) {
      shape.at.r[k] = columns[k].x, shape.at.r[3 + k] = columns[k].y;
      shape.at.r[6 + k] = columns[k].z;
    }
    shape.at.origin[0] = at.p.x, shape.at.origin[1] = at.p.y, shape.at.origin[2] = at.p.z;
    return shape;
  }
  Hull hull;
};

std::vector<Vec3> CornersOf(const BoxShape& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    Vec3 p = AsVec(box.center);
    for (int k = 0; k < 3; ++k) {
      p = p + ((i >> k & 1) != 0 ? 1.0 : -1.0) * box.half_m[k] * AsVec(box.axes + 3 * k);
    }
    corners.push_back(p);
  }
  return corners;
}

std::vector<Vec3> Cloud(RandomShapes& random, int count) {
  std::vector<Vec3> points;
  const Vec3 size{random.In(0.05, 0.2), random.In(0.05, 0.2), random.In(0.05, 0.2)};
  for (int i = 0; i < count; ++i) {
    const Vec3 p = random.InCube(1);
    points.push_back((1.0 / Length(p)) * Vec3{size.x * p.x, size.y * p.y, size.z * p.z});
  }
  return points;
}

void ExpectSamePoints(const Points& found, const Points& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (const TouchPoint& want : expected) {
    double best = 1e300;
    for (const TouchPoint& p : found) {
      best = std::min(best, Length(AsVec(p.point) - AsVec(want.point)) +
                                Length(AsVec(p.normal) - AsVec(want.normal)) +
                                std::fabs(p.gap_m - want.gap_m));
    }
    EXPECT_LT(best, tolerance);
  }
}

void ExpectHullFeaturesDiffer(const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GE(points[i].feature, 0);
    EXPECT_LT(points[i].feature, kMaxPointsPerPair);
    if (i > 0) {
      EXPECT_NE(points[i - 1].feature, points[i].feature);
    }
  }
}

TEST(TouchHull, TopologyOfABoxIsTheSameEitherWay) {
  const BoxShape box = Box({0.3, 0.2, 0.1}, Turn({1, 2, 3}, 0.7, {0.1, 0.2, 0.3}));
  const Convex c(box);
  EXPECT_EQ(c.table->corner_count - c.table->edge_count + c.table->face_count, 2);
  for (int face = 0; face < 6; ++face) {
    int sides = 0;
    c.EachSide(face, [&](const Vec3& from, const Vec3& to) {
      ++sides;
      EXPECT_NEAR(c.Above(face, from), 0, kHullTiny);
      EXPECT_GT(Dot(Cross(to - from, c.center - from), c.normals[face]), 0);  // counter-clockwise
    });
    EXPECT_EQ(sides, 4);
  }
  for (int i = 0; i < c.table->edge_count; ++i) {
    const HullEdge& edge = c.table->edges[i];
    for (const int face : {edge.left, edge.right}) {
      EXPECT_NEAR(c.Above(face, c.corners[edge.from]), 0, kHullTiny);
      EXPECT_NEAR(c.Above(face, c.corners[edge.to]), 0, kHullTiny);
    }
    EXPECT_GT(Dot(Cross(c.normals[edge.left], c.normals[edge.right]), c.AlongOf(edge)), 0);
  }
}

TEST(TouchHull, OfAPointInsideTheNearestPlaceIsOnAFace) {
  const Convex c(Box({0.3, 0.2, 0.1}));
  const NearestOfConvex nearest = NearestTo(c, {0.1, 0.05, 0.08});
  EXPECT_NEAR(nearest.distance_m, -0.02, kHullTiny);
  EXPECT_LT(Length(nearest.at - Vec3{0.1, 0.05, 0.1}), kHullTiny);
  EXPECT_LT(Length(nearest.normal - Vec3{0, 0, 1}), kHullTiny);
}

TEST(TouchHull, RodsTouchTheHullOfABoxAsTheBox) {
  RandomShapes random(1);
  int touching = 0;
  for (int i = 0; i < 1500; ++i) {
    const BoxShape box = random.AnyBox(0.1);
    const OwnHull hull(CornersOf(box));
    const RoundShape round = random.Round(0.35);
    EXPECT_NEAR(Distance(round, hull.At()), Distance(round, box), 1e-10) << i;
    const double depth = Deepest(Touch(round, box, 1.0)).gap_m;
    if (depth < -0.9 * round.radius_m) continue;  // so deep inside, a hull has fewer directions out
    const Points points = Touch(round, hull.At(), 1e-2), expected = Touch(round, box, 1e-2);
    ExpectHullFeaturesDiffer(points);
    if (expected.empty()) {
      EXPECT_TRUE(points.empty()) << i;
      continue;
    }
    ++touching;
    // Boxes have contact points at the planes of all faces, hulls only where a face begins. The
    // points that carry load are the same.
    EXPECT_NEAR(Deepest(points).gap_m, Deepest(expected).gap_m, 1e-10) << i;
    for (const TouchPoint& p : points) {
      if (p.gap_m < 0.9e-2) {
        EXPECT_LT(Uncovered(p, expected, 0.01), 1e-4) << i;
      }
    }
  }
  EXPECT_GT(touching, 150);
}

TEST(TouchHull, ARodOnAFaceIsHeldAtTheEndsOfWhatLiesOnIt) {
  const OwnHull hull(CornersOf(Box({0.2, 0.1, 0.05})));
  const Points points = Touch(Rod({-0.3, 0.02, 0.0599}, {0.1, 0.02, 0.0599}, 0.01), hull.At());
  ASSERT_EQ(points.size(), 2u);
  EXPECT_NEAR(std::min(points[0].point[0], points[1].point[0]), -0.2, kHullTiny);
  EXPECT_NEAR(std::max(points[0].point[0], points[1].point[0]), 0.1, kHullTiny);
  for (const TouchPoint& p : points) {
    EXPECT_NEAR(p.gap_m, -1e-4, kHullTiny);
    EXPECT_LT(Length(AsVec(p.normal) - Vec3{0, 0, 1}), kHullTiny);
  }
}

TEST(TouchHull, ARodWhoseMiddleIsInsideLeavesThroughTheNearestFace) {
  const OwnHull hull(CornersOf(Box({0.2, 0.1, 0.05})));
  const Points points = Touch(Rod({-0.3, 0.02, 0.04}, {0.3, 0.02, 0.04}, 0.01), hull.At());
  ASSERT_EQ(points.size(), 2u);
  for (const TouchPoint& p : points) {
    EXPECT_NEAR(p.gap_m, -0.02, kHullTiny);
    EXPECT_LT(Length(AsVec(p.normal) - Vec3{0, 0, 1}), kHullTiny);
    EXPECT_NEAR(std::fabs(p.point[0]), 0.2, kHullTiny);
  }
}

TEST(TouchHull, TwoHullsOfBoxesTouchAsTheBoxes) {
  RandomShapes random(2);
  int touching = 0;
  for (int i = 0; i < 1500; ++i) {
    const BoxShape a = random.AnyBox(0.2), b = random.AnyBox(0.2);
    const OwnHull hull_a(CornersOf(a)), hull_b(CornersOf(b));
    const Points expected = Touch(a, b, 1e-2), points = Touch(hull_a.At(), hull_b.At(), 1e-2);
    ExpectHullFeaturesDiffer(points);
    if (expected.empty()) {
      EXPECT_TRUE(points.empty()) << i;
      continue;
    }
    // If deeper than half its thickness, a box may leave on the other side, hulls by other faces.
    const double thin =
        std::min({a.half_m[0], a.half_m[1], a.half_m[2], b.half_m[0], b.half_m[1], b.half_m[2]});
    if (Deepest(expected).gap_m < -thin) continue;
    ++touching;
    ExpectSamePoints(points, expected, 2e-5);
    ExpectSamePoints(Touch(a, hull_b.At(), 1e-2), expected, 2e-5);
  }
  EXPECT_GT(touching, 150);
}

TEST(TouchHull, TheLeastGapIsTheDistance) {
  RandomShapes random(3);
  int apart = 0;
  for (int i = 0; i < 600; ++i) {
    const OwnHull one(Cloud(random, 4 + i % 20)), two(Cloud(random, 4 + i % 17));
    const HullShape a = one.At(random.Anywhere(0.25)), b = two.At(random.Anywhere(0.25));
    const double distance = WalkedDistance(a, b);
    const double bound = DistanceUpTo(a, b, 1e300);
    EXPECT_LE(bound, distance + 1e-9) << i;
    if (distance < 1e-4) continue;
    ++apart;
    const Points points = Touch(a, b, 1.0);
    ASSERT_FALSE(points.empty());
    EXPECT_NEAR(Deepest(points).gap_m, distance, 1e-4 * 0.2 + 1e-3 * distance) << i;
    EXPECT_NEAR(bound, distance, 1e-3 * distance) << i;
    EXPECT_TRUE(Touch(a, b, 0.99 * distance - 1e-4).empty()) << i;
    const RoundShape round = random.Round(0.4);
    const double from_round = WalkedDistance(round, a);
    EXPECT_NEAR(Distance(round, a), from_round, 1e-6 + 1e-3 * from_round) << i;
  }
  EXPECT_GT(apart, 200);
}

TEST(TouchHull, PointsAreBetweenTheSurfaces) {
  RandomShapes random(4);
  int seen = 0;
  for (int i = 0; i < 1500; ++i) {
    const OwnHull one(Cloud(random, 8 + i % 30)), two(Cloud(random, 8 + i % 23));
    const HullShape a = one.At(random.Anywhere(0.2)), b = two.At(random.Anywhere(0.2));
    for (const TouchPoint& p : Touch(a, b, 0.01)) {
      if (p.gap_m < -0.01) continue;
      ++seen;
      const Vec3 half = (0.5 * p.gap_m) * AsVec(p.normal);
      // Half a gap along the normal is the surface of one shape, half a gap back the surface of the
      // other.
      EXPECT_NEAR(NearestTo(Convex(a), AsVec(p.point) + half).distance_m, 0, 1e-5) << i;
      EXPECT_NEAR(NearestTo(Convex(b), AsVec(p.point) - half).distance_m, 0, 1e-5) << i;
    }
  }
  EXPECT_GT(seen, 200);
}

TEST(TouchHull, OfAFaceOfManyCornersTheOutermostAreKept) {
  std::vector<Vec3> prism;
  for (int i = 0; i < 32; ++i) {
    const double angle = i * 3.14159265358979323846 / 16;
    prism.push_back({0.1 * std::cos(angle), 0.1 * std::sin(angle), 0});
    prism.push_back({0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.05});
  }
  const OwnHull hull(prism);
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  const Points level = Touch(floor, hull.At(Shift({0, 0, -1e-5})));
  EXPECT_GE(level.size(), 8u);
  ExpectHullFeaturesDiffer(level);
  Vec3 sum;
  for (const TouchPoint& p : level) {
    EXPECT_NEAR(p.gap_m, -1e-5, 1e-9);
    EXPECT_NEAR(p.normal[2], -1, kHullTiny);
    sum = sum + AsVec(p.point);
  }
  EXPECT_LT(std::hypot(sum.x, sum.y), 0.1);  // all around
  const Points tilted = Touch(floor, hull.At(Turn({0.3, 1, 0}, 1e-4)), 1e-3);
  EXPECT_NEAR(Deepest(tilted).gap_m, -1e-5, 1e-7);
  // At a larger tilt all near corners are present: of 32 corners the 11 up to 60 degrees from the
  // lowest.
  const Points steep = Touch(floor, hull.At(Turn({0, 1, 0}, 0.02, {0, 0, 3e-3})), 1e-2);
  EXPECT_EQ(steep.size(), static_cast<std::size_t>(kMaxPointsPerPair));
  const double lowest = Deepest(steep).gap_m;
  EXPECT_EQ(std::count_if(steep.begin(), steep.end(),
                          [&](const TouchPoint& p) { return p.gap_m < lowest + 1.05e-3; }),
            11);
}

TEST(TouchHull, PointsOfARodThatTiltsOverAnEdgeStayContinuous) {
  const OwnHull step(CornersOf(Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0}))));
  const RoundShape rod = Rod({-0.2, 0, 0}, {0.3, 0, 0}, 0.02);
  Points before;
  for (double angle = -1e-9; angle < 0.5; angle += std::clamp(0.05 * angle, 1e-10, 1e-5)) {
    const Vec3 lift{0.01995 * std::sin(angle), 0, 0.1 + 0.01995 * std::cos(angle)};
    const Points now = Touch(Moved(rod, Turn({0, 1, 0}, angle, lift)), step.At());
    ASSERT_FALSE(now.empty());
    if (!before.empty()) {
      ASSERT_LT(WorstChange(before, now, 0.02), 2e-5) << angle;
    }
    before = now;
  }
}

TEST(TouchHull, PointsOfARodThatRollsOverAHullStayContinuous) {
  RandomShapes random(5);
  for (int i = 0; i < 6; ++i) {
    const OwnHull one(Cloud(random, 12));
    const Vec3 axis = random.InCube(1), aside = random.InCube(0.03);
    RoundShape rod = Rod({-0.2, 0, 0}, {0.2, 0, 0}, 0.01);
    Points before;
    for (int k = 0; k < 12000; ++k) {
      const HullShape hull = one.At(Turn(axis, 2e-5 * k, aside));
      // Lowered onto it, and slightly into it.
      double height = 1.0;
      for (int n = 0; n < 60; ++n) {
        const RoundShape at = Moved(rod, Shift({0, 0, height}));
        const double gap = Distance(at, hull);
        if (gap < 1e-12) break;
        height -= gap;
      }
      const Points now = Touch(Moved(rod, Shift({0, 0, height - 3e-5})), hull);
      ASSERT_FALSE(now.empty());
      if (!before.empty()) {
        ASSERT_LT(WorstChange(before, now, 0.01), 1e-4) << i << " " << k;
      }
      before = now;
    }
  }
}

}  // namespace
}  // namespace taut::sim
