/// Energy of freely rotating bodies (docs/theory/integrator.md, section 2).

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/world.h"
#include "tests/scenes/box.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

/// Returns a rod with an axial moment of inertia of a thousandth of the transverse one, along a
/// unit `axis`.
ModelDef ThinRod(const Vec3& axis, const Vec3& w) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const double half = 0.25, radius = std::sqrt(half * half / 1498.5);
  scenes::AddRod(def, "rod", 0.1, radius, -half * axis, half * axis, {});
  def.bodies[0].angular_velocity_rad_per_s = w;
  return def;
}

TEST(RotationEnergy, AThinRodKeepsItToRoundingHoweverFastItSpinsAboutItself) {
  // H = L^2 / 2Ix + (1 / Iz - 1 / Ix) lz^2 / 2 for a body with an axis z of symmetry: the two parts
  // commute, so that rotations about L and z are its exact motion. Also for an oblique axis, where
  // the two equal moments are eigenvalues with rounding errors.
  const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2.0 / 7, 3.0 / 7, 6.0 / 7}};
  for (const Vec3& axis : axes) {
    for (const double h : kThreeStepsS) {
      const Vec3 across{axis.y - axis.z, axis.z - axis.x, axis.x - axis.y};
      for (const double spin : {0.0, 5.0, 200.0}) {
        ModelDef def = ThinRod(axis, spin * axis + (4 / Norm(across)) * across);
        const Inertia& i = def.bodies[0].inertia_kg_m2;
        ASSERT_NEAR((i.xx + i.yy + i.zz) / 2.001 / 0.1, 0.25 * 0.25 / 3, 1e-4);
        WorldBatch world = MakeBatch(def);
        const double start = EnergyOf(world);
        // An axis that is off by eps turns transverse momentum into axial momentum, with the large
        // axial angular velocity.
        const double size = Norm(world.AngularMomentum(0)) * (spin + 4);
        const int steps = StepsIn(20, h);
        for (int n = 1; n <= steps; ++n) {
          world.Step(h);
          ASSERT_LE(std::fabs(EnergyOf(world) - start), RoundOff(n, size)) << spin << " " << h;
        }
      }
    }
  }
}

/// Lowest and highest energy of a rotating box relative to the start: over the first ten seconds
/// and over the last ten of a hundred.
struct EnergyBand {
  double low = 0, high = 0;
  void Take(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double size() const { return high - low; }
};
struct Ranges {
  EnergyBand first, last;
};
Ranges EnergyOfBox(double h) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  scenes::AddBox(def, "box", 1, {0.1, 0.06, 0.04}, {0, 0, 0}, scenes::Turn({0.6, 0, 0.8}, 0.7), {});
  def.bodies[0].angular_velocity_rad_per_s = {7, -5, 11};
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  Ranges ranges;
  for (int n = 1; n <= StepsIn(100, h); ++n) {
    world.Step(h);
    const double off = EnergyOf(world) / start - 1;
    if (n * h <= 10) ranges.first.Take(off);
    if (n * h >= 90) ranges.last.Take(off);
  }
  return ranges;
}

TEST(RotationEnergy, OfABoxItSwingsByTheSquareOfTheStepAndDoesNotDrift) {
  const Ranges coarse = EnergyOfBox(4e-3), middle = EnergyOfBox(2e-3), fine = EnergyOfBox(1e-3);
  // The error is of second order in h w = 0.056, times coefficients below one.
  EXPECT_LT(coarse.first.size(), 0.056 * 0.056);
  EXPECT_GT(fine.first.size(), 0);
  EXPECT_NEAR(coarse.first.size() / middle.first.size(), 4, 0.1);
  EXPECT_NEAR(middle.first.size() / fine.first.size(), 4, 0.1);
  for (const Ranges& r : {coarse, middle, fine}) {
    EXPECT_NEAR(r.last.size(), r.first.size(), 0.01 * r.first.size());
    EXPECT_NEAR(r.last.high, r.first.high, 0.01 * r.first.size());
  }
}

}  // namespace
}  // namespace taut::test
