/// DC motors with gear and spool that wind cables (docs/theory/motor.md). Equations of the rotor:
///
///   J dw/dt = k i - viscous w - friction - way T (1 + gear_loss in the direction of motion)
///   i = (duty V - k w) / R,    dL/dt = -way w
///
/// w: rotor speed, positive when winding in; T: cable tension; `way`: spool radius / gear ratio. A
/// step has three parts: the voltages of the loaded supplies (LoadSupplies); the rotation as a
/// function of the unknown tension, for the law of the cable (DriveMotor); and the rotation under
/// the computed tension (StageMotors).
#pragma once

#include "math/cable_law.h"
#include "sim/data/rows.h"

namespace taut::sim {

/// Discretized exponential decay with z = rate * h (motor.md, M.8): exp(-z) ~ 1 / p.
template <class W>
struct Decay {
  W z, inv_p;
  W half;       ///< 1 + z / 2: final speed per kick, times p.
  W mean_kick;  ///< (1 + z) / (2 p): mean speed per kick.

  TAUT_INLINE explicit Decay(W rate_h) noexcept : z(rate_h) {
    const W one = W::Splat(1.0), h = W::Splat(0.5);
    half = one + h * z;
    inv_p = one / (one + z * half);
    mean_kick = h * (one + z) * inv_p;
  }
};

/// Duty of a motor within a step, as a linear function of the mean speed.
template <class W>
struct DutyLaw {
  W duty, falls;  ///< Duty = `duty` - `falls` * mean speed.
};

template <class W>
TAUT_INLINE W WindingOhm(const MotorTable& t, W temperature_c) noexcept {
  return W::Splat(t.winding_ohm) *
         (W::Splat(1.0) + W::Splat(t.rise_per_k) * (temperature_c - W::Splat(t.rated_c)));
}

/// Returns the commanded duty, or the law of the servo (motor.md, M.6). The servo uses the rest
/// length at the middle of the step, which allows a high gain.
template <class W>
TAUT_INLINE DutyLaw<W> DutyOf(const MotorTable& t, const MotorOrders<W>& orders,
                              const MotorNumbers<W>& motor, W wound, W target, W h) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const W gain = W::Splat(t.servo_gain), way = W::Splat(t.way_m);
  const W wish = gain * (wound - target);
  const W falls = way * (W::Splat(0.5) * h * gain + W::Splat(t.servo_damping));
  const auto by_duty = orders.by_duty > zero;
  // In this order of arguments, a NaN duty stays NaN instead of becoming a bound.
  const W now = Max(-one, Min(one, Select(by_duty, orders.duty, wish - falls * motor.speed)));
  const auto servo = (now < one) & (now > -one) & !by_duty;
  return {Select(servo, wish, now), Select(servo, falls, zero)};
}

/// Returns the rest length according to the gear angle, without backlash.
template <class W>
TAUT_INLINE W WoundTo(const Rows<W>& s, int c, const MotorNumbers<W>& motor) noexcept {
  return s.rest[c] + motor.gap;
}

/// Computes the voltage of each loaded supply (motor.md, M.7): V = V0 - R sum(duty i). The currents
/// i are computed with this voltage and the speeds at the start of the step.
template <class W>
void LoadSupplies(const View& m, const Rows<W>& s, Scratch<W>& work, W h) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  for (int i = 0; i < m.supply_count; ++i) {
    const SupplyTable& supply = m.supplies[i];
    const W open = W::Splat(supply.voltage_v), sags = W::Splat(supply.resistance_ohm);
    // Supply current: sum of duty^2 / R per volt, and sum of duty k w / R from back EMF.
    W per_volt = zero, back = zero;
    for (int j = 0; j < m.motor_count; ++j) {
      const MotorTable& t = m.motors[j];
      if (t.supply != i) continue;
      const MotorNumbers<W>& motor = s.motor[j];
      const MotorOrders<W>& orders = s.orders[j];
      const DutyLaw<W> law =
          DutyOf(t, orders, motor, WoundTo(s, t.cable, motor), s.target[t.cable], h);
      const W duty = law.duty - law.falls * motor.speed;
      const W conducts = orders.on * duty / (WindingOhm(t, motor.winding) + W::Splat(t.driver_ohm));
      per_volt += conducts * duty;
      back += conducts * W::Splat(t.constant) * motor.speed;
    }
    work.supplies[i] = Min(open, (open + sags * back) / (one + sags * per_volt));
  }
}

/// Returns the rest length on the spool. The result equals the value from the gear angle, or is
/// less within the backlash. A taut cable (length `l`) pulls the spool against the gear.
template <class W>
TAUT_INLINE W RestOnSpool(const MotorTable& t, W wound, W before, W l) noexcept {
  if (t.backlash_m == 0.0) return wound;
  return Max(Min(Max(before, l), wound), wound - W::Splat(t.backlash_m));
}

/// Computes the rotation of a motor in this step as a function of its cable's tension: sets its
/// MotorWork and the rate of the cable without tension. Returns the mean rest length over the step
/// without tension.
///   k, b    cable stiffness, damping     l, dl   length at the middle, expected mean rate
template <class W>
TAUT_INLINE W DriveMotor(const View& m, const Rows<W>& s, Scratch<W>& work, int c, W k, W b, W l,
                         W dl, W h) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0), half_h = W::Splat(0.5) * h;
  const int number = m.cables[c].motor;
  const MotorTable& t = m.motors[number];
  const MotorNumbers<W>& motor = s.motor[number];
  MotorWork<W>& out = work.motors[number];
  const W way = W::Splat(t.way_m), inv_J = W::Splat(t.inv_inertia), constant = W::Splat(t.constant);
  const W speed = motor.speed, wound = WoundTo(s, c, motor);

  // Torques at zero speed, and torques that depend on the speed.
  const DutyLaw<W> law = DutyOf(t, s.orders[number], motor, wound, s.target[c], h);
  out.duty = law.duty;
  out.duty_falls = law.falls;
  out.conducts = s.orders[number].on;
  out.resistance = WindingOhm(t, motor.winding) + W::Splat(t.driver_ohm);
  const W per_volt = out.conducts * constant / out.resistance;
  const W volts = work.supplies[t.supply];
  const W rate = inv_J * (per_volt * (constant + law.falls * volts) + W::Splat(t.viscous));
  const W drive = inv_J * per_volt * law.duty * volts;
  const Decay<W> decay(rate * h);

  // The rotor sticks if friction can hold it under the tension at standstill (M.9, M.10).
  const W stopping = speed / (decay.half + decay.half);
  const W least = W::Splat(t.min_rest_m);
  const W stop_rest = RestOnSpool(t, wound - half_h * way * stopping, s.rest[c], l);
  const W stretch = l - stop_rest;
  const W tension =
      Select(stretch > zero, Max(math::CableLaw{k}.Force(stretch) + b * dl, zero), zero);
  const W pull = inv_J * way;
  const W slip = speed / (h * decay.half) + drive - pull * tension;
  const W slowness = W::Splat(t.inv_stribeck2) * speed * speed;
  const W friction = inv_J * (W::Splat(t.friction) + W::Splat(t.static_more) / (one + slowness));
  const W loss = W::Splat(t.gear_loss);
  const W holds = friction + pull * loss * tension;
  const auto held = (Abs(slip) < holds) | (Abs(slip) == holds);  // false for NaN
  out.direction = Select(held, zero, Select(slip < zero, -one, one));

  // Otherwise it slips: speeds without the cable, and their decrease per tension.
  const W kick = h * (drive - out.direction * friction);
  const W lost = h * pull * (one + out.direction * loss);
  out.mean = Select(held, stopping, speed * decay.half * decay.inv_p + kick * decay.mean_kick);
  out.slows = Select(held, zero, lost * decay.mean_kick);
  out.end = Select(held, zero, (speed + kick * decay.half) * decay.inv_p);
  out.end_slows = Select(held, zero, lost * decay.half * decay.inv_p);

  // The spool stops at the shortest rest length.
  const W room = Max(wound - least, zero) / (way * h);
  const auto stops = out.mean - out.slows * tension > room;
  out.mean = Select(stops, room, out.mean);
  out.slows = Select(stops, zero, out.slows);
  out.end = Select(stops, zero, out.end);
  out.end_slows = Select(stops, zero, out.end_slows);

  out.length = l;
  out.share = one / (one + k * half_h * way * Max(out.slows, zero));
  const W mean = RestOnSpool(t, wound - half_h * way * out.mean, s.rest[c], l);
  s.rest_rate[c] = t.backlash_m == 0.0 ? -way * out.mean : (mean - s.rest[c]) / half_h;
  return mean;
}

/// Stage: rotates the rotors under the computed tensions, and updates temperatures and energies.
///   reads   tension, motors[]     writes  motor, rest, rest_rate
template <class W>
void StageMotors(const View& m, const Rows<W>& s, const Scratch<W>& work, double step_s) noexcept {
  const W zero = W::Splat(0.0), h = W::Splat(step_s), inv_h = W::Splat(1.0 / step_s);
  for (int i = 0; i < m.motor_count; ++i) {
    const MotorTable& t = m.motors[i];
    const MotorWork<W>& turn = work.motors[i];
    const int c = t.cable;
    MotorNumbers<W>& motor = s.motor[i];
    const W tension = s.tension[c], way = W::Splat(t.way_m);

    // Friction can stop a rotor but not reverse it.
    const W mean = turn.mean - turn.slows * tension, end = turn.end - turn.end_slows * tension;
    const auto went_on = !(turn.direction * motor.speed < zero);
    const W mean_speed = Select((turn.direction * mean < zero) & went_on, zero, mean);
    const W before = s.rest[c], start = WoundTo(s, c, motor);
    const W wound = Max(Min(start, W::Splat(t.min_rest_m)), start - h * way * mean_speed);
    const W rest = RestOnSpool(t, wound, before, turn.length);
    motor.speed = Select(turn.direction * end < zero, zero, end);
    motor.gap = wound - rest;
    s.rest[c] = rest;
    s.rest_rate[c] = (rest - before) * inv_h;

    motor.supply = work.supplies[t.supply];
    motor.duty = turn.duty - turn.duty_falls * mean_speed;
    motor.current = turn.conducts *
                    (motor.duty * motor.supply - W::Splat(t.constant) * mean_speed) /
                    turn.resistance;
    const W square = motor.current * motor.current;
    const W heat = square * WindingOhm(t, motor.winding);
    motor.from_supply += h * motor.supply * motor.duty * motor.current;
    motor.to_cable += tension * (before - rest);
    motor.in_winding += h * heat;
    const W outwards = W::Splat(t.winding_w_per_k) * (motor.winding - motor.housing);
    const W away = W::Splat(t.housing_w_per_k) * (motor.housing - W::Splat(t.ambient_c));
    motor.winding += h * W::Splat(t.winding_k_per_j) * (heat - outwards);
    motor.housing += h * W::Splat(t.housing_k_per_j) * (outwards - away);
  }
}

}  // namespace taut::sim
