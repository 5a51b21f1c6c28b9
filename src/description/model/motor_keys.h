/// The keys of a motor (docs/theory/motor.md).
#pragma once

#include "description/yaml/keys.h"

namespace taut::description {

inline constexpr Bound kEfficiency{.least = 0.0, .most = 1.0, .above_least = true};

template <class Io>
void MotorFigureKeys(Io& io, Like<DcMotorDef> auto& m) {
  io("resistance_ohm", m.resistance_ohm, Bound::kPositive,
     "Of the winding, at `rated_temperature_c`.");
  io("torque_constant_n_m_per_a", m.torque_constant_n_m_per_a, Bound::kPositive,
     "Torque per current; the back EMF per speed [V s/rad] is the same number.");
  io("rotor_inertia_kg_m2", m.rotor_inertia_kg_m2, Bound::kPositive,
     "Of the rotor, with what turns with it.");
  io("friction_torque_n_m", m.friction_torque_n_m, Bound::kNonNegative,
     "Of a rotor that turns, at any speed.");
  io("static_friction_torque_n_m", m.static_friction_torque_n_m, Bound::kNonNegative,
     "At which a rotor that stands breaks away; not below `friction_torque_n_m`. Assumed.");
  io("stribeck_speed_rad_per_s", m.stribeck_speed_rad_per_s, Bound::kPositive,
     "Speed of the rotor at which half of what friction at rest has more is gone. Assumed.");
  io("viscous_friction_n_m_s_per_rad", m.viscous_friction_n_m_s_per_rad, Bound::kNonNegative,
     "Friction per speed of the rotor, besides.");
  io("gear_ratio", m.gear_ratio, Bound::kPositive,
     "Turns of the rotor a turn of the spool. Assumed.");
  io("gear_efficiency", m.gear_efficiency, kEfficiency,
     "Share of the motor's power that reaches the cable when it winds in. When the cable drives "
     "the motor, the gear takes as much friction: a share of 2 - 1 / efficiency arrives, and at "
     "0.5 and less nothing, it locks. Assumed.");
  io("backlash_rad", m.backlash_rad, Bound::kNonNegative,
     "How far the spool is free to turn between two flanks of the gear.");
  io("spool_radius_m", m.spool_radius_m, Bound::kPositive,
     "To the middle of the wound cable. Assumed.");
}

template <class Io>
void MotorSupplyKeys(Io& io, Like<DcMotorDef> auto& m) {
  io("driver_resistance_ohm", m.driver_resistance_ohm, Bound::kNonNegative,
     "Of the driver's two transistors that conduct.");
  io("supply", m.supply, kName,
     "Name of its supply: the motors that name the same one share it, and what one of them draws "
     "lowers the voltage of all. They must say the same of it.");
  io("supply_voltage_v", m.supply_voltage_v, Bound::kPositive, "Of the supply, without load.");
  io("supply_resistance_ohm", m.supply_resistance_ohm, Bound::kNonNegative,
     "Of the supply and its leads.");
}

template <class Io>
void MotorHeatKeys(Io& io, Like<DcMotorDef> auto& m) {
  io("rated_temperature_c", m.rated_temperature_c, "At which `resistance_ohm` holds.");
  io("ambient_temperature_c", m.ambient_temperature_c,
     "Of the air, and of the motor at the start.");
  io("resistance_rise_per_k", m.resistance_rise_per_k, Bound::kNonNegative,
     "By how much of itself the resistance of the winding rises; copper's.");
  io("winding_thermal_resistance_k_per_w", m.winding_thermal_resistance_k_per_w, Bound::kPositive,
     "From the winding to the housing.");
  io("housing_thermal_resistance_k_per_w", m.housing_thermal_resistance_k_per_w, Bound::kPositive,
     "From the housing to the air.");
  io("winding_thermal_time_s", m.winding_thermal_time_s, Bound::kPositive,
     "Time constant of the winding.");
  io("housing_thermal_time_s", m.housing_thermal_time_s, Bound::kPositive,
     "Time constant of the housing.");
}

template <class Io>
void Keys(Io& io, Like<DcMotorDef> auto& m) {
  io.Map("", "builder.cable.actuator.dc_motor",
         "A direct-current motor with gear, spool and driver, docs/theory/motor.md. The defaults "
         "are those of a Faulhaber 1524T012SR, but for what is assumed because nobody has "
         "published it. `dc_motor: {}` is that motor.",
         R"({"gear_ratio": 43, "gear_efficiency": 0.7, "spool_radius_m": 0.003})");
  MotorFigureKeys(io, m);
  MotorSupplyKeys(io, m);
  MotorHeatKeys(io, m);
  io("servo_gain_per_m", m.servo_gain_per_m, Bound::kNonNegative,
     "Where a rest length is commanded: duty per length that is missing to it. Assumed.");
  io("servo_damping_s_per_m", m.servo_damping_s_per_m, Bound::kNonNegative,
     "Where a rest length is commanded: duty against the speed of the rest length. Assumed.");
}
void Check(const MapReader& map, DcMotorDef& motor);

}  // namespace taut::description
