// Contacts of spheres and capsules with each other and with boxes
#include <numbers>

#include <gtest/gtest.h>

#include "unit/sim/shape_helpers.h"

namespace taut::sim {
namespace {

constexpr double kTiny = 1e-12;
/// Tolerance of distances by alternating projection
constexpr double kWalkM = 1e-6;

void ExpectPoint(const TouchPoint& found, const Vec3& point, const Vec3& normal, double gap_m,
                 int feature, double tolerance = kTiny) {
  EXPECT_LT(Length(AsVec(found.point) - point), tolerance)
      << found.point[0] << " " << found.point[1] << " " << found.point[2];
  EXPECT_LT(Length(AsVec(found.normal) - normal), tolerance)
      << found.normal[0] << " " << found.normal[1] << " " << found.normal[2];
  EXPECT_NEAR(found.gap_m, gap_m, tolerance);
  EXPECT_EQ(found.feature, feature);
}

TEST(TouchRoundRound, TwoBallsTouchOnTheLineOfTheirCenters) {
  const Points points = Touch(Ball({0, 0, 0.3}, 0.2), Ball({0, 0, 0}, 0.15));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0, 0, 0.125}, {0, 0, 1}, -0.05, 0);
}

TEST(TouchRoundRound, OnlyPointsNearerThanTheMarginAreFound) {
  const RoundShape low = Ball({0, 0, 0}, 0.1), high = Ball({0, 0, 0.21}, 0.1);
  EXPECT_EQ(Touch(high, low, 0.0099).size(), 0u);
  ASSERT_EQ(Touch(high, low, 0.0101).size(), 1u);
  EXPECT_NEAR(Touch(high, low, 0.0101)[0].gap_m, 0.01, kTiny);
}

TEST(TouchRoundRound, BallsInOnePlaceAreDrivenApartUpwards) {
  const Points points = Touch(Ball({1, 2, 3}, 0.1), Ball({1, 2, 3}, 0.1));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {1, 2, 3}, {0, 0, 1}, -0.2, 0);
}

TEST(TouchRoundRound, BallOnRodTouchesBesideItsCenterLine) {
  const Points points = Touch(Ball({0.1, 0, 0.25}, 0.2), Rod({-1, 0, 0}, {1, 0, 0}, 0.1));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0.1, 0, 0.075}, {0, 0, 1}, -0.05, 0);
}

TEST(TouchRoundRound, CrossingRodsTouchInOnePoint) {
  const Points points =
      Touch(Rod({0.1, -0.5, 0.05}, {0.1, 0.5, 0.05}, 0.02), Rod({-1, 0, 0}, {1, 0, 0}, 0.03));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0.1, 0, 0.03}, {0, 0, 1}, 0.0, 0);
}

TEST(TouchRoundRound, ParallelRodsTouchAtTheEndsOfTheirOverlap) {
  const RoundShape low = Rod({-0.2, 0, 0}, {0.3, 0, 0}, 0.01);
  for (const bool reversed : {false, true}) {
    const Vec3 from{0.1, 0, 0.019}, to{0.6, 0, 0.019};
    const Points points = Touch(reversed ? Rod(to, from, 0.01) : Rod(from, to, 0.01), low);
    ASSERT_EQ(points.size(), 2u);
    ExpectPoint(points[reversed ? 1 : 0], {0.1, 0, 0.0095}, {0, 0, 1}, -0.001, reversed ? 2 : 1);
    ExpectPoint(points[reversed ? 0 : 1], {0.3, 0, 0.0095}, {0, 0, 1}, -0.001, reversed ? 1 : 2);
  }
}

TEST(TouchRoundRound, RodsEndToEndTouchInOnePoint) {
  const Points points =
      Touch(Rod({0.5, 0, 0}, {1.0, 0, 0}, 0.03), Rod({0, 0, 0}, {0.445, 0, 0}, 0.03));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0.4725, 0, 0}, {1, 0, 0}, -0.005, 0);
}

TEST(TouchRoundRound, RodsWhoseCenterLinesCrossArePushedAcrossBoth) {
  const RoundShape along_x = Rod({-1, 0, 0}, {1, 0, 0}, 0.1);
  const RoundShape along_y = Rod({0, -1, 0}, {0, 1, 0}, 0.1);
  const Points points = Touch(along_y, along_x);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(std::fabs(points[0].normal[2]), 1.0, kTiny);
  EXPECT_NEAR(points[0].gap_m, -0.2, kTiny);
}

TEST(TouchRoundRound, RodsWithOneCenterLineArePushedAcrossIt) {
  const Points points = Touch(Rod({0, 0, 0}, {1, 0, 0}, 0.1), Rod({0.5, 0, 0}, {1.5, 0, 0}, 0.1));
  ASSERT_EQ(points.size(), 2u);
  for (const TouchPoint& p : points) {
    EXPECT_NEAR(Length(AsVec(p.normal)), 1.0, kTiny);
    EXPECT_NEAR(p.normal[0], 0.0, kTiny);
    EXPECT_NEAR(p.gap_m, -0.2, kTiny);
  }
  EXPECT_LT(Length(AsVec(points[0].normal) - AsVec(points[1].normal)), kTiny);
}

// From parallel to 45 degrees in fine steps, with the rotating rod lying on the other: at every
// step the previous points are equivalent to the next ones, and vice versa.
TEST(TouchRoundRound, PointsOfATwistingRodStayContinuous) {
  const RoundShape low = Rod({-0.25, 0, 0}, {0.25, 0, 0}, 0.01);
  const RoundShape high = Rod({-0.25, 0, 0.01995}, {0.25, 0, 0.01995}, 0.01);
  Points before = Touch(high, low);
  ASSERT_EQ(before.size(), 2u);
  double angle = 1e-9;
  for (; angle < std::numbers::pi / 4; angle += std::min(1e-5, 0.05 * angle)) {
    const Points now = Touch(Moved(high, Turn({0, 0, 1}, angle)), low);
    ASSERT_LT(WorstChange(before, now, 0.01), 3e-5) << angle;
    ASSERT_NEAR(Deepest(now).gap_m, -5e-5, 2.1e-8) << angle;
    before = now;
  }
  EXPECT_EQ(before.size(), 1u);
}

TEST(TouchRoundBox, BallOnFaceEdgeAndCornerTouchesTheNearestPoint) {
  const BoxShape box = Cube(0.5);
  Points points = Touch(Ball({0.1, 0.2, 0.6}, 0.12), box);
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0.1, 0.2, 0.49}, {0, 0, 1}, -0.02, 0);

  points = Touch(Ball({0.53, 0.1, 0.54}, 0.05), box);
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0.5, 0.1, 0.5}, {0.6, 0, 0.8}, 0.0, 0);

  points = Touch(Ball({0.52, 0.52, 0.51}, 0.04), box);
  ASSERT_EQ(points.size(), 1u);
  const Vec3 out = {2.0 / 3, 2.0 / 3, 1.0 / 3};
  ExpectPoint(points[0], Vec3{0.5, 0.5, 0.5} - 0.005 * out, out, -0.01, 0);
}

TEST(TouchRoundBox, BallInsideABoxLeavesThroughTheNearestFace) {
  const Points points = Touch(Ball({0.1, -0.4, 0.2}, 0.05), Cube(0.5));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], {0.1, -0.425, 0.2}, {0, -1, 0}, -0.15, 0);
}

TEST(TouchRoundBox, RodOnALargeFaceRestsOnBothEnds) {
  const Points points = Touch(Rod({-0.2, 0, 0.519}, {0.3, 0, 0.519}, 0.02), Cube(0.5));
  ASSERT_EQ(points.size(), 2u);
  ExpectPoint(points[0], {-0.2, 0, 0.4995}, {0, 0, 1}, -0.001, 0);
  ExpectPoint(points[1], {0.3, 0, 0.4995}, {0, 0, 1}, -0.001, 1);
}

TEST(TouchRoundBox, RodAcrossABoxIsCarriedAtBothEdges) {
  const Points points =
      Touch(Rod({-0.4, 0.01, 0.119}, {0.5, 0.01, 0.119}, 0.02), Box({0.05, 0.2, 0.1}));
  ASSERT_EQ(points.size(), 2u);
  ExpectPoint(points[0], {-0.05, 0.01, 0.0995}, {0, 0, 1}, -0.001, 3);
  ExpectPoint(points[1], {0.05, 0.01, 0.0995}, {0, 0, 1}, -0.001, 4);
}

TEST(TouchRoundBox, RodHalfOverAStepIsCarriedAtItsEndAndAtTheStepsEdge) {
  const Points points = Touch(Rod({-0.2, 0, 0.119}, {0.3, 0, 0.119}, 0.02),
                              Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0})));
  ASSERT_EQ(points.size(), 2u);
  ExpectPoint(points[0], {-0.2, 0, 0.0995}, {0, 0, 1}, -0.001, 0);
  ExpectPoint(points[1], {0, 0, 0.0995}, {0, 0, 1}, -0.001, 4);
}

TEST(TouchRoundBox, RodLeaningOnAStepEdgeIsCarriedAcrossItself) {
  // The rod leans at 45 degrees; its center line passes the edge (0, y, 0.1) at 0.019.
  const double s = std::sqrt(0.5);
  const Vec3 out{s, 0, s}, down{s, 0, -s}, middle = Vec3{0, 0, 0.1} + 0.019 * out;
  const Points points = Touch(Rod(middle - 0.2 * down, middle + 0.1 * down, 0.02),
                              Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0})));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], Vec3{0, 0, 0.1} - 0.0005 * out, out, -0.001, 2);
}

// The same rod, so deep that its center line is 0.001 inside: the direction out is continuous.
TEST(TouchRoundBox, RodDeepInAStepEdgeIsPushedAcrossItself) {
  const double s = std::sqrt(0.5);
  const Vec3 out{s, 0, s}, down{s, 0, -s}, middle = Vec3{0, 0, 0.1} - 0.001 * out;
  const Points points = Touch(Rod(middle - 0.2 * down, middle + 0.1 * down, 0.02),
                              Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0})));
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], Vec3{0, 0, 0.1} - 0.0105 * out, out, -0.021, 2);
}

TEST(TouchRoundBox, RodThatEndsAtAStepEdgeHasNoPointTwice) {
  const BoxShape step = Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0}));
  const Points points = Touch(Rod({-0.2, 0, 0.119}, {1e-6, 0, 0.119}, 0.02), step);
  ASSERT_EQ(points.size(), 2u);
  ExpectPoint(points[0], {-0.2, 0, 0.0995}, {0, 0, 1}, -0.001, 0);
  ExpectPoint(points[1], {0, 0, 0.0995}, {0, 0, 1}, -0.001, 1, 1e-4);
}

// A point equivalent to the nearest one must have a gap below the margin.
TEST(TouchRoundBox, RodThatIsOnlyJustNearAnEdgeHasAPoint) {
  // Along the edge (0, y, 0.1), outside at 45 degrees, and rotated so that it bulges by 4e-9.
  const double s = std::sqrt(0.5);
  const BoxShape step = Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0}));
  const RoundShape rod = Moved(Rod({0, -0.25, 0}, {0, 0.25, 0}, 0.01),
                               Turn({s, 0, s}, 5e-5, {0.01 * s, 0, 0.1 + 0.01 * s}));
  EXPECT_EQ(Touch(rod, step, 1e-9).size(), 1u);
}

TEST(TouchRoundRound, RodThatIsOnlyJustNearAnotherHasAPoint) {
  const RoundShape low = Rod({-0.25, 0, 0}, {0.25, 0, 0}, 0.01);
  const RoundShape high = Moved(low, Turn({0, 0, 1}, 5e-5, {0, 0, 0.02}));
  EXPECT_EQ(Touch(high, low, 1e-9).size(), 1u);
}

TEST(TouchRoundBox, PointsOfARodThatTiltsOverAnEdgeStayContinuous) {
  const BoxShape step = Box({0.5, 0.5, 0.1}, Shift({-0.5, 0, 0}));
  const RoundShape rod = Rod({-0.2, 0, 0}, {0.3, 0, 0}, 0.02);
  Points before;
  for (double angle = -1e-9; angle < 0.5; angle += std::clamp(0.05 * angle, 1e-10, 1e-5)) {
    const Vec3 lift{0.01995 * std::sin(angle), 0, 0.1 + 0.01995 * std::cos(angle)};
    const Points now = Touch(Moved(rod, Turn({0, 1, 0}, angle, lift)), step);
    ASSERT_FALSE(now.empty());
    if (!before.empty()) {
      ASSERT_LT(WorstChange(before, now, 0.02), 2e-5) << angle;
    }
    if (angle > 0) {
      EXPECT_NEAR(Deepest(now).gap_m, -5e-5, 2.1e-8) << angle;
    }
    before = now;
  }
}

TEST(TouchRoundBox, RodDeepInsideLeavesWithAllItsPointsTheSameWay) {
  RandomShapes random(5);
  int deep = 0, by_edge = 0;
  for (int i = 0; i < 20000; ++i) {
    const RoundShape rod = random.Round(0.2);
    const BoxShape box = random.AnyBox(0.1);
    const Points points = Touch(rod, box);
    if (points.empty() || Deepest(points).gap_m >= -rod.radius_m) continue;
    ++deep;
    const TouchPoint deepest = Deepest(points);
    by_edge += deepest.feature == 2;
    for (const TouchPoint& p : points) {
      EXPECT_EQ(Length(AsVec(p.normal) - AsVec(deepest.normal)), 0.0) << i;
    }
    // This displacement separates them, except for 5 % of the radius, and is not longer than
    // needed.
    const Vec3 way = -deepest.gap_m * AsVec(deepest.normal);
    const double left = Deepest(Touch(Moved(rod, Shift(way)), box)).gap_m;
    EXPECT_LT(left, 1e-9) << i;
    EXPECT_GT(left, -0.05 * rod.radius_m - 1e-9) << i;
  }
  EXPECT_GT(deep, 3000);
  EXPECT_GT(by_edge, 300);
}

// For any pair: unit normals, the nearest point among the points found, points on both surfaces.
template <class B, class MakeB>
void CheckRandomPairs(unsigned seed, MakeB make_b) {
  RandomShapes random(seed);
  int touching = 0;
  for (int i = 0; i < 20000; ++i) {
    const RoundShape a = random.Round(0.3);
    const B b = make_b(random);
    const Points points = Touch(a, b, 0.05);
    const double apart = WalkedDistance(a, b);
    if (apart < 0.0499) {
      ASSERT_FALSE(points.empty()) << i;
    }
    if (points.empty()) continue;
    ++touching;
    if (apart > 1e-6) {
      EXPECT_NEAR(Deepest(points).gap_m, apart, kWalkM) << i;
    }
    for (const TouchPoint& p : points) {
      EXPECT_LT(p.gap_m, 0.05);
      EXPECT_NEAR(Length(AsVec(p.normal)), 1.0, 1e-12);
      const Vec3 on_a = AsVec(p.point) + 0.5 * p.gap_m * AsVec(p.normal);
      const Vec3 on_b = AsVec(p.point) - 0.5 * p.gap_m * AsVec(p.normal);
      EXPECT_LT(Length(NearestOn(a, on_a) - on_a), a.radius_m + 1e-9) << i;
      // The way out of a box may lead past its face, a gap may not.
      if (p.gap_m > 0) {
        EXPECT_LT(Length(NearestOn(b, on_b) - on_b), RadiusOf(b) + 1e-9) << i;
      }
    }
  }
  EXPECT_GT(touching, 3000);
}

TEST(TouchRoundRound, PointsReachBothShapesAndTheNearestIsAmongThem) {
  CheckRandomPairs<RoundShape>(1, [](RandomShapes& random) { return random.Round(0.3); });
}
TEST(TouchRoundBox, PointsReachBothShapesAndTheNearestIsAmongThem) {
  CheckRandomPairs<BoxShape>(2, [](RandomShapes& random) { return random.AnyBox(0.2); });
}

TEST(TouchRoundRound, SwappingTheShapesFlipsTheNormals) {
  RandomShapes random(3);
  int touching = 0;
  for (int i = 0; i < 5000; ++i) {
    const RoundShape a = random.Round(0.2), b = random.Round(0.2);
    Points swapped = Touch(b, a, 0.02);
    for (TouchPoint& p : swapped) {
      for (double& x : p.normal) x = -x;
    }
    const Points points = Touch(a, b, 0.02);
    ASSERT_EQ(points.size(), swapped.size()) << i;
    touching += !points.empty();
    for (const TouchPoint& p : points) EXPECT_LT(Uncovered(p, swapped, 1.0), 1e-10) << i;
  }
  EXPECT_GT(touching, 1000);
}

template <class A, class B>
void ExpectMovesAlong(const A& a, const B& b, const Motion& motion) {
  const Points points = Touch(a, b, 0.02);
  const Points moved = Touch(Moved(a, motion), Moved(b, motion), 0.02);
  ASSERT_EQ(points.size(), moved.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    ExpectPoint(moved[i], motion(AsVec(points[i].point)), Rotate(motion.q, AsVec(points[i].normal)),
                points[i].gap_m, points[i].feature, 1e-9);
  }
  EXPECT_NEAR(Distance(a, b), Distance(Moved(a, motion), Moved(b, motion)), 1e-12);
}

TEST(ShapeContacts, PointsMoveAlongWithTheShapes) {
  RandomShapes random(4);
  for (int i = 0; i < 3000; ++i) {
    const Motion motion = random.Anywhere(2.0);
    const RoundShape a = random.Round(0.2), b = random.Round(0.2);
    const BoxShape c = random.AnyBox(0.2), d = random.AnyBox(0.2);
    ExpectMovesAlong(a, b, motion);
    ExpectMovesAlong(a, c, motion);
    ExpectMovesAlong(c, d, motion);
    if (HasFailure()) FAIL() << "pair " << i;
  }
}

TEST(DistanceRoundRound, IsTheLeastDistance) {
  RandomShapes random(6);
  for (int i = 0; i < 10000; ++i) {
    const RoundShape a = random.Round(0.5), b = random.Round(0.5);
    const double walked = WalkedDistance(a, b, 200000);
    EXPECT_LE(Distance(a, b), walked + 1e-14) << i;
    EXPECT_GE(Distance(a, b), walked - kWalkM) << i;
  }
}

TEST(DistanceRoundRound, IsExactForRodsAtTinyAngles) {
  // The lines cross at their centers, 0.1 apart; the ends are farther.
  for (double angle = 1e-1; angle > 1e-12; angle *= 0.1) {
    const RoundShape low = Rod({-0.5, 0, 0}, {0.5, 0, 0}, 0.01);
    const RoundShape high = Moved(low, Turn({0, 0, 1}, angle, {0, 0, 0.1}));
    EXPECT_NEAR(Distance(low, high), 0.08, 1e-15) << angle;
  }
}

TEST(DistanceRoundBox, IsTheLeastDistance) {
  RandomShapes random(7);
  for (int i = 0; i < 10000; ++i) {
    const RoundShape a = random.Round(0.5);
    const BoxShape b = random.AnyBox(0.3);
    const double walked = WalkedDistance(a, b, 200000);
    EXPECT_LE(Distance(a, b), walked + 1e-14) << i;
    EXPECT_GE(Distance(a, b), walked - kWalkM) << i;
  }
}

}  // namespace
}  // namespace taut::sim
