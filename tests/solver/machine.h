/// Island with unknowns of all kinds (body, point mass, rotor, driven belt), for tests.
#pragma once

#include "tests/solver/ball_joint.h"

namespace taut::test {

using MixedIsland = OwnIsland<Joint, Contact2, Cable>;

struct Machine {
  MixedIsland island;
  int body, lever, rotor, mass, belt;
};

inline constexpr double kRadius = 0.02, kRotorInertia = 3e-4, kPointMass = 0.3, kMu = 0.08;
inline constexpr double kBase = 0.06, kGain = 0.8;
inline const Vec3 kBeltSpeed = {0.2, -0.1, 0}, kBeltSpin = {0, 0, 0.3};
inline const Vec3 kNormal[3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
inline const Vec3 kFoot = {0.1, 0.05, -0.2}, kOnBelt = {0.4, 0, 0.1}, kPull = {0.6, 0, 0.8};

/// Builds a body whose foot stands on a driven belt. A point mass hangs from a cable that a rotor
/// winds and a second body holds at its end; a joint connects the two bodies.
inline void Build(Machine& m, double friction, const Vec3& belt_speed = kBeltSpeed) {
  MixedIsland& island = m.island;
  const Inertia inertia = {{{90, 5, 0}, {5, 110, -8}, {0, -8, 70}}};
  m.belt = island.AddBody(1 / 40.0, inertia, belt_speed, kBeltSpin);
  island.Prescribe(m.belt);
  m.rotor = island.AddRotor(kRotorInertia, 4);
  m.body = island.AddBody(2, inertia, {0.05, 0.02, -0.3}, {0.2, 0.1, -0.4});
  m.mass = island.AddPointMass(kPointMass, {0, 0.1, -0.2});
  m.lever = island.AddBody(3, inertia, {0, 0, -0.1}, {0, 0.3, 0});
  AddJoint(island, m.lever, {0.1, 0, 0}, m.body, {-0.1, 0, 0.1}, {0.01, 0, 0});
  auto& foot = island.Add<Contact2>();
  foot.live = Num::Splat(1.0), foot.mu = Num::Splat(friction), foot.link_count = 2;
  foot.bias[0] = Num::Splat(0.03);
  for (int r = 0; r < 3; ++r) {
    island.SetRow(foot.links[0], r, m.body, kNormal[r], Cross(kFoot, kNormal[r]));
    island.SetRow(foot.links[1], r, m.belt, -1.0 * kNormal[r], Cross(kNormal[r], kOnBelt));
  }
  foot.FinishMasses();
  auto& cable = island.Add<Cable>();
  cable.live = Num::Splat(1.0), cable.SetLine(Num::Splat(kBase), Num::Splat(kGain));
  cable.upper = Num::Splat(1.0), cable.link_count = 3, cable.links = island.Links(3);
  // The cable's rate of shortening: the rotor winds in, the ends approach each other.
  island.SetRow(cable.links[0], 0, m.rotor, {-kRadius, 0, 0}, {});
  island.SetRow(cable.links[1], 0, m.mass, kPull, {});
  island.SetRow(cable.links[2], 0, m.lever, -1.0 * kPull, Cross(kPull, {0.1, 0, 0.05}));
  cable.FinishMasses();
  island.Start();
}

}  // namespace taut::test
