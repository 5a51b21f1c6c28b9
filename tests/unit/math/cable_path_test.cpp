// Path of a cable against cases in closed form, and against differences of its length
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "math/cable_path.h"
#include "math/vec.h"
#include "simd/vec3.h"

namespace taut {
namespace {

using Point = PathPoint<Vec3>;
using Path = std::vector<Point>;

int Count(const Path& path) { return static_cast<int>(path.size()); }
PathLength<Vec3> Measure(Path& path) { return MeasurePath(Count(path), path.data()); }
/// Not inline, because g++ 12 would falsely warn of points beyond the last.
[[gnu::noinline]] Vec3 Pull(const Path& path, int i) { return PullAt(Count(path), path.data(), i); }

void ExpectVec(const Vec3& found, const Vec3& expected, double tolerance = 1e-15) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
  EXPECT_NEAR(found.z, expected.z, tolerance);
}

/// A moving body, with the force and torque of a path
struct Body {
  Vec3 origin, v, w;
  Vec3 force, torque;
};

Point On(const Body& body, const Vec3& arm) {
  return {body.origin + arm, body.v + Cross(body.w, arm), arm, {}};
}

TEST(CablePath, TwoPointsPullAtEachOtherAlongTheLineBetweenThem) {
  Path path{{{1, 1, 1}, {}, {}, {}}, {{4, 5, 1}, {}, {}, {}}};
  EXPECT_EQ(Measure(path).l, 5);
  ExpectVec(Pull(path, 0), {0.6, 0.8, 0});
  ExpectVec(Pull(path, 1), {-0.6, -0.8, 0});
}

TEST(CablePath, EyeletIsPulledAlongBothOfItsSpans) {
  Path path{{{0, 0, 0}, {}, {}, {}}, {{3, 0, 0}, {}, {}, {}}, {{3, 4, 0}, {}, {}, {}}};
  EXPECT_EQ(Measure(path).l, 7);
  ExpectVec(Pull(path, 0), {1, 0, 0});
  ExpectVec(Pull(path, 1), {-1, 1, 0});
  ExpectVec(Pull(path, 2), {0, -1, 0});
}

TEST(CablePath, SpanBetweenPointsInOnePlacePullsWithNothing) {
  Path path{{{0, 0, 0}, {}, {}, {}},
            {{0, 0, 2}, {}, {}, {}},
            {{0, 0, 2}, {}, {}, {}},
            {{0, 1, 2}, {}, {}, {}}};
  path[1].v = {5, 6, 7};
  const PathLength<Vec3> measured = Measure(path);
  EXPECT_EQ(measured.l, 3);
  EXPECT_EQ(measured.dl, 7);  // of the first span; the second has no direction
  ExpectVec(path[2].u, {0, 0, 0});
  ExpectVec(Pull(path, 1), {0, 0, -1});
  ExpectVec(Pull(path, 2), {0, 1, 0});
}

TEST(CablePath, OnlyMotionAlongASpanChangesItsLength) {
  Path path{{{0, 0, 0}, {0.5, 2, 3}, {}, {}}, {{2, 0, 0}, {0.75, -1, 4}, {}, {}}};
  EXPECT_EQ(Measure(path).dl, 0.25);
}

TEST(CablePath, LengthIsTheSameWithoutDirections) {
  const Vec3 places[3] = {{0.1, 0.2, 0.3}, {-1, 0.7, 2}, {0.4, 0.4, -3}};
  Path path;
  for (const Vec3& p : places) path.push_back({p, {}, {}, {}});
  EXPECT_EQ(MeasureThrough<Vec3>(3, [&](int i) { return places[i]; }).l, Measure(path).l);
  EXPECT_EQ(MeasureThrough<Vec3>(1, [&](int i) { return places[i]; }).l, 0);
}

TEST(CablePath, LeversAreThoseOfTheForcesOnTheBody) {
  // A bar along x, pulled up at one end from 1 m above, down at the other end from 2 m below
  Body world, bar;
  const Vec3 right{0.5, 0, 0}, left{-0.5, 0, 0};
  Body* const bodies[4] = {&world, &bar, &bar, &world};
  Path path{On(world, {0.5, 0, 1}), On(bar, right), On(bar, left), On(world, {-0.5, 0, -2})};
  EXPECT_EQ(Measure(path).l, 1 + 1 + 2);
  PullBodies(4, path.data(), 3.0, [&](int i) -> Body& { return *bodies[i]; });
  ExpectVec(bar.force, {0, 0, 0});
  ExpectVec(bar.torque, {0, -3, 0});  // (0.5, 0, 0) x (0, 0, 3) + (-0.5, 0, 0) x (0, 0, -3)
  ExpectVec(world.force, {0, 0, 0});
}

/// Random paths over three moving bodies
class RandomPath : public ::testing::Test {
 protected:
  Vec3 Draw(double size) {
    std::uniform_real_distribution<double> x(-size, size);
    const double a = x(random_), b = x(random_);
    return {a, b, x(random_)};
  }
  void Make() {
    for (Body& body : bodies_) body = {Draw(2), Draw(1), Draw(1), {}, {}};
    arms_.clear();
    for (int i = 0; i < 5; ++i) arms_.push_back(Draw(0.5));
  }
  Body& BodyOf(int i) { return bodies_[i % 3]; }
  Path PathNow() {
    Path path;
    for (int i = 0; i < 5; ++i) path.push_back(On(BodyOf(i), arms_[static_cast<std::size_t>(i)]));
    return path;
  }
  /// Returns the length after a time `t`; arms rotate about w.
  double LengthAt(double t) {
    return MeasureThrough<Vec3>(5,
                                [&](int i) {
                                  const Body& body = BodyOf(i);
                                  const double speed = std::sqrt(Dot(body.w, body.w));
                                  const double s = std::sin(0.5 * speed * t) / speed;
                                  const Quat turn{std::cos(0.5 * speed * t), s * body.w.x,
                                                  s * body.w.y, s * body.w.z};
                                  return body.origin + t * body.v +
                                         Rotate(turn, arms_[static_cast<std::size_t>(i)]);
                                })
        .l;
  }

  std::mt19937_64 random_{5};
  Body bodies_[3];
  std::vector<Vec3> arms_;
};

TEST_F(RandomPath, RateIsTheDerivativeOfTheLength) {
  const double h = 1e-5;  // h^2 of the scheme and 1e-16 / h of rounding are both about 1e-10
  for (int round = 0; round < 200; ++round) {
    Make();
    Path path = PathNow();
    EXPECT_NEAR(Measure(path).dl, (LengthAt(h) - LengthAt(-h)) / (2 * h), 2e-8) << round;
  }
}

TEST_F(RandomPath, PullsDoTheWorkThatShortensTheCable) {
  for (int round = 0; round < 200; ++round) {
    Make();
    Path path = PathNow();
    const double tension = 2.5, rate = Measure(path).dl;
    PullBodies(5, path.data(), tension, [&](int i) -> Body& { return BodyOf(i); });
    double power = 0, point_by_point = 0;
    Vec3 force{}, torque{};
    for (const Body& body : bodies_) {
      power += Dot(body.force, body.v) + Dot(body.torque, body.w);
      force = force + body.force;
      torque = torque + body.torque + Cross(body.origin, body.force);
    }
    for (int i = 0; i < 5; ++i) {
      point_by_point += Dot(Pull(path, i), path[static_cast<std::size_t>(i)].v);
    }
    EXPECT_NEAR(power, -tension * rate, 1e-13) << round;
    EXPECT_NEAR(point_by_point, -rate, 1e-13) << round;
    ExpectVec(force, {0, 0, 0}, 1e-14);
    ExpectVec(torque, {0, 0, 0}, 1e-13);
  }
}

TEST_F(RandomPath, WideNumbersGiveTheBitsOfPlainOnes) {
  using W = simd::Wide<2>;
  const auto wide = [](const Vec3& a, const Vec3& b) {
    W x = W::Splat(a.x), y = W::Splat(a.y), z = W::Splat(a.z);
    x.Set(1, b.x);
    y.Set(1, b.y);
    z.Set(1, b.z);
    return simd::V3<W>{x, y, z};
  };
  Make();
  Path a = PathNow();
  Make();
  Path b = PathNow();
  PathPoint<simd::V3<W>> both[5];
  for (std::size_t i = 0; i < 5; ++i) {
    both[i].p = wide(a[i].p, b[i].p);
    both[i].v = wide(a[i].v, b[i].v);
  }
  const PathLength<simd::V3<W>> measured = MeasurePath(5, both);
  for (int lane = 0; lane < 2; ++lane) {
    Path& path = lane == 0 ? a : b;
    const PathLength<Vec3> plain = Measure(path);
    EXPECT_EQ(measured.l[lane], plain.l);
    EXPECT_EQ(measured.dl[lane], plain.dl);
    for (int i = 0; i < 5; ++i) {
      const simd::V3<W> pull = PullAt(5, both, i);
      ExpectVec({pull.x[lane], pull.y[lane], pull.z[lane]}, Pull(path, i), 0);
    }
  }
}

}  // namespace
}  // namespace taut
