/// Cables that come to lie against boxes and rods.
#pragma once

#include "tests/physics/world.h"

namespace taut::test {

inline BodyDef Ball(double mass_kg, const Vec3& p, const Vec3& velocity = {}) {
  BodyDef body;
  body.mass_kg = mass_kg;
  body.com_m = p;
  body.velocity_m_per_s = velocity;
  body.inertia_kg_m2 = {1e-4, 1e-4, 1e-4, 0, 0, 0};
  return body;
}

inline CableDef Cable(const AttachmentDef& from, const AttachmentDef& to, double stiffness,
                      double rest_length, double radius) {
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {from, to};
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = rest_length;
  cable.touches = CableTouches::kTerrain;
  cable.radius_m = radius;
  return cable;
}

inline TerrainBoxDef Box(const Vec3& low, const Vec3& high) {
  TerrainBoxDef box;
  box.name = "box";
  box.center_m = 0.5 * (low + high);
  box.half_extents_m = 0.5 * (high - low);
  return box;
}

/// A step in which a body goes somewhere, so slowly that nothing else happens.
inline constexpr double kStep = 1e-9;
inline void Lead(Batch& world, int body, const Vec3& p) {
  BodyState state = world.Body(0, body);
  state.velocity_m_per_s = (1 / kStep) * (p - state.position_m);
  world.SetBodyState(0, body, state);
}

/// A rod along y, as heavy as it takes to stay where it is.
inline void AddRod(ModelDef& def, const Vec3& center, double half_m, double radius_m,
                   double mass_kg = 1e9) {
  BodyDef body = Ball(mass_kg, center);
  const double across = mass_kg * half_m * half_m / 3, along = 0.5 * mass_kg * radius_m * radius_m;
  body.inertia_kg_m2 = {across, along, across, 0, 0, 0};
  def.bodies.push_back(body);
  CapsuleDef rod;
  rod.name = "rod";
  rod.body = static_cast<int>(def.bodies.size()) - 1;
  rod.from_m = center - Vec3{0, half_m, 0};
  rod.to_m = center + Vec3{0, half_m, 0};
  rod.radius_m = radius_m;
  def.capsules.push_back(rod);
}

/// Two ends that are led, and a rod at the origin.
inline ModelDef OverARod(const Vec3& from, const Vec3& to, double radius_m, double cable_radius_m) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {Ball(1, from), Ball(1, to)};
  def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, cable_radius_m)};
  def.cables[0].touches = CableTouches::kRods;
  AddRod(def, {}, 0.3, radius_m - cable_radius_m);
  return def;
}

/// NTRT's MuscleNP, where momentum falls to 0.86 of what it was.
inline ModelDef Flight() {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {Ball(0.3927, {0, 0.3, 4}, {1, 0.1, 0}), Ball(0.5, {0.1, -0.2, 12}, {0.8, 0, 0.1})};
  AddRod(def, {1.5, 0, 8}, 1.0, 0.25, 0.4);
  def.cables = {Cable({0, {0, 0.3, 4}}, {1, {0.1, -0.2, 12}}, 1000, 0, 0.001)};
  def.cables[0].rest_length_m = Distance({0, 0.3, 4}, {0.1, -0.2, 12});
  def.cables[0].touches = CableTouches::kRods;
  return def;
}

}  // namespace taut::test
