/// Scenes of rods on joints, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/rod_chain.h"

namespace taut::test {

/// Returns a thin rod of 1 m and 1 kg that hangs from the world at its upper end, rotated from the
/// vertical.
inline ModelDef Pendulum(double angle_rad, JointKind kind = JointKind::kBall) {
  ModelDef def;
  const Vec3 end{std::sin(angle_rad), 0, -std::cos(angle_rad)};
  scenes::AddRod(def, "rod", 1.0, 1e-3, {}, end, {});
  JointDef pin;
  pin.name = "pin", pin.kind = kind, pin.body_b = 0;
  pin.axis = {0, 1, 0};
  def.joints.push_back(pin);
  return def;
}

/// Returns rods of 0.1 m in a row from the origin along `step`, the first of them pinned there.
inline ModelDef Chain(int rods, const Vec3& step_m, double last_mass_kg) {
  return scenes::RodChain(rods, step_m, last_mass_kg);
}
inline double WorstGap(const WorldBatch& world, const ModelDef& def) {
  double gap = 0;
  for (int i = 0; i < static_cast<int>(def.joints.size()); ++i) {
    gap = std::max(gap, world.Joint(0, i).gap_m);
  }
  return gap;
}

}  // namespace taut::test
