/// Direct-current motor with gear, spool and driver that winds a cable: parameters and state
/// (docs/theory/motor.md). Plain data.
#pragma once

#include <string>

namespace taut {

/// Parameters of a motor. Defaults: Faulhaber 1524T012SR, from its data sheet. Values marked [?]
/// are assumptions, because they are not published for the robot Tetraspine3.
struct DcMotorDef {
  // --- the motor ---
  double resistance_ohm = 19.8;               ///< Winding resistance at `rated_temperature_c`, > 0.
  double torque_constant_n_m_per_a = 0.0115;  ///< Also the back-EMF constant [V s/rad], > 0.
  double rotor_inertia_kg_m2 = 5.6e-8;  ///< Rotor, gear and spool, reflected to the rotor, > 0.
  double friction_torque_n_m = 8e-5;    ///< Coulomb friction of rotor and brushes, >= 0.
  /// [?] Breakaway torque, >= `friction_torque_n_m`.
  double static_friction_torque_n_m = 1.2e-4;
  /// [?] Stribeck speed: half of the excess over `friction_torque_n_m` remains, > 0.
  double stribeck_speed_rad_per_s = 10.0;
  double viscous_friction_n_m_s_per_rad = 0.0;  ///< Friction torque per rotor speed, >= 0.

  // --- gear and spool ---
  double gear_ratio = 76.0;  ///< [?] Turns of the rotor per turn of the spool, > 0.
  /// [?] Fraction of the motor's power that reaches the cable, 0..1.
  double gear_efficiency = 0.66;
  double backlash_rad = 0.0;        ///< [?] Free play of the spool, >= 0.
  double spool_radius_m = 5.17e-3;  ///< [?] Radius to the center line of the wound cable, > 0.

  // --- driver and supply ---
  double driver_resistance_ohm = 0.45;  ///< Sum of both conducting transistors, >= 0.
  /// Name of the supply. Motors with the same name share one supply, whose voltage drops with the
  /// sum of their currents. Their supply voltages and supply resistances must be equal.
  std::string supply = "supply";
  double supply_voltage_v = 12.0;      ///< Open-circuit voltage, > 0.
  double supply_resistance_ohm = 0.0;  ///< [?] Resistance of supply and leads, >= 0.

  // --- heat ---
  double rated_temperature_c = 22.0;       ///< Temperature at which `resistance_ohm` holds.
  double ambient_temperature_c = 22.0;     ///< Also the initial temperature of winding and housing.
  double resistance_rise_per_k = 3.93e-3;  ///< Relative rise; default: copper; >= 0.
  double winding_thermal_resistance_k_per_w = 10.0;  ///< From winding to housing, > 0.
  double housing_thermal_resistance_k_per_w = 29.0;  ///< From housing to air, > 0.
  double winding_thermal_time_s = 5.6;               ///< Time constant, > 0.
  double housing_thermal_time_s = 220.0;             ///< Time constant, > 0.

  // --- rest length servo: duty = gain (L - target) + damping dL/dt ---
  double servo_gain_per_m = 4000.0;     ///< [?] Duty per rest length error, >= 0.
  double servo_damping_s_per_m = 30.0;  ///< [?] Duty per rest length rate, >= 0.

  bool operator==(const DcMotorDef&) const = default;
};

/// Control mode of a motor.
enum class MotorMode : unsigned char {
  kServo,  ///< A servo computes the duty from the rest length and its target.
  kDuty,   ///< `WorldBatch::SetDuty` sets the duty. A duty of 0 shorts the winding (brake).
  kOff,    ///< The driver is off, so no current flows.
};

/// State of a motor at the current time. Currents, voltages and duty are averages over the last
/// step.
struct MotorState {
  MotorMode mode = MotorMode::kServo;
  /// -1..1, or slightly beyond if a servo saturates; > 0 winds in.
  double duty = 0.0;
  double voltage_v = 0.0;  ///< Duty times supply voltage.
  double current_a = 0.0;  ///< Winding current; > 0 winds in.
  /// Angle without wrapping; 0 at the rest length of the model; increases while winding in.
  double rotor_angle_rad = 0.0;
  double rotor_speed_rad_per_s = 0.0;  ///< Rotor speed; > 0 winds in.
  double winding_temperature_c = 0.0;
  double housing_temperature_c = 0.0;
  double supply_voltage_v = 0.0;  ///< Voltage of the supply under the load of all its motors.
  double backlash_m = 0.0;        ///< Lag of the spool behind the gear, as a length of cable.
  /// Since the start; decreases while the motor feeds the supply.
  double energy_from_supply_j = 0.0;
  double energy_to_cable_j = 0.0;  ///< Since the start; decreases while the cable drives the motor.
  double energy_in_winding_j = 0.0;  ///< Heat in the winding since the start.
};

}  // namespace taut
