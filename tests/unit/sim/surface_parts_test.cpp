// Cached parts of a field near a rod, reused from step to step, against searches from scratch
#include <gtest/gtest.h>

#include <cstring>

#include "sim/geometry/shape_contacts.h"
#include "sim/geometry/surface_parts.h"
#include "unit/sim/surface_helpers.h"

namespace taut::sim {
namespace {

/// Moves a rod, or a ball, over a field by steps of up to `step_m` and compares all contacts.
/// Counts the steps served by cached parts, and the points.
struct Walk {
  int served = 0, points = 0, between = 0;

  void Go(const Known& field, unsigned seed, bool ball, double radius_m, double step_m,
          double low_m) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vec = [&](double size) {
      return Vec3{size * unit(random), size * unit(random), size * unit(random)};
    };
    const SurfaceTable& s = field.table();
    const SurfaceShape ground{&s};
    NearParts kept{};
    Vec3 ends[2];
    for (Vec3& end : ends) {
      end = Vec3{0.3, -0.2, 0} + Vec3{0.4 * unit(random), 0.35 * unit(random), 0};
      end.z = HeightAt(s, end.x, end.y) + radius_m + low_m * unit(random);
    }
    for (int step = 0; step < 120; ++step) {
      ends[0] = ends[0] + vec(step_m), ends[1] = ball ? ends[0] : ends[1] + vec(step_m);
      RoundShape rod;
      rod.radius_m = radius_m;
      for (int k = 0; k < 3; ++k) {
        rod.from[k] = (&ends[0].x)[k], rod.to[k] = (&ends[1].x)[k];
      }
      const double margin_m = 1e-3 * (1 + unit(random));
      const unsigned elsewhere = FeaturesOfEnd(0) * (step % 2) | FeaturesOfEnd(1) * (step / 2 % 2);
      if (Serves(s, ends[0], ends[1], radius_m + margin_m, kept)) ++served;
      TouchPoint all[kMaxPointsPerPair], expected[kMaxPointsPerPair], found[kMaxPointsPerPair];
      int count = 0;
      for (int i = 0, full = Touch(rod, ground, margin_m, all); i < full; ++i) {
        if ((elsewhere >> all[i].feature & 1u) == 0) expected[count++] = all[i];
        if (all[i].feature >= 6) ++between;
      }
      points += count;
      ASSERT_EQ(TouchGround(rod, ground, margin_m, elsewhere, &kept, found), count) << step;
      for (int i = 0; i < count; ++i) {
        EXPECT_EQ(std::memcmp(&found[i].point, &expected[i].point, 7 * sizeof(double)), 0) << step;
        EXPECT_EQ(found[i].feature, expected[i].feature);
      }
      const double enough_m = 5e-3;
      ASSERT_EQ(DistanceToGround(rod, ground, enough_m, &kept),
                DistanceUpTo(rod, ground, enough_m));
    }
  }
};

TEST(NearParts, WhatIsKeptChangesNoBit) {
  Walk slow, fast, deep;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Known field(RoughField(seed));
    const bool ball = seed % 4 == 0;
    const double radius_m = seed % 2 == 0 ? 0.08 : 0.01;
    slow.Go(field, seed, ball, radius_m, 2e-4, 0.01);
    fast.Go(field, seed, ball, radius_m, 4e-3, 0.01);
    deep.Go(field, seed, ball, radius_m, 4e-4, 0.06);
  }
  EXPECT_GT(slow.served, 4000);
  EXPECT_GT(slow.points, 4000);
  EXPECT_GT(slow.between, 500);
  EXPECT_GT(fast.points, 3000);
  EXPECT_GT(deep.served, 3000);
}

TEST(NearParts, BesideAFieldAndAboveItsBorderThereIsTheSame) {
  Walk walk;
  for (unsigned seed = 50; seed < 70; ++seed) {
    HeightFieldDef def = RoughField(seed, 4, 3);  // smaller than the range of starts
    walk.Go(Known(def), seed, seed % 3 == 0, 0.03, 3e-4, 0.02);
  }
  EXPECT_GT(walk.served, 500);
  EXPECT_GT(walk.points, 500);
}

}  // namespace
}  // namespace taut::sim
