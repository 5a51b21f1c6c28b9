/// Scenes of cable wrapping on boxes and rods.
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

/// Step [s] in which a body is moved to a point, so short that nothing else changes.
inline constexpr double kStep = 1e-9;
inline void Lead(WorldBatch& world, int body, const Vec3& p) {
  BodyState state = world.Body(0, body);
  state.velocity_m_per_s = (1 / kStep) * (p - state.position_m);
  world.SetBodyState(0, body, state);
}

/// Adds a rod along y; the default mass keeps it in place.
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

/// Returns two guided ends of a cable, and a rod at the origin.
inline ModelDef OverARod(const Vec3& from, const Vec3& to, double radius_m, double cable_radius_m) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  def.bodies = {Ball(1, from), Ball(1, to)};
  def.cables = {Cable({0, from}, {1, to}, 1e-9, 0.1, cable_radius_m)};
  def.cables[0].touches = CableTouches::kRods;
  AddRod(def, {}, 0.3, radius_m - cable_radius_m);
  return def;
}

/// Returns a massive rod, whose axis is a unit vector.
inline BodyDef RodOf(double mass_kg, const Vec3& center, const Vec3& axis, double half_m,
                     double radius_m) {
  BodyDef body = Ball(mass_kg, center);
  const double along = 0.5 * mass_kg * radius_m * radius_m;
  const double across = 0.5 * along + mass_kg * half_m * half_m / 3, more = along - across;
  const Vec3& u = axis;
  body.inertia_kg_m2 = {across + more * u.x * u.x, across + more * u.y * u.y,
                        across + more * u.z * u.z, more * u.x * u.y,
                        more * u.x * u.z,          more * u.y * u.z};
  return body;
}

/// Returns two balls that fly with a cable of 1.1 m between them into free rods across their path,
/// five in a layer. No other forces act, and the rods pass through each other.
inline ModelDef AcrossFreeRods(int rods, double stiffness_n_per_m) {
  constexpr double kRodKg = 0.2, kHalfM = 0.5, kRadiusM = 0.004;
  ModelDef def;
  def.gravity_m_per_s2 = {};
  for (int i = 0; i < rods; ++i) {
    const int place = i % 5, layer = i / 5;
    AddRod(def, {0.1 * place - 0.2, 0, 0.1 * layer - 0.15}, kHalfM, kRadiusM, kRodKg);
    for (int j = 0; j < i; ++j) def.apart.push_back({j, i});
  }
  const Vec3 from{-0.6, 0, -0.6}, to{0.6, 0.1, -0.6};
  def.bodies.push_back(Ball(0.5, from, {0, 0, 12}));
  def.bodies.push_back(Ball(0.5, to, {0, 0, 10}));
  def.cables = {Cable({rods, from}, {rods + 1, to}, stiffness_n_per_m, 1.1, 0.001)};
  def.cables[0].touches = CableTouches::kRods;
  return def;
}

/// Returns NTRT's scene MuscleNP, rotated by 45 degrees about y: a rod and a box fly with a cable
/// of 8 m between them into a third rod. In NTRT the momentum falls to 0.86 of its initial value.
inline ModelDef MuscleNp() {
  const double share = std::sqrt(0.5), rod_kg = 0.3927, box_kg = 0.5, side_m = 0.5, long_m = 2;
  const Vec3 across{share, 0, -share}, ahead{share, 0, share}, up{0, 1, 0};
  ModelDef def;
  def.gravity_m_per_s2 = {};
  BodyDef box = Ball(box_kg, {0, 13, 0});
  const double wide = box_kg * (side_m * side_m + long_m * long_m) / 12;
  box.inertia_kg_m2 = {wide, box_kg * side_m * side_m / 6, wide, 0, 0, 0};
  def.bodies = {RodOf(rod_kg, {0, 3, 0}, up, 1, 0.25), box,
                RodOf(rod_kg, 5.0 * ahead + 8.0 * up, across, 1, 0.25)};
  const double push_n_s = std::sqrt(0.32);  // 0.4 along x and along z
  def.bodies[0].velocity_m_per_s = (push_n_s / rod_kg) * ahead;
  def.bodies[1].velocity_m_per_s = (push_n_s / box_kg) * ahead;
  CapsuleDef rod;
  rod.name = "rod";
  rod.body = 2;
  rod.from_m = def.bodies[2].com_m - across;
  rod.to_m = def.bodies[2].com_m + across;
  rod.radius_m = 0.25;
  def.capsules = {rod};
  def.cables = {Cable({0, {0, 4, 0}}, {1, {0, 12, 0}}, 1000, 8, 0.001)};
  def.cables[0].touches = CableTouches::kRods;
  return def;
}

/// Returns a similar, oblique scene.
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
