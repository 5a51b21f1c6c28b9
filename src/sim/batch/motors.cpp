/// DC motors: tables of a model, commands and readings of a batch. dc_motor.inl contains the law of
/// the motors.

#include <algorithm>

#include "sim/batch/batch_impl.h"

namespace taut {
namespace sim {
namespace {

/// Returns the number of the supply of a motor. A new name adds a supply.
int SupplyOf(const DcMotorDef& def, std::vector<std::string>& names, Tables& tables) {
  const auto known = std::find(names.begin(), names.end(), def.supply);
  if (known != names.end()) return static_cast<int>(known - names.begin());
  names.push_back(def.supply);
  tables.supplies.push_back({def.supply_voltage_v, def.supply_resistance_ohm});
  return static_cast<int>(names.size()) - 1;
}

MotorTable TableOf(const DcMotorDef& def) {
  MotorTable t;
  t.way_m = def.spool_radius_m / def.gear_ratio;
  t.inv_inertia = 1.0 / def.rotor_inertia_kg_m2;
  t.constant = def.torque_constant_n_m_per_a;
  t.winding_ohm = def.resistance_ohm;
  t.driver_ohm = def.driver_resistance_ohm;
  t.rise_per_k = def.resistance_rise_per_k;
  t.rated_c = def.rated_temperature_c;
  t.ambient_c = def.ambient_temperature_c;
  t.friction = def.friction_torque_n_m;
  t.static_more = def.static_friction_torque_n_m - def.friction_torque_n_m;
  t.inv_stribeck2 = 1.0 / (def.stribeck_speed_rad_per_s * def.stribeck_speed_rad_per_s);
  t.viscous = def.viscous_friction_n_m_s_per_rad;
  t.gear_loss = 1.0 / def.gear_efficiency - 1.0;
  t.backlash_m = def.backlash_rad * def.spool_radius_m;
  t.winding_w_per_k = 1.0 / def.winding_thermal_resistance_k_per_w;
  t.housing_w_per_k = 1.0 / def.housing_thermal_resistance_k_per_w;
  t.winding_k_per_j = def.winding_thermal_resistance_k_per_w / def.winding_thermal_time_s;
  t.housing_k_per_j = def.housing_thermal_resistance_k_per_w / def.housing_thermal_time_s;
  t.servo_gain = def.servo_gain_per_m;
  t.servo_damping = def.servo_damping_s_per_m;
  return t;
}

}  // namespace

void LayOutMotors(Tables& tables) {
  std::vector<std::string> supplies;
  for (std::size_t c = 0; c < tables.cables.size(); ++c) {
    const ActuatorDef& actuator = tables.def().cables[c].actuator;
    if (actuator.kind != ActuatorDef::Kind::kDcMotor) continue;
    tables.cables[c].motor = static_cast<int>(tables.motors.size());
    MotorTable table = TableOf(*actuator.dc_motor);
    table.cable = static_cast<int>(c);
    table.supply = SupplyOf(*actuator.dc_motor, supplies, tables);
    table.min_rest_m = actuator.min_rest_length_m;
    tables.motors.push_back(table);
  }
}

}  // namespace sim

void WorldBatch::Impl::Order(int world, int motor, double sim::MotorOrders<double>::*order,
                             double value) const noexcept {
  sim::MotorOrders<double> now = orders(world, motor);
  now.*order = value;
  set(world, layout.orders + sim::kWidthOrders * motor, now);
}

void WorldBatch::Impl::StopMotor(int world, int cable) const noexcept {
  const int number = view.cables[cable].motor;
  if (number < 0) return;
  sim::MotorNumbers<double> now = motor(world, number);
  now.speed = now.gap = 0.0;
  set(world, layout.motor + sim::kWidthMotor * number, now);
}

void WorldBatch::SetDuty(int world, int cable, double duty) noexcept {
  const int motor = impl_->CheckMotor(__func__, world, cable);
  impl_->Order(world, motor, &sim::MotorOrders<double>::duty, std::clamp(duty, -1.0, 1.0));
  impl_->Order(world, motor, &sim::MotorOrders<double>::by_duty, 1.0);
}

void WorldBatch::SetMotorEnabled(int world, int cable, bool enabled) noexcept {
  const int motor = impl_->CheckMotor(__func__, world, cable);
  impl_->Order(world, motor, &sim::MotorOrders<double>::on, enabled ? 1.0 : 0.0);
}

MotorState WorldBatch::Motor(int world, int cable) const noexcept {
  const Impl& d = *impl_;
  const int number = d.CheckMotor(__func__, world, cable);
  const sim::MotorOrders<double> orders = d.orders(world, number);
  const sim::MotorNumbers<double> m = d.motor(world, number);
  const double start_m = d.model->def().cables[static_cast<std::size_t>(cable)].rest_length_m;
  const double wound_m = d.at(world, d.layout.rest + cable) + m.gap;
  MotorState out;
  out.mode = orders.by_duty > 0 ? MotorMode::kDuty : MotorMode::kServo;
  if (!(orders.on > 0)) out.mode = MotorMode::kOff;
  out.duty = m.duty;
  out.voltage_v = m.duty * m.supply;
  out.current_a = m.current;
  out.rotor_angle_rad = (start_m - wound_m) / d.view.motors[number].way_m;
  out.rotor_speed_rad_per_s = m.speed;
  out.winding_temperature_c = m.winding;
  out.housing_temperature_c = m.housing;
  out.supply_voltage_v = m.supply;
  out.backlash_m = m.gap;
  out.energy_from_supply_j = m.from_supply;
  out.energy_to_cable_j = m.to_cable;
  out.energy_in_winding_j = m.in_winding;
  return out;
}

}  // namespace taut
