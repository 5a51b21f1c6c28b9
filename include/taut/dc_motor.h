/// A direct-current motor with gear, spool and driver that winds a cable: its figures, and what it
/// does at a moment (docs/theory/motor.md). Plain data.
#pragma once

#include <string>

namespace taut {

/// The figures of a motor. The defaults are those of a Faulhaber 1524T012SR: its data sheet's, but
/// for what is marked [?], which nobody has published for Tetraspine3 and is assumed.
struct DcMotorDef {
  // --- the motor ---
  double resistance_ohm = 19.8;               ///< Of the winding, at `rated_temperature_c`, > 0.
  double torque_constant_n_m_per_a = 0.0115;  ///< Also the back EMF per speed [V s/rad], > 0.
  double rotor_inertia_kg_m2 = 5.6e-8;        ///< > 0; gear and spool, seen from the rotor, too.
  double friction_torque_n_m = 8e-5;          ///< Coulomb's, of rotor and brushes, >= 0.
  /// [?] Breaks away at this torque, >= `friction_torque_n_m`.
  double static_friction_torque_n_m = 1.2e-4;
  /// [?] At this speed half of what is above `friction_torque_n_m` is gone, > 0.
  double stribeck_speed_rad_per_s = 10.0;
  double viscous_friction_n_m_s_per_rad = 0.0;  ///< >= 0.

  // --- gear and spool ---
  double gear_ratio = 76.0;         ///< [?] Turns of the rotor a turn of the spool, > 0.
  double gear_efficiency = 0.66;    ///< [?] Of the power that the motor gives to the cable, 0..1.
  double backlash_rad = 0.0;        ///< [?] Free way of the spool between two flanks, >= 0.
  double spool_radius_m = 5.17e-3;  ///< [?] To the middle of the wound cable, > 0.

  // --- driver and supply ---
  double driver_resistance_ohm = 0.45;  ///< Of the two transistors that conduct, >= 0.
  /// Motors that name the same supply share it: its voltage sags by the sum of their currents.
  /// Their figures of it must be the same.
  std::string supply = "supply";
  double supply_voltage_v = 12.0;      ///< Without load, > 0.
  double supply_resistance_ohm = 0.0;  ///< [?] Of source and leads, >= 0.

  // --- heat ---
  double rated_temperature_c = 22.0;                 ///< At which `resistance_ohm` holds.
  double ambient_temperature_c = 22.0;               ///< Where winding and housing start, too.
  double resistance_rise_per_k = 3.93e-3;            ///< Copper's, >= 0.
  double winding_thermal_resistance_k_per_w = 10.0;  ///< To the housing, > 0.
  double housing_thermal_resistance_k_per_w = 29.0;  ///< To the air, > 0.
  double winding_thermal_time_s = 5.6;               ///< > 0.
  double housing_thermal_time_s = 220.0;             ///< > 0.

  // --- the servo that follows a rest length: duty = gain (L - target) + damping dL/dt ---
  double servo_gain_per_m = 4000.0;     ///< [?] Duty per length, >= 0.
  double servo_damping_s_per_m = 30.0;  ///< [?] Duty per speed, >= 0.

  bool operator==(const DcMotorDef&) const = default;
};

/// What moves a motor.
enum class MotorMode : unsigned char {
  kServo,  ///< The duty follows from the rest length and its target.
  kDuty,   ///< `Batch::SetDuty` said it. 0 shorts the winding: a brake.
  kOff,    ///< The driver is off: no current.
};

/// A motor at the current time. Currents, voltages and duty are means over the last step.
struct MotorState {
  MotorMode mode = MotorMode::kServo;
  double duty = 0.0;       ///< -1..1, by a little more where a servo comes to an end; > 0 winds in.
  double voltage_v = 0.0;  ///< duty times the supply's.
  double current_a = 0.0;  ///< In the winding; positive winds in.
  double rotor_angle_rad = 0.0;  ///< Not wrapped; 0 at the model's rest length; rises winding in.
  double rotor_speed_rad_per_s = 0.0;  ///< Positive winds in.
  double winding_temperature_c = 0.0;  ///<
  double housing_temperature_c = 0.0;  ///<
  double supply_voltage_v = 0.0;       ///< With the load of all its motors.
  double backlash_m = 0.0;             ///< How far the spool lags behind the gear, as rest length.
  double energy_from_supply_j = 0.0;   ///< Since the start; falls while it feeds others.
  double energy_to_cable_j = 0.0;      ///< Since the start; falls while the cable drives it.
  double energy_in_winding_j = 0.0;    ///< Heat, since the start.
};

}  // namespace taut
