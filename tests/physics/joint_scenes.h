/// Rods on joints, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/rod.h"
#include "tests/physics/world.h"

namespace taut::test {

inline constexpr double kPi = 3.14159265358979323846, kG = 9.81;

/// A thin rod of 1 m and 1 kg that hangs from the world at its upper end, turned out of the plumb.
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

/// Rods of 0.1 m in a row from the origin along `step`, the first of them pinned there.
inline ModelDef Chain(int rods, const Vec3& step_m, double last_mass_kg) {
  ModelDef def;
  Vec3 at;
  for (int i = 0; i < rods; ++i) {
    const std::string number = std::to_string(i);
    const double mass = i + 1 == rods ? last_mass_kg : 1.0;
    scenes::AddRod(def, "rod" + number, mass, 0.01, at, at + step_m, {});
    def.capsules.back().collides = false;
    JointDef joint;
    joint.name = "joint" + number, joint.body_a = i - 1, joint.body_b = i;
    joint.from_m = joint.to_m = at;
    def.joints.push_back(joint);
    at = at + step_m;
  }
  return def;
}
inline double WorstGap(const Batch& world, const ModelDef& def) {
  double gap = 0;
  for (int i = 0; i < static_cast<int>(def.joints.size()); ++i) {
    gap = std::max(gap, world.Joint(0, i).gap_m);
  }
  return gap;
}

}  // namespace taut::test
