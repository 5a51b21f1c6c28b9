/// A plate on three feet, for contact tests.
#pragma once

#include <cmath>
#include <string>

#include "tests/peers/peers_robots.h"

namespace taut::test {

/// Returns a sled with friction 0.5 that moves in the direction `heading_rad`, or is at rest.
inline ModelDef Sled(double speed_m_per_s = 0, double heading_rad = 0) {
  ModelDef def;
  def.name = "sled";
  BodyDef body;
  body.name = "plate";
  body.mass_kg = 1;
  body.com_m = {0, 0, 0.02};
  body.inertia_kg_m2 = {.xx = 0.02, .yy = 0.02, .zz = 0.04};
  body.velocity_m_per_s = {speed_m_per_s * std::cos(heading_rad),
                           speed_m_per_s * std::sin(heading_rad), 0};
  def.bodies.push_back(body);
  const Material material{0.5, 0.5, 0.0};
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * 3.14159265358979323846 / 3 * i;
    const Vec3 at{0.3 * std::cos(a), 0.3 * std::sin(a), 0.01};
    def.spheres.push_back({"foot_" + std::to_string(i), 0, at, 0.01, material});
  }
  def = OnGround(def);
  def.planes[0].material = material;
  return def;
}

/// Returns the sled at rest with two long soft cables, one up and one down, that exert a couple of
/// 0.2 N m about y and no force.
inline ModelDef Turned(ModelDef def) {
  for (const double side : {1.0, -1.0}) {
    const Vec3 at{-0.1 * side, 0, 0.02};
    CableDef cable;
    cable.name = side > 0 ? "up" : "down";
    cable.attachments = {{0, at}, {kWorld, {at.x, 0, 0.02 + side}}};
    cable.stiffness_n_per_m = 2;
    cable.rest_length_m = 0.5;
    def.cables.push_back(cable);
  }
  return def;
}
inline constexpr double kCoupleNm = 0.2;

}  // namespace taut::test
