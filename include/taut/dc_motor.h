/// Direct-current motor with gear, spool and driver that winds a cable: parameters and state
/// (docs/theory/motor.md). Plain data.
#pragma once

#include <string>

namespace taut {

/// Parameters of a motor. Defaults: a Faulhaber 1524T012SR, from its data sheet. Values marked [?]
/// are assumed; they are unpublished for Tetraspine3.
struct DcMotorDef {
  // --- the motor ---
  double resistance_ohm = 19.8;               ///< Winding, at `rated_temperature_c`, > 0.
  double torque_constant_n_m_per_a = 0.0115;  ///< Also back EMF per speed [V s/rad], > 0.
  double rotor_inertia_kg_m2 = 5.6e-8;  ///< Includes gear and spool, seen from the rotor, > 0.
  double friction_torque_n_m = 8e-5;    ///< Coulomb friction of rotor and brushes, >= 0.
  /// [?] Breakaway torque, >= `friction_torque_n_m`.
  double static_friction_torque_n_m = 1.2e-4;
  /// [?] Speed at which half of the excess over `friction_torque_n_m` is gone, > 0.
  double stribeck_speed_rad_per_s = 10.0;
  double viscous_friction_n_m_s_per_rad = 0.0;  ///< >= 0.

  // --- gear and spool ---
  double gear_ratio = 76.0;       ///< [?] Turns of the rotor per turn of the spool, > 0.
  double gear_efficiency = 0.66;  ///< [?] Share of the motor's power that reaches the cable, 0..1.
  double backlash_rad = 0.0;      ///< [?] Free travel of the spool between two flanks, >= 0.
  double spool_radius_m = 5.17e-3;  ///< [?] To the center line of the wound cable, > 0.

  // --- driver and supply ---
  double driver_resistance_ohm = 0.45;  ///< Of the two conducting transistors, >= 0.
  /// Name of the supply. Motors with the same name share it: its voltage sags by the sum of their
  /// currents. Their supply voltages and resistances must be equal.
  std::string supply = "supply";
  double supply_voltage_v = 12.0;      ///< Without load, > 0.
  double supply_resistance_ohm = 0.0;  ///< [?] Source and leads, >= 0.

  // --- heat ---
  double rated_temperature_c = 22.0;       ///< Reference of `resistance_ohm`.
  double ambient_temperature_c = 22.0;     ///< Also the initial winding and housing temperature.
  double resistance_rise_per_k = 3.93e-3;  ///< Copper, >= 0.
  double winding_thermal_resistance_k_per_w = 10.0;  ///< To the housing, > 0.
  double housing_thermal_resistance_k_per_w = 29.0;  ///< To the air, > 0.
  double winding_thermal_time_s = 5.6;               ///< > 0.
  double housing_thermal_time_s = 220.0;             ///< > 0.

  // --- rest length servo: duty = gain (L - target) + damping dL/dt ---
  double servo_gain_per_m = 4000.0;     ///< [?] Duty per length, >= 0.
  double servo_damping_s_per_m = 30.0;  ///< [?] Duty per speed, >= 0.

  bool operator==(const DcMotorDef&) const = default;
};

/// Control mode of a motor.
enum class MotorMode : unsigned char {
  kServo,  ///< The duty follows from the rest length and its target.
  kDuty,   ///< The duty is set by `WorldBatch::SetDuty`. 0 shorts the winding: a brake.
  kOff,    ///< The driver is off: no current.
};

/// State of a motor at the current time. Currents, voltages and duty are means over the last step.
struct MotorState {
  MotorMode mode = MotorMode::kServo;
  /// -1..1, slightly beyond where a servo reaches the end of its range; > 0 winds in.
  double duty = 0.0;
  double voltage_v = 0.0;  ///< Duty times supply voltage.
  double current_a = 0.0;  ///< Winding current; positive winds in.
  /// Not wrapped; 0 at the model's rest length; increases while winding in.
  double rotor_angle_rad = 0.0;
  double rotor_speed_rad_per_s = 0.0;  ///< Positive winds in.
  double winding_temperature_c = 0.0;
  double housing_temperature_c = 0.0;
  double supply_voltage_v = 0.0;      ///< Under the load of all its motors.
  double backlash_m = 0.0;            ///< Lag of the spool behind the gear, as rest length.
  double energy_from_supply_j = 0.0;  ///< Since the start; decreases while it feeds others.
  double energy_to_cable_j = 0.0;     ///< Since the start; decreases while the cable drives it.
  double energy_in_winding_j = 0.0;   ///< Heat since the start.
};

}  // namespace taut
