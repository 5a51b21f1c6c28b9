/// Robots for comparisons between taut and other engines, from the files of share/models/.
#pragma once

#include <ostream>
#include <stdexcept>
#include <string>

#include "benchmarks/peers/settings.h"
#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut::peers {

inline void PrintTo(Engine engine, std::ostream* out) { *out << Name(engine); }
inline void PrintTo(const Setting& setting, std::ostream* out) {
  *out << Name(setting.engine) << ' ' << setting.name;
}

}  // namespace taut::peers

namespace taut::test {

inline ModelDef Robot(const std::string& name, const Overrides& overrides = {}) {
  Diagnostics complaints;
  const auto robot =
      LoadRobot(TAUT_SOURCE_DIR "/share/models/" + name + ".yaml", overrides, complaints);
  if (!robot) throw std::runtime_error(complaints.Format());
  return robot->def;
}

/// Returns the model on a floor like in the shipped experiments.
inline ModelDef OnGround(ModelDef def) {
  PlaneDef ground;
  ground.name = "ground";
  ground.material = {0.5, 0.5, 0.0};
  def.planes = {ground};
  return def;
}

/// Returns the model in empty space without gravity, each body with a different small velocity, so
/// that the robot oscillates in all its modes and drifts and rotates as a whole.
inline ModelDef Swinging(ModelDef def, double speed_m_per_s, double spin_rad_per_s) {
  def.planes.clear();
  def.gravity_m_per_s2 = {0, 0, 0};
  for (std::size_t i = 0; i < def.bodies.size(); ++i) {
    // arbitrary numbers, different for each body
    const double a = 1.0 + 2.4 * static_cast<double>(i);
    def.bodies[i].velocity_m_per_s = {speed_m_per_s * (a - 3), speed_m_per_s * (2 - a * a / 9),
                                      speed_m_per_s * (1 / a)};
    def.bodies[i].angular_velocity_rad_per_s = {spin_rad_per_s / a, spin_rad_per_s * (a / 5 - 1),
                                                spin_rad_per_s * (1 - 3 / (1 + a))};
  }
  return def;
}

/// Returns the model held by two of its nodes between ceiling and floor, with lunar gravity: under
/// terrestrial gravity, some cables of these robots go slack.
inline ModelDef Moored(ModelDef def) {
  def.gravity_m_per_s2 = {0, 0, -1.62};
  double mass_kg = 0;
  for (const BodyDef& body : def.bodies) mass_kg += body.mass_kg;
  for (const NodeDef* node : {&def.nodes.front(), &def.nodes.back()}) {
    for (const double side_m : {1.0, -1.0}) {
      const Vec3& p = node->position_m;
      CableDef cable;
      cable.name = (side_m > 0 ? "ceiling_to_" : "floor_to_") + node->name;
      cable.attachments = {{kWorld, {p.x, p.y, p.z + side_m}}, {node->body, p}};
      cable.stiffness_n_per_m = 50 * mass_kg;
      cable.damping_n_s_per_m = mass_kg;
      cable.rest_length_m = 0.9;
      def.cables.push_back(cable);
    }
  }
  return def;
}

}  // namespace taut::test
