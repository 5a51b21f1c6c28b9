// Pairs of shapes of all kinds, in either order, each in a local frame
#include <gtest/gtest.h>

#include "unit/sim/shape_helpers.h"

namespace taut::sim {
namespace {

Shape Any(const RoundShape& round) { return {ShapeKind::kRound, round, {}}; }
Shape Any(const BoxShape& box) { return {ShapeKind::kBox, {}, box}; }

ShapePose PoseOf(const Motion& motion) {
  ShapePose pose{};
  const Vec3 columns[3] = {Rotate(motion.q, {1, 0, 0}), Rotate(motion.q, {0, 1, 0}),
                           Rotate(motion.q, {0, 0, 1})};
  for (int i = 0; i < 3; ++i) {
    pose.r[i] = columns[i].x;
    pose.r[3 + i] = columns[i].y;
    pose.r[6 + i] = columns[i].z;
  }
  pose.origin[0] = motion.p.x;
  pose.origin[1] = motion.p.y;
  pose.origin[2] = motion.p.z;
  return pose;
}

// A ball that penetrates the top of a plank by 0.05 m; only the pose puts the plank along y.
const Shape kPlank = Any(Box({1.0, 0.2, 0.1}));
const Shape kBall = Any(Ball({0, 0, 0.1}, 0.2));
const ShapePose kPlankPose = PoseOf(Turn({0, 0, 1}, 1.5707963267948966, {0, 0, -0.1}));
const ShapePose kBallPose = PoseOf(Shift({0.1, 0.7, 0.05}));

void ExpectBallOnPlank(const TouchPoint& p, double up) {
  EXPECT_LT(Length(AsVec(p.point) - Vec3{0.1, 0.7, -0.025}), 1e-12);
  EXPECT_LT(Length(AsVec(p.normal) - Vec3{0, 0, up}), 1e-12);
  EXPECT_NEAR(p.gap_m, -0.05, 1e-12);
}

TEST(TouchShapes, NormalPointsFromTheSecondShapeToTheFirstInEitherOrder) {
  TouchPoint out[kMaxPointsPerPair];
  ASSERT_EQ(TouchShapes(kBall, kBallPose, kPlank, kPlankPose, 1e-4, out), 1);
  ExpectBallOnPlank(out[0], 1);
  ASSERT_EQ(TouchShapes(kPlank, kPlankPose, kBall, kBallPose, 1e-4, out), 1);
  ExpectBallOnPlank(out[0], -1);
}

TEST(TouchShapes, MarginReachesThePair) {
  TouchPoint out[kMaxPointsPerPair];
  const ShapePose above = PoseOf(Shift({0.1, 0.7, 0.15}));  // 0.05 m above the plank
  EXPECT_EQ(TouchShapes(kBall, above, kPlank, kPlankPose, 0.049, out), 0);
  EXPECT_EQ(TouchShapes(kBall, above, kPlank, kPlankPose, 0.051, out), 1);
}

TEST(DistanceOfShapes, IsTheSameInEitherOrder) {
  const ShapePose above = PoseOf(Shift({0.1, 0.7, 0.4}));
  EXPECT_NEAR(DistanceOfShapes(kBall, above, kPlank, kPlankPose), 0.3, 1e-12);
  EXPECT_NEAR(DistanceOfShapes(kPlank, kPlankPose, kBall, above), 0.3, 1e-12);
  EXPECT_EQ(DistanceOfShapes(kBall, kBallPose, kPlank, kPlankPose), 0.0);
}

/// Expects that shapes in local frames touch like shapes moved by these frames.
template <class A, class B>
int ExpectAsMoved(const A& a, const Motion& at_a, const B& b, const Motion& at_b) {
  TouchPoint out[kMaxPointsPerPair];
  const int count = TouchShapes(Any(a), PoseOf(at_a), Any(b), PoseOf(at_b), 0.02, out);
  const Points moved = Touch(Moved(a, at_a), Moved(b, at_b), 0.02);
  EXPECT_EQ(static_cast<std::size_t>(count), moved.size());
  for (int i = 0; i < count; ++i) EXPECT_LT(Uncovered(out[i], moved, 1.0), 1e-9);
  EXPECT_NEAR(DistanceOfShapes(Any(a), PoseOf(at_a), Any(b), PoseOf(at_b)),
              Distance(Moved(a, at_a), Moved(b, at_b)), 1e-12);
  return count;
}

TEST(TouchShapes, EveryPairOfKindsTouchesWhereItsFramesPutIt) {
  RandomShapes random(11);
  int touching[3] = {};
  for (int i = 0; i < 3000; ++i) {
    const Motion at_a = random.Anywhere(0.2), at_b = random.Anywhere(0.2);
    const RoundShape a = random.Round(0.1), b = random.Round(0.1);
    const BoxShape c = random.AnyBox(0.1), d = random.AnyBox(0.1);
    touching[0] += ExpectAsMoved(a, at_a, b, at_b) > 0;
    touching[1] += ExpectAsMoved(a, at_a, d, at_b) > 0;
    touching[2] += ExpectAsMoved(c, at_a, d, at_b) > 0;
    if (HasFailure()) FAIL() << "pair " << i;
  }
  for (const int count : touching) EXPECT_GT(count, 500);
}

}  // namespace
}  // namespace taut::sim
