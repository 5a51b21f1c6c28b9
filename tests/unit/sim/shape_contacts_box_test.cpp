// Contacts between boxes
#include <numbers>

#include <gtest/gtest.h>

#include "unit/sim/shape_helpers.h"

namespace taut::sim {
namespace {

constexpr double kBoxTiny = 1e-12;
/// Distance by which an edge must be nearer than a face to be preferred, for random boxes
constexpr double kPreferenceM = 1e-4 * 0.2;

/// Expects exactly one point at each of `places`.
void ExpectPlaces(const Points& points, const std::vector<Vec3>& places, double tolerance_m) {
  EXPECT_EQ(points.size(), places.size());
  for (const Vec3& place : places) {
    const auto there = [&](const TouchPoint& p) {
      return Length(AsVec(p.point) - place) < tolerance_m;
    };
    EXPECT_EQ(std::count_if(points.begin(), points.end(), there), 1)
        << place.x << " " << place.y << " " << place.z;
  }
}

void ExpectAll(const Points& points, const Vec3& normal, double gap_m) {
  for (const TouchPoint& p : points) {
    EXPECT_LT(Length(AsVec(p.normal) - normal), kBoxTiny);
    EXPECT_NEAR(p.gap_m, gap_m, kBoxTiny);
  }
}

void ExpectFeaturesDiffer(const Points& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_NE(points[i - 1].feature, points[i].feature);
  }
}

TEST(TouchBoxBox, BoxOnAFloorRestsOnItsFourCorners) {
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  const Points points = Touch(Cube(0.2, Shift({0.3, 0.1, 0.199})), floor);
  ExpectPlaces(
      points,
      {{0.1, -0.1, -0.0005}, {0.5, -0.1, -0.0005}, {0.5, 0.3, -0.0005}, {0.1, 0.3, -0.0005}},
      kBoxTiny);
  ExpectAll(points, {0, 0, 1}, -0.001);
  ExpectFeaturesDiffer(points);
}

TEST(TouchBoxBox, FloorUnderABoxIsTouchedInTheSamePlacesFromBelow) {
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  const Points points = Touch(floor, Cube(0.2, Shift({0.3, 0.1, 0.199})));
  ExpectPlaces(
      points,
      {{0.1, -0.1, -0.0005}, {0.5, -0.1, -0.0005}, {0.5, 0.3, -0.0005}, {0.1, 0.3, -0.0005}}, 1e-5);
  ExpectAll(points, {0, 0, -1}, -0.001);
}

TEST(TouchBoxBox, BoxAboveAFloorIsFoundWithinTheMargin) {
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  const BoxShape box = Cube(0.2, Shift({0, 0, 0.21}));
  EXPECT_EQ(Touch(box, floor, 0.0099).size(), 0u);
  const Points points = Touch(box, floor, 0.0101);
  EXPECT_EQ(points.size(), 4u);
  ExpectAll(points, {0, 0, 1}, 0.01);
}

TEST(TouchBoxBox, OverhangingBoxIsCarriedWhereItOverlaps) {
  const Points points = Touch(Cube(0.2, Shift({0.3, 0, 0.4})), Cube(0.2), 1e-3);
  ExpectPlaces(points, {{0.1, -0.2, 0.2}, {0.2, -0.2, 0.2}, {0.2, 0.2, 0.2}, {0.1, 0.2, 0.2}},
               kBoxTiny);
  ExpectAll(points, {0, 0, 1}, 0.0);
  ExpectFeaturesDiffer(points);
}

TEST(TouchBoxBox, BoxTurnedBy45DegreesTouchesInAnOctagon) {
  const Points points =
      Touch(Cube(0.1, Turn({0, 0, 1}, std::numbers::pi / 4, {0, 0, 0.199})), Cube(0.1));
  const double c = 0.1 * (std::sqrt(2.0) - 1.0), z = 0.0995;
  ExpectPlaces(points,
               {{0.1, c, z},
                {0.1, -c, z},
                {-0.1, c, z},
                {-0.1, -c, z},
                {c, 0.1, z},
                {c, -0.1, z},
                {-c, 0.1, z},
                {-c, -0.1, z}},
               1e-5);
  ExpectAll(points, {0, 0, 1}, -0.001);
  ExpectFeaturesDiffer(points);
}

TEST(TouchBoxBox, EqualBoxesOnEachOtherKeepTheirFeaturesInSpiteOfRounding) {
  RandomShapes random(11);
  const Points first = Touch(Cube(0.1, Shift({0, 0, 0.2})), Cube(0.1));
  ASSERT_EQ(first.size(), 4u);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 axis = random.InCube(1), shift = random.InCube(1e-9);
    const Motion shake = Turn(axis, 1e-9, shift);
    const Points points = Touch(Moved(Cube(0.1, Shift({0, 0, 0.2})), shake), Cube(0.1));
    ASSERT_EQ(points.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(points[k].feature, first[k].feature);
  }
}

TEST(TouchBoxBox, BoxOnItsEdgeTouchesInTwoPoints) {
  const double reach = 0.1 * std::sqrt(2.0);
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  const Points points = Touch(
      Box({0.1, 0.3, 0.1}, Turn({0, 1, 0}, std::numbers::pi / 4, {0, 0, reach - 0.001})), floor);
  ExpectPlaces(points, {{0, -0.3, -0.0005}, {0, 0.3, -0.0005}}, kBoxTiny);
  ExpectAll(points, {0, 0, 1}, -0.001);
}

TEST(TouchBoxBox, BoxOnItsCornerTouchesInOnePoint) {
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  // Rotation that stands a cube on its corner.
  const double reach = 0.1 * std::sqrt(3.0);
  const Motion stand = Turn({1, -1, 0}, std::acos(1.0 / std::sqrt(3.0)), {0, 0, reach + 0.001});
  const Points points = Touch(Cube(0.1, stand), floor, 0.01);
  ExpectPlaces(points, {{0, 0, 0.0005}}, kBoxTiny);
  ExpectAll(points, {0, 0, 1}, 0.001);
}

TEST(TouchBoxBox, CrossedEdgesTouchInOnePoint) {
  // Two roofs: an edge along x points up, an edge along y points down.
  const double reach = 0.1 * std::sqrt(2.0);
  const BoxShape low = Box({0.3, 0.1, 0.1}, Turn({1, 0, 0}, std::numbers::pi / 4));
  for (const double gap : {-0.002, 0.0, 0.003}) {
    const BoxShape high =
        Box({0.1, 0.3, 0.1}, Turn({0, 1, 0}, std::numbers::pi / 4, {0.05, 0.02, 2 * reach + gap}));
    const Points points = Touch(high, low, 0.01);
    ExpectPlaces(points, {{0.05, 0, reach + 0.5 * gap}}, kBoxTiny);
    ExpectAll(points, {0, 0, 1}, gap);
    EXPECT_EQ(points[0].feature, 12);
    const Points swapped = Touch(low, high, 0.01);
    ExpectPlaces(swapped, {{0.05, 0, reach + 0.5 * gap}}, kBoxTiny);
    ExpectAll(swapped, {0, 0, -1}, gap);
  }
}

TEST(TouchBoxBox, CornersDiagonallyOppositeEachOtherAreFoundWithinTheMargin) {
  const BoxShape high = Cube(0.1, Shift({0.202, 0.202, 0.201}));
  EXPECT_EQ(Touch(high, Cube(0.1), 0.0029).size(), 0u);
  const Points points = Touch(high, Cube(0.1), 0.0031), swapped = Touch(Cube(0.1), high, 0.0031);
  ExpectPlaces(points, {{0.101, 0.101, 0.1005}}, kBoxTiny);
  ExpectAll(points, {2.0 / 3, 2.0 / 3, 1.0 / 3}, 0.003);
  ExpectPlaces(swapped, {{0.101, 0.101, 0.1005}}, kBoxTiny);
  ExpectAll(swapped, {-2.0 / 3, -2.0 / 3, -1.0 / 3}, 0.003);
}

TEST(TouchBoxBox, BoxesNearerThanTheMarginHaveAPointAsNear) {
  RandomShapes random(16);
  int near = 0;
  for (int i = 0; i < 20000; ++i) {
    const BoxShape a = random.AnyBox(0.25), b = random.AnyBox(0.25);
    const double walked = WalkedDistance(a, b);
    if (walked > 0.03) continue;
    ++near;
    const Points points = Touch(a, b, 0.03 + kPreferenceM);
    ASSERT_FALSE(points.empty()) << i;
    EXPECT_LT(Deepest(points).gap_m, walked + kPreferenceM) << i;
  }
  EXPECT_GT(near, 5000);
}

TEST(TouchBoxBox, PointsOfASlidingAndTurningBoxStayContinuous) {
  const BoxShape low = Box({0.3, 0.2, 0.1}), high = Cube(0.15);
  Points before;
  for (double s = 0; s < 1; s += 1e-4) {
    const Motion motion = Turn({0, 0, 1}, 3 * s, {0.8 * s - 0.4, 0.1 * s, 0.24999});
    const Points now = Touch(Moved(high, motion), low);
    ASSERT_FALSE(now.empty());
    ExpectFeaturesDiffer(now);
    if (!before.empty()) {
      ASSERT_LT(WorstChange(before, now, 0.1), 1.5e-3) << s;
    }
    before = now;
  }
}

TEST(TouchBoxBox, PointsOfATippingBoxStayContinuous) {
  const BoxShape floor = Box({1, 1, 0.1}, Shift({0, 0, -0.1}));
  const double diagonal = std::sqrt(0.05);
  Points before;
  // About the edge at x = 0.2, from flat through the balance to flat on the next side.
  for (double angle = 0; angle < std::numbers::pi / 2; angle += 1e-5) {
    const double to_center =
        std::atan2(0.1, 0.2) + angle;  // elevation of the center as seen from the edge
    const Motion motion =
        Turn({0, 1, 0}, angle,
             {0.2 - diagonal * std::cos(to_center), 0, diagonal * std::sin(to_center) - 1e-5});
    const Points now = Touch(Box({0.2, 0.1, 0.1}, motion), floor);
    ASSERT_GE(now.size(), 2u) << angle;
    ASSERT_NEAR(Deepest(now).gap_m, -1e-5, 1e-10) << angle;
    if (!before.empty()) {
      ASSERT_LT(WorstChange(before, now, 0.1), 1e-5) << angle;
    }
    before = now;
  }
}

TEST(TouchBoxBox, OverlappingBoxesHavePointsThatLeadApart) {
  RandomShapes random(12);
  int overlapping = 0, edges = 0;
  for (int i = 0; i < 20000; ++i) {
    const BoxShape a = random.AnyBox(0.15), b = random.AnyBox(0.15);
    if (WalkedDistance(a, b) > 1e-6) continue;
    ++overlapping;
    const Points points = Touch(a, b);
    ASSERT_FALSE(points.empty()) << i;
    const TouchPoint deepest = Deepest(points);
    edges += deepest.feature == 12;
    EXPECT_LT(deepest.gap_m, 1e-6) << i;
    const Vec3 way = -deepest.gap_m * AsVec(deepest.normal);
    const Points left = Touch(Moved(a, Shift(way)), b);
    if (!left.empty()) {
      EXPECT_GT(Deepest(left).gap_m, -1e-5 * 0.2) << i;  // tolerance of a clipped face
    }
    for (const TouchPoint& p : points) {
      EXPECT_LT(Length(AsVec(p.normal) - AsVec(deepest.normal)), kBoxTiny);
      EXPECT_NEAR(Length(AsVec(p.normal)), 1.0, kBoxTiny);
    }
  }
  EXPECT_GT(overlapping, 5000);
  EXPECT_GT(edges, 500);
}

TEST(TouchBoxBox, PointsOfSeparateBoxesLieBetweenTheirSurfaces) {
  RandomShapes random(15);
  int separate = 0;
  for (int i = 0; i < 20000; ++i) {
    const BoxShape a = random.AnyBox(0.25), b = random.AnyBox(0.25);
    for (const TouchPoint& p : Touch(a, b, 0.03)) {
      if (p.gap_m < 0) continue;
      const Vec3 on_a = AsVec(p.point) + 0.5 * p.gap_m * AsVec(p.normal);
      const Vec3 on_b = AsVec(p.point) - 0.5 * p.gap_m * AsVec(p.normal);
      EXPECT_LT(Length(NearestOn(a, on_a) - on_a), 1e-5) << i;
      EXPECT_LT(Length(NearestOn(b, on_b) - on_b), 1e-5) << i;
      ++separate;
    }
  }
  EXPECT_GT(separate, 3000);
}

TEST(TouchBoxBox, SwappingTheBoxesFlipsTheNormals) {
  RandomShapes random(14);
  int touching = 0, same = 0;
  for (int i = 0; i < 20000; ++i) {
    const BoxShape a = random.AnyBox(0.2), b = random.AnyBox(0.2);
    const Points points = Touch(a, b, 0.01), swapped = Touch(b, a, 0.01);
    ASSERT_EQ(points.empty(), swapped.empty()) << i;
    if (points.empty()) continue;
    ++touching;
    TouchPoint p = Deepest(points), q = Deepest(swapped);
    // Of two equally good axes, the faces of the first box are preferred.
    EXPECT_NEAR(p.gap_m, q.gap_m, 0.06 * std::max(-p.gap_m, 0.0) + kPreferenceM) << i;
    same += Length(AsVec(p.normal) + AsVec(q.normal)) < 1e-9;
  }
  EXPECT_GT(touching, 10000);
  EXPECT_GT(same, 0.9 * touching) << same << " " << touching;
}

TEST(DistanceBoxBox, NeverExceedsTheDistanceAndIsCloseToIt) {
  RandomShapes random(13);
  int apart = 0, exact = 0;
  double least_share = 1, mean_share = 0;
  for (int i = 0; i < 10000; ++i) {
    const BoxShape a = random.AnyBox(0.5), b = random.AnyBox(0.5);
    const double walked = WalkedDistance(a, b, 200000), bound = Distance(a, b);
    ASSERT_LE(bound, walked + 1e-14) << i;
    if (walked < 1e-3) continue;
    ++apart;
    exact += bound > walked - 1e-6;
    least_share = std::min(least_share, bound / walked);
    mean_share += bound / walked;
  }
  EXPECT_GT(apart, 5000);
  EXPECT_GT(exact, apart / 4);
  EXPECT_GT(least_share, 0.7);
  EXPECT_GT(mean_share / apart, 0.97);
}

TEST(DistanceBoxBox, IsExactForFacesEdgesAndCornersAlongTheAxes) {
  EXPECT_NEAR(Distance(Cube(0.1), Cube(0.1, Shift({0.5, 0, 0}))), 0.3, kBoxTiny);
  EXPECT_NEAR(Distance(Cube(0.1), Cube(0.1, Shift({0.5, 0.6, 0}))), 0.5, kBoxTiny);
  EXPECT_NEAR(Distance(Cube(0.1), Cube(0.1, Shift({0.3, 0.4, -0.4}))), 0.3, kBoxTiny);
  EXPECT_EQ(Distance(Cube(0.1), Cube(0.1, Shift({0.1, 0, 0}))), 0.0);
}

}  // namespace
}  // namespace taut::sim
