#include "linear/coordinates.h"

#include <cmath>

namespace taut::linear {
namespace {

using simd::Q4;
using simd::V3;

constexpr const char* kAxes[] = {"x", "y", "z"};

template <class Num>
V3<Num> GetV3(const World<Num>& world, int row) {
  return {world.Get(row), world.Get(row + 1), world.Get(row + 2)};
}
template <class Num>
Q4<Num> GetQ4(const World<Num>& world, int row) {
  return {world.Get(row), world.Get(row + 1), world.Get(row + 2), world.Get(row + 3)};
}
template <class Num>
V3<Num> Splat(const Vec3& a) {
  return {Num::Splat(a.x), Num::Splat(a.y), Num::Splat(a.z)};
}

/// Returns the angular velocity of a body from its angular momentum [rad/s], in W.
template <class Num>
V3<Num> SpinOf(const World<Num>& world, int body) {
  const sim::Layout& l = world.layout();
  const auto R = simd::RotationOf(GetQ4(world, l.quat + 4 * body));
  return simd::Congruence(R, GetV3(world, l.inv_inertia + 3 * body)) *
         GetV3(world, l.mom + 3 * body);
}

/// Returns the rotation vector from `from` to `to` [rad], in W, for small rotations (exact to
/// second order).
template <class Num>
V3<Num> TurnFrom(const Quat& from, const Q4<Num>& to) {
  const V3<Num> u{to.x, to.y, to.z}, s = Splat<Num>({from.x, from.y, from.z});
  const Num b = Num::Splat(from.w), two = Num::Splat(2.0);
  return two * (b * u - to.w * s - Cross(u, s));
}

}  // namespace

Coordinate& Coordinates::State(std::string name, std::string unit, SignalKind kind, double small) {
  Coordinate& state = states_.emplace_back();
  state.signal.name = std::move(name);
  state.signal.unit = std::move(unit);
  state.kind = kind, state.small = small;
  return state;
}

void Coordinates::AddBodies(const World<Plain>& at) {
  const sim::Layout& l = at.layout();
  const bool touches = at.touches();  // with contacts, changes must be smaller than the lift above
                                      // the ground
  const std::vector<BodyDef>& bodies = at.def().bodies;
  for (int b = 0; b < at.view().body_count; ++b) {
    if (!(at.Get(l.mass + b).v > 0.0) || at.view().HasMotion(b)) continue;
    const std::string name = "body/" + bodies[static_cast<std::size_t>(b)].name + "/";
    const Q4<Plain> q = GetQ4(at, l.quat + 4 * b);
    const V3<Plain> x = GetV3(at, l.pos + 3 * b);
    movers_.push_back({b, {x.x.v, x.y.v, x.z.v}, {q.w.v, q.x.v, q.y.v, q.z.v}});
    for (int k = 0; k < 3; ++k) {
      Coordinate& c = State(name + "position_" + kAxes[k], "m", SignalKind::kPlace,
                            touches ? 1e-8 : Less(3e-6));
      c.rows = {{l.pos + 3 * b + k, 1.0}};
      c.signal.at = at.Get(l.pos + 3 * b + k).v;
    }
    for (int k = 0; k < 3; ++k) {  // rotate by the small vector e: q <- q + (0, e / 2) q
      Coordinate& c =
          State(name + "turn_" + kAxes[k], "rad", SignalKind::kTurn, touches ? 4e-8 : Less(3e-5));
      const Vec3 e{k == 0 ? 0.5 : 0.0, k == 1 ? 0.5 : 0.0, k == 2 ? 0.5 : 0.0};
      const Vec3 v{q.x.v, q.y.v, q.z.v}, by = q.w.v * e + Cross(e, v);
      const int row = l.quat + 4 * b;
      c.rows = {{row, -Dot(e, v)}, {row + 1, by.x}, {row + 2, by.y}, {row + 3, by.z}};
      c.quat_row = row;
    }
    for (int k = 0; k < 3; ++k) {
      Coordinate& c = State(name + "velocity_" + kAxes[k], "m/s", SignalKind::kVelocity, 1e-5);
      c.rows = {{l.vel + 3 * b + k, 1.0}};
    }
    const auto R = simd::RotationOf(q);
    const auto inertia = simd::Congruence(R, GetV3(at, l.inertia + 3 * b));
    for (int k = 0; k < 3; ++k) {
      Coordinate& c = State(name + "spin_" + kAxes[k], "rad/s", SignalKind::kSpin, 1e-4);
      const V3<Plain> e =
          Splat<Plain>({k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0});
      const V3<Plain> L = inertia * e;
      const int row = l.mom + 3 * b;
      c.rows = {{row, L.x.v}, {row + 1, L.y.v}, {row + 2, L.z.v}};
    }
  }
  first_row_state_ = states_.size();
}

/// Adds all other stored values of a step, one state per row.
void Coordinates::AddRows(const World<Plain>& at) {
  const sim::Layout& l = at.layout();
  const auto add = [&](const std::string& name, const char* unit, SignalKind kind, int row,
                       double small) {
    Coordinate& c = State(name, unit, kind, small);
    c.rows = {{row, 1.0}};
    c.signal.at = at.Get(row).v;
    c.may_go = true;
  };
  const ModelDef& def = at.def();
  for (const Mover& m : movers_) {
    const std::string name = "body/" + def.bodies[static_cast<std::size_t>(m.body)].name + "/";
    for (int k = 0; k < 3; ++k) {
      add(name + "velocity_before_" + kAxes[k], "m/s", SignalKind::kVelocity,
          l.old_vel + 3 * m.body + k, 1e-5);
    }
    for (int k = 0; k < 3; ++k) {
      add(name + "spin_before_" + kAxes[k], "rad/s", SignalKind::kSpin, l.old_spin + 3 * m.body + k,
          1e-4);
    }
    for (int k = 0; k < 3; ++k) {
      add(name + "held_torque_" + kAxes[k], "N m", SignalKind::kForce,
          l.held_torque + 3 * m.body + k, 1e-4);
    }
  }
  for (int c = 0; c < at.view().cable_count; ++c) {
    const sim::CableTable& table = at.view().cables[c];
    const std::string name = "cable/" + def.cables[static_cast<std::size_t>(c)].name + "/";
    add(name + "rest_length", "m", SignalKind::kLength, l.rest + c, Less(3e-6));
    add(name + "rest_length_rate", "m/s", SignalKind::kRate, l.rest_rate + c, 1e-3);
    add(name + "tension_before", "N", SignalKind::kForce, l.tension + c, 1e-3);
    if (table.motor >= 0) {
      const int row = l.motor + sim::kWidthMotor * table.motor;
      add(name + "motor_speed", "rad/s", SignalKind::kOther, row, 1e-3);
      add(name + "motor_gap", "m", SignalKind::kLength, row + 1, 3e-7);
      add(name + "winding_temperature", "C", SignalKind::kOther, row + 2, 1e-3);
      add(name + "housing_temperature", "C", SignalKind::kOther, row + 3, 1e-3);
      add(name + "motor_duty", "1", SignalKind::kOther, row + 4, 1e-5);
      add(name + "motor_current", "A", SignalKind::kOther, row + 5, 1e-5);
      add(name + "motor_supply", "V", SignalKind::kOther, row + 6, 1e-4);
    }
    for (int i = 0; i < table.span_count; ++i) {
      const std::string span = name + "span_" + std::to_string(i + 1) + "/";
      add(span + "rest_length", "m", SignalKind::kLength, l.span_rest + table.first_span + i, 3e-7);
      add(span + "tension_before", "N", SignalKind::kForce, l.span_tension + table.first_span + i,
          1e-3);
    }
  }
}

void Coordinates::AddMemory(const World<Plain>& at, const Tick<Plain>& tick) {
  const TickMemory<Plain> memory = tick.MemoryAtRest(at);
  for (std::size_t i = 0; i < tick.driven().size(); ++i) {
    const DrivenCable& d = tick.driven()[i];
    const std::string name = "controller/" + d.controller + "/" +
                             at.def().cables[static_cast<std::size_t>(d.cable)].name + "/";
    const auto add = [&](const char* what, const char* unit, SignalKind kind, double value,
                         int number, double small) {
      Coordinate& c = State(name + what, unit, kind, small);
      c.of = Coordinate::Of::kMemory;
      c.index = 3 * static_cast<int>(i) + number;
      c.signal.at = value;
      c.may_go = true;
    };
    add("error_before", "N", SignalKind::kForce, memory[i].pid.error_before.v, 0, 1e-3);
    add("integral", "N s", SignalKind::kOther, memory[i].pid.integral.v, 1, 1e-3);
    add("length_before", "m", SignalKind::kLength, memory[i].difference.length_before_m.v, 2, 3e-7);
  }
}

void Coordinates::AddInputs(const World<Plain>& at, const Tick<Plain>& tick) {
  const ModelDef& def = at.def();
  const auto add = [&](std::string name, const char* unit, SignalKind kind, double value,
                       double small) -> Coordinate& {
    Coordinate& c = inputs_.emplace_back();
    c.signal = {std::move(name), unit, value};
    c.kind = kind, c.small = small;
    return c;
  };
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    if (def.cables[c].actuator.kind == ActuatorDef::Kind::kNone) continue;
    const int row = at.layout().target + static_cast<int>(c);
    Coordinate& input = add("cable/" + def.cables[c].name + "/rest_length_target", "m",
                            SignalKind::kLength, at.Get(row).v, Less(3e-6));
    input.of = Coordinate::Of::kTarget;
    input.index = static_cast<int>(c);
  }
  for (std::size_t i = 0; i < tick.driven().size(); ++i) {
    const DrivenCable& d = tick.driven()[i];
    Coordinate& input =
        add("cable/" + def.cables[static_cast<std::size_t>(d.cable)].name + "/velocity_input",
            "m/s", SignalKind::kRate, d.gains.velocity_offset_m_per_s, 1e-3);
    input.of = Coordinate::Of::kVelocityInput;
    input.index = static_cast<int>(i);
  }
  for (const int n : nodes_) {
    for (int k = 0; k < 3; ++k) {
      const int row = at.layout().node_force + 3 * n + k;
      add("node/" + def.nodes[static_cast<std::size_t>(n)].name + "/force_" + kAxes[k], "N",
          SignalKind::kForce, at.Get(row).v, 1e-3)
          .rows = {{row, 1.0}};
    }
  }
}

void Coordinates::AddOutputs(const World<Plain>& at) {
  const ModelDef& def = at.def();
  const auto add = [&](std::string name, const char* unit, SignalKind kind) {
    Coordinate& c = outputs_.emplace_back();
    c.signal = {std::move(name), unit, 0.0};
    c.kind = kind;
  };
  for (const CableDef& cable : def.cables) {
    add("cable/" + cable.name + "/tension", "N", SignalKind::kForce);
    add("cable/" + cable.name + "/length", "m", SignalKind::kLength);
    add("cable/" + cable.name + "/rest_length", "m", SignalKind::kLength);
  }
  for (const int n : nodes_) {
    for (const char* axis : kAxes) {
      add("node/" + def.nodes[static_cast<std::size_t>(n)].name + "/position_" + axis, "m",
          SignalKind::kPlace);
    }
  }
  const std::vector<Plain> values = Outputs(at);
  for (std::size_t i = 0; i < outputs_.size(); ++i) outputs_[i].signal.at = values[i].v;
}

Coordinates::Coordinates(const World<Plain>& at, const Tick<Plain>& tick) {
  for (int c = 0; c < at.view().cable_count; ++c) {
    const double by_m = at.Get(at.layout().sense_length + c).v - at.Get(at.layout().rest + c).v;
    if (by_m > 0) stretch_m_ = std::min(stretch_m_, by_m);
  }
  AddBodies(at);
  for (int n = 0; n < at.view().node_count; ++n) {
    for (const Mover& m : movers_) {
      if (m.body == at.view().nodes[n].body) nodes_.push_back(n);
    }
  }
  AddRows(at);
  AddMemory(at, tick);
  AddInputs(at, tick);
  AddOutputs(at);
}

template <class Num>
std::vector<Num> Coordinates::States(const World<Num>& world, const TickMemory<Num>& memory) const {
  const sim::Layout& l = world.layout();
  std::vector<Num> out;
  const auto put = [&out](const V3<Num>& a) { out.insert(out.end(), {a.x, a.y, a.z}); };
  for (const Mover& m : movers_) {
    put(GetV3(world, l.pos + 3 * m.body) - Splat<Num>(m.position_m));
    put(TurnFrom(m.orientation, GetQ4(world, l.quat + 4 * m.body)));
    put(GetV3(world, l.vel + 3 * m.body));
    put(SpinOf(world, m.body));
  }
  for (std::size_t i = first_row_state_; i < states_.size(); ++i) {
    const Coordinate& c = states_[i];
    if (c.of == Coordinate::Of::kRows) {
      out.push_back(world.Get(c.rows[0].first));
      continue;
    }
    const control::ImpedanceMemory<Num>& at = memory[static_cast<std::size_t>(c.index / 3)];
    out.push_back(c.index % 3 == 0   ? at.pid.error_before
                  : c.index % 3 == 1 ? at.pid.integral
                                     : at.difference.length_before_m);
  }
  return out;
}

template <class Num>
std::vector<Num> Coordinates::Outputs(const World<Num>& world) const {
  const sim::Layout& l = world.layout();
  std::vector<Num> out;
  for (int c = 0; c < world.view().cable_count; ++c) {
    out.push_back(world.Get(l.sense_tension + c));
    out.push_back(world.Get(l.sense_length + c));
    out.push_back(world.Get(l.rest + c));
  }
  for (const int n : nodes_) {
    const sim::AttachmentTable& node = world.view().nodes[n];
    const auto R = simd::RotationOf(GetQ4(world, l.quat + 4 * node.body));
    const V3<Num> p = GetV3(world, l.pos + 3 * node.body) + R * simd::Splat3<Num>(node.p_P);
    out.insert(out.end(), {p.x, p.y, p.z});
  }
  return out;
}

template std::vector<Plain> Coordinates::States(const World<Plain>&,
                                                const TickMemory<Plain>&) const;
template std::vector<Dual> Coordinates::States(const World<Dual>&, const TickMemory<Dual>&) const;
template std::vector<Plain> Coordinates::Outputs(const World<Plain>&) const;
template std::vector<Dual> Coordinates::Outputs(const World<Dual>&) const;

}  // namespace taut::linear
