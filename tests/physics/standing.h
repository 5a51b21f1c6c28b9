/// Robots that stand with fixed rest lengths, and a check that they do not creep.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/prism3.h"
#include "tests/scenes/six_strut.h"
#include "tests/scenes/tetraspine3.h"

namespace taut::test {

/// Returns a standing robot. Every contact has a friction coefficient of 0.5, on both sides.
inline ModelDef Standing(const std::string& robot) {
  const Material material{0.5, 0.5, 0};
  ModelDef def;
  if (robot == "tetraspine3") {
    scenes::Tetraspine scene;
    scene.material = scene.ground = {0.5, 0.5, 0};
    def = scene.Def();
    def.friction_combine = CombineRule::kGeometricMean;
    return def;
  }
  if (robot == "six_strut") {
    // It stands on the triangle of three rod ends, the (1, 1, 1) corner down.
    scenes::SixStrut scene;
    scene.damping_n_s_per_m = 20;
    scene.orientation = scenes::Turn({std::sqrt(0.5), -std::sqrt(0.5), 0},
                                     std::numbers::pi - std::atan(std::sqrt(2.0)));
    double lowest = 1;
    for (const NodeDef& node : scene.Def().nodes) lowest = std::min(lowest, node.position_m.z);
    scene.center_m.z -= lowest - scene.rod_radius_m - 0.0005;
    def = scene.Def();
  } else {
    scenes::Prism3 scene;
    scene.clearance_m = 0.0005;
    scene.damping_n_s_per_m = 5;
    def = scene.Def();
  }
  scenes::AddGround(def, material);
  return def;
}

/// Settles for 20 s on ground tilted by `slope_deg` (by a tilt of gravity), then stands for
/// `time_s`; checks that no node creeps by more than 1e-9 m/s.
inline void StandsStill(const std::string& robot, double slope_deg, double time_s) {
  const double slope = slope_deg * std::numbers::pi / 180, h = 1e-3;
  const ModelDef def = Standing(robot);
  WorldBatch world = MakeBatch(def);
  world.SetParameter(0, Parameter::kGravityX, 0, 9.81 * std::sin(slope));
  world.SetParameter(0, Parameter::kGravityZ, 0, -9.81 * std::cos(slope));
  world.Step(h, StepsIn(20, h));
  const int nodes = static_cast<int>(def.nodes.size());
  std::vector<Vec3> start;
  for (int node = 0; node < nodes; ++node) start.push_back(world.NodePosition(0, node));
  ASSERT_GE(world.Contacts(0).size(), 3u) << "it stands on the ground";
  world.Step(h, StepsIn(time_s, h));
  double creep = 0, speed = 0;
  for (int node = 0; node < nodes; ++node) {
    const Vec3 way = world.NodePosition(0, node) - start[static_cast<std::size_t>(node)];
    creep = std::max(creep, Norm(way) / time_s);
    speed = std::max(speed, Norm(world.NodeVelocity(0, node)));
  }
  EXPECT_LT(creep, 1e-9) << robot << " at " << slope_deg << " degrees";
  EXPECT_LT(speed, 1e-9) << robot << " at " << slope_deg << " degrees";
  EXPECT_EQ(world.Status(0).bits, kStatusOk) << robot << " at " << slope_deg << " degrees";
}

inline constexpr const char* kRobots[] = {"tetraspine3", "six_strut", "prism3"};

}  // namespace taut::test
