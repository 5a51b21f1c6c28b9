/// Scenes for the tests of motors: motors that wind a cable between two fixed points, or a weight.
#pragma once

#include <cmath>

#include "tests/physics/world.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {

/// Returns a motor with the parameters of the data sheet only: without stiction, gear losses,
/// supply resistance and temperature dependence of the winding's resistance.
inline DcMotorDef PlainMotor() {
  DcMotorDef motor;
  motor.friction_torque_n_m = motor.static_friction_torque_n_m = 0;
  motor.gear_efficiency = 1;
  motor.driver_resistance_ohm = 0;
  motor.resistance_rise_per_k = 0;
  return motor;
}

inline void Wind(CableDef& cable, const DcMotorDef& motor) {
  cable.actuator.kind = ActuatorDef::Kind::kDcMotor;
  cable.actuator.dc_motor = motor;
}

/// Returns a motor on a cable between two fixed points, 1 m apart, with a rest length of `rest_m`.
inline ModelDef MotorAlone(const DcMotorDef& motor, double rest_m = 100,
                           double stiffness_n_per_m = 1000) {
  ModelDef def;
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{kWorld, {0, 0, 0}}, {kWorld, {1, 0, 0}}};
  cable.stiffness_n_per_m = stiffness_n_per_m;
  cable.rest_length_m = rest_m;
  Wind(cable, motor);
  def.cables.push_back(cable);
  return def;
}

/// Returns a weight that hangs at rest on a motor.
inline scenes::HangingMass Weight(double mass_kg, double stiffness_n_per_m,
                                  double damping_n_s_per_m = 0) {
  scenes::HangingMass scene;
  scene.mass_kg = mass_kg;
  scene.stiffness_n_per_m = stiffness_n_per_m;
  scene.damping_n_s_per_m = damping_n_s_per_m;
  scene.length_m = 1 + scene.sag_m();
  return scene;
}
inline ModelDef MotorWithWeight(const DcMotorDef& motor, const scenes::HangingMass& scene) {
  ModelDef def = scene.Def();
  Wind(def.cables[0], motor);
  return def;
}

inline double Way(const DcMotorDef& motor) { return motor.spool_radius_m / motor.gear_ratio; }

}  // namespace taut::test
