/// Keys of DC motors (docs/theory/motor.md).
#pragma once

#include "description/yaml/keys.h"

namespace taut::description {

inline constexpr Bound kEfficiency{.least = 0.0, .most = 1.0, .above_least = true};

template <class Io>
void MotorFigureKeys(Io& io, Like<DcMotorDef> auto& m) {
  io("resistance_ohm", m.resistance_ohm, Bound::kPositive,
     "Winding resistance at `rated_temperature_c`.");
  io("torque_constant_n_m_per_a", m.torque_constant_n_m_per_a, Bound::kPositive,
     "Torque per current; equal to the back EMF per speed [V s/rad].");
  io("rotor_inertia_kg_m2", m.rotor_inertia_kg_m2, Bound::kPositive,
     "Inertia of the rotor and of all parts that turn with it.");
  io("friction_torque_n_m", m.friction_torque_n_m, Bound::kNonNegative,
     "Friction torque of a turning rotor, independent of its speed.");
  io("static_friction_torque_n_m", m.static_friction_torque_n_m, Bound::kNonNegative,
     "Breakaway torque of a rotor at rest, not below `friction_torque_n_m`. Assumed.");
  io("stribeck_speed_rad_per_s", m.stribeck_speed_rad_per_s, Bound::kPositive,
     "Rotor speed at which friction has fallen halfway from its static to its kinetic value. "
     "Assumed.");
  io("viscous_friction_n_m_s_per_rad", m.viscous_friction_n_m_s_per_rad, Bound::kNonNegative,
     "Additional friction torque per speed of the rotor.");
  io("gear_ratio", m.gear_ratio, Bound::kPositive,
     "Turns of the rotor per turn of the spool. Assumed.");
  io("gear_efficiency", m.gear_efficiency, kEfficiency,
     "Share of the motor's power that reaches the cable while winding in. If the cable drives the "
     "motor, the gear loses as much power as in the other direction: the share is 2 - 1 / "
     "efficiency. At efficiencies up to 0.5, the gear locks. Assumed.");
  io("backlash_rad", m.backlash_rad, Bound::kNonNegative,
     "Free rotation of the spool between two flanks of the gear.");
  io("spool_radius_m", m.spool_radius_m, Bound::kPositive,
     "Radius to the center line of the wound cable. Assumed.");
}

template <class Io>
void MotorSupplyKeys(Io& io, Like<DcMotorDef> auto& m) {
  io("driver_resistance_ohm", m.driver_resistance_ohm, Bound::kNonNegative,
     "Resistance of the driver's two conducting transistors.");
  io("supply", m.supply, kName,
     "Name of the power supply. Motors with the same name share one supply: the current of each "
     "motor lowers the voltage of all these motors. They must have equal `supply_voltage_v` and "
     "`supply_resistance_ohm`.");
  io("supply_voltage_v", m.supply_voltage_v, Bound::kPositive,
     "Voltage of the supply without load.");
  io("supply_resistance_ohm", m.supply_resistance_ohm, Bound::kNonNegative,
     "Resistance of the supply and its leads.");
}

template <class Io>
void MotorHeatKeys(Io& io, Like<DcMotorDef> auto& m) {
  io("rated_temperature_c", m.rated_temperature_c,
     "Winding temperature to which `resistance_ohm` refers.");
  io("ambient_temperature_c", m.ambient_temperature_c,
     "Temperature of the air, and of the motor at the start.");
  io("resistance_rise_per_k", m.resistance_rise_per_k, Bound::kNonNegative,
     "Relative rise of the winding's resistance per kelvin. The default is the value of copper.");
  io("winding_thermal_resistance_k_per_w", m.winding_thermal_resistance_k_per_w, Bound::kPositive,
     "Thermal resistance from the winding to the housing.");
  io("housing_thermal_resistance_k_per_w", m.housing_thermal_resistance_k_per_w, Bound::kPositive,
     "Thermal resistance from the housing to the air.");
  io("winding_thermal_time_s", m.winding_thermal_time_s, Bound::kPositive,
     "Time constant of the winding.");
  io("housing_thermal_time_s", m.housing_thermal_time_s, Bound::kPositive,
     "Time constant of the housing.");
}

template <class Io>
void Keys(Io& io, Like<DcMotorDef> auto& m) {
  io.Map("", "builder.cable.actuator.dc_motor",
         "Direct-current motor with gear, spool and driver (docs/theory/motor.md). The defaults, "
         "`dc_motor: {}`, are the values of a Faulhaber 1524T012SR; values that are not published "
         "are marked as assumed.",
         R"({"gear_ratio": 43, "gear_efficiency": 0.7, "spool_radius_m": 0.003})");
  MotorFigureKeys(io, m);
  MotorSupplyKeys(io, m);
  MotorHeatKeys(io, m);
  io("servo_gain_per_m", m.servo_gain_per_m, Bound::kNonNegative,
     "Servo gain for commanded rest lengths: duty per rest length error. Assumed.");
  io("servo_damping_s_per_m", m.servo_damping_s_per_m, Bound::kNonNegative,
     "Servo damping for commanded rest lengths: opposing duty per speed of the rest length. "
     "Assumed.");
}
void Check(const MapReader& map, DcMotorDef& motor);

}  // namespace taut::description
