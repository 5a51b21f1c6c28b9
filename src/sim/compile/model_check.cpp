// Validation of bodies, shapes, cables, motors and sizes of a model definition.
#include "sim/compile/model_check.h"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "math/convex_hull.h"
#include "math/principal_axes.h"
#include "math/vec.h"
#include "sim/compile/checker.h"
#include "sim/constraint/capstan.h"
#include "sim/data/tables.h"
#include "taut/shape_kinds.h"

namespace taut::sim {
namespace {

void CheckBodies(const ModelDef& def, Checker& check) {
  for (const BodyDef& b : def.bodies) {
    const std::string name = "body " + b.name;
    check.Finite(b.com_m, name + ": center of mass");
    check.Finite(b.velocity_m_per_s, name + ": velocity");
    check.Finite(b.angular_velocity_rad_per_s, name + ": angular velocity");
    if (b.fixed) continue;
    check.Positive(b.mass_kg, name + ": mass");
    const Inertia& j = b.inertia_kg_m2;
    double r[9], moments[3] = {NAN, NAN, NAN};
    if (std::isfinite(j.xx + j.yy + j.zz + j.xy + j.xz + j.yz)) PrincipalAxes(j, r, moments);
    for (double m : moments) check.Positive(m, name + ": each principal moment of inertia");
  }
}

void CheckShapes(const ModelDef& def, Checker& check) {
  for (const SphereDef& s : def.spheres) {
    check.Body(s.body, def, "sphere " + s.name);
    check.Finite(s.center_m, "sphere " + s.name + ": center");
    check.Positive(s.radius_m, "sphere " + s.name + ": radius");
    check.Surface(s.material, "sphere " + s.name);
  }
  for (const CapsuleDef& c : def.capsules) {
    check.Body(c.body, def, "rod " + c.name);
    check.Finite(c.from_m, "rod " + c.name + ": end");
    check.Finite(c.to_m, "rod " + c.name + ": end");
    check.Positive(c.radius_m, "rod " + c.name + ": radius");
    check.Member(c.member, "rod " + c.name);
    const Vec3 d{c.to_m.x - c.from_m.x, c.to_m.y - c.from_m.y, c.to_m.z - c.from_m.z};
    check.Surface(c.material, "rod " + c.name, d.x != 0 || d.y != 0 || d.z != 0);
  }
  const auto box = [&](const std::string& name, const Vec3& center, const Quat& q, const Vec3& half,
                       const Material& m) {
    check.Finite(center, name + ": center");
    check.Require(std::fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-9,
                  name + ": the orientation must be a unit quaternion");
    check.Positive(half.x, name + ": half extent");
    check.Positive(half.y, name + ": half extent");
    check.Positive(half.z, name + ": half extent");
    check.Surface(m, name);
  };
  for (const BoxDef& b : def.boxes) {
    check.Body(b.body, def, "box " + b.name);
    box("box " + b.name, b.center_m, b.orientation, b.half_extents_m, b.material);
  }
  for (const HullDef& h : def.hulls) {
    const std::string name = "hull " + h.name;
    check.Body(h.body, def, name);
    for (const Vec3& p : h.corners_m) check.Finite(p, name + ": corner");
    check.Surface(h.material, name);
    check.Require(h.corners_m.size() <= HullDef::kMostCorners,
                  name + " has more than " + std::to_string(HullDef::kMostCorners) + " corners");
    if (h.corners_m.size() > HullDef::kMostCorners) continue;
    check.Require(!math::HullOf(h.corners_m, HullDef::kMostCorners).corners.empty(),
                  name + " has no volume: its corners are in one plane, or fewer than four");
  }
  for (const TerrainBoxDef& b : def.terrain_boxes) {
    box("terrain box " + b.name, b.center_m, b.orientation, b.half_extents_m, b.material);
  }
  check.Require(static_cast<int>(def.planes.size()) <= kMaxPlanes,
                "the model has more than " + std::to_string(kMaxPlanes) + " planes");
  for (const PlaneDef& p : def.planes) {
    check.Finite(p.point_m, "plane " + p.name + ": point");
    const Vec3& n = p.normal;
    check.Require(std::fabs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-9,
                  "plane " + p.name + ": the normal must be a unit vector");
    check.Surface(p.material, "plane " + p.name);
  }
}

void CheckMotor(const std::string& name, const DcMotorDef& m, Checker& check) {
  check.Positive(m.resistance_ohm, name + "resistance");
  check.Positive(m.torque_constant_n_m_per_a, name + "torque constant");
  check.Positive(m.rotor_inertia_kg_m2, name + "inertia of the rotor");
  check.NonNegative(m.friction_torque_n_m, name + "friction");
  check.NonNegative(m.static_friction_torque_n_m, name + "static friction");
  check.Require(!(m.static_friction_torque_n_m < m.friction_torque_n_m),
                name + "static friction must not be below the friction of a turning rotor");
  check.Positive(m.stribeck_speed_rad_per_s, name + "Stribeck's speed");
  check.NonNegative(m.viscous_friction_n_m_s_per_rad, name + "viscous friction");
  check.Positive(m.gear_ratio, name + "gear ratio");
  check.Require(m.gear_efficiency > 0 && m.gear_efficiency <= 1,
                name + "the gear's efficiency must be above 0 and at most 1");
  check.NonNegative(m.backlash_rad, name + "backlash");
  check.Positive(m.spool_radius_m, name + "radius of the spool");
  check.NonNegative(m.driver_resistance_ohm, name + "resistance of the driver");
  check.Positive(m.supply_voltage_v, name + "voltage of the supply");
  check.NonNegative(m.supply_resistance_ohm, name + "resistance of the supply");
  check.Require(std::isfinite(m.rated_temperature_c) && std::isfinite(m.ambient_temperature_c),
                name + "temperatures must be finite");
  check.NonNegative(m.resistance_rise_per_k, name + "rise of the resistance");
  check.Positive(m.winding_thermal_resistance_k_per_w, name + "thermal resistance of the winding");
  check.Positive(m.housing_thermal_resistance_k_per_w, name + "thermal resistance of the housing");
  check.Positive(m.winding_thermal_time_s, name + "thermal time constant of the winding");
  check.Positive(m.housing_thermal_time_s, name + "thermal time constant of the housing");
  check.NonNegative(m.servo_gain_per_m, name + "gain of the servo");
  check.NonNegative(m.servo_damping_s_per_m, name + "damping of the servo");
}

/// Checks that motors with the same supply define it in the same way.
void CheckSupplies(const ModelDef& def, Checker& check) {
  std::map<std::string, const CableDef*> first;
  for (const CableDef& c : def.cables) {
    if (c.actuator.kind != ActuatorDef::Kind::kDcMotor || !c.actuator.dc_motor) continue;
    const DcMotorDef& motor = *c.actuator.dc_motor;
    const CableDef& other = *first.emplace(motor.supply, &c).first->second;
    const DcMotorDef& same = *other.actuator.dc_motor;
    check.Require(motor.supply_voltage_v == same.supply_voltage_v &&
                      motor.supply_resistance_ohm == same.supply_resistance_ohm,
                  "cable " + c.name + ": its motor's supply \"" + motor.supply +
                      "\" differs from the one at cable " + other.name);
  }
}

static_assert(kMostSpans == CableDef::kMostSpans);

/// Checks wheels and friction along a cable.
void CheckRoute(const CableDef& c, const std::string& name, Checker& check) {
  int spans = 1;
  for (std::size_t i = 0; i < c.attachments.size(); ++i) {
    const AttachmentDef& a = c.attachments[i];
    const bool end = i == 0 || i + 1 == c.attachments.size();
    check.NonNegative(a.friction, name + ": friction");
    check.Require(!end || (a.friction == 0 && !a.wheel),
                  name + " ends at an attachment with friction or a wheel");
    spans += a.friction > 0;
    if (!a.wheel || end) continue;
    const std::string wheel = name + ": wheel " + std::to_string(i);
    check.Positive(a.wheel->radius_m, wheel + ": radius");
    check.Require(std::fabs(Dot(a.wheel->axis, a.wheel->axis) - 1.0) < 1e-9,
                  wheel + ": its axis must be a unit vector");
    check.Require(a.wheel->turns >= 0, wheel + " has a negative number of turns");
    for (const std::size_t k : {i - 1, i + 1}) {
      const Vec3 way = c.attachments[k].position_m - a.position_m;
      const Vec3 across = Cross(a.wheel->axis, way);
      // Rounding may move a point on the rim inside.
      check.Require(Dot(across, across) > 0.999 * a.wheel->radius_m * a.wheel->radius_m,
                    wheel + ": the attachment before or after it is inside it or on its axis");
    }
  }
  check.Require(spans <= kMostSpans, name + " has friction at more than " +
                                         std::to_string(kMostSpans - 1) + " attachments");
  const bool slips = spans > 1 || c.touch_friction > 0;
  check.Require(!slips || c.actuator.kind != ActuatorDef::Kind::kDcMotor,
                name +
                    " has friction and a motor, but only ideal and limited actuators can wind a "
                    "cable with friction");
}

void CheckCables(const ModelDef& def, Checker& check) {
  for (const NodeDef& n : def.nodes) {
    check.Body(n.body, def, "node " + n.name);
    check.Finite(n.position_m, "node " + n.name + ": position");
  }
  for (const CableDef& c : def.cables) {
    const std::string name = "cable " + c.name;
    check.Require(c.attachments.size() >= 2, name + " needs two attachments or more");
    for (const AttachmentDef& a : c.attachments) {
      check.Body(a.body, def, name);
      check.Finite(a.position_m, name + ": attachment");
    }
    CheckRoute(c, name, check);
    if (c.touches != CableTouches::kNone) {
      check.Require(c.attachments.size() == 2,
                    name + " touches obstacles, so it must have exactly two attachments");
      check.Positive(c.radius_m, name + ": radius");
      check.NonNegative(c.touch_friction, name + ": friction on obstacles");
    }
    check.Positive(c.stiffness_n_per_m, name + ": stiffness");
    check.NonNegative(c.damping_n_s_per_m, name + ": damping");
    check.Positive(c.rest_length_m, name + ": rest length");
    check.Member(c.member, name);
    if (c.actuator.kind == ActuatorDef::Kind::kDcMotor) {
      check.NonNegative(c.actuator.min_rest_length_m, name + ": smallest rest length");
      check.Require(c.actuator.dc_motor.has_value(), name + ": its motor is not defined");
      if (c.actuator.dc_motor) CheckMotor(name + ": dc_motor: ", *c.actuator.dc_motor, check);
    }
    if (c.actuator.kind != ActuatorDef::Kind::kLimited) continue;
    check.Require(c.actuator.max_speed_m_per_s > 0, name + ": largest speed must be positive");
    check.Require(c.actuator.max_acceleration_m_per_s2 > 0,
                  name + ": largest acceleration must be positive");
    check.Require(c.actuator.max_force_n > 0, name + ": largest force must be positive");
    check.NonNegative(c.actuator.min_rest_length_m, name + ": smallest rest length");
    check.NonNegative(c.actuator.min_length_m, name + ": smallest length");
  }
}

/// Checks numbers that grow with the square of a model's size: pairs of shapes of different bodies,
/// and pairs of cables on a common body. Pairs of shapes of moving bodies need only numbers as
/// keys. All other pairs need memory. The pairs of any two bodies also need time, because all of
/// them are tested whenever the two bodies are near.
void CheckSizes(const ModelDef& def, Checker& check) {
  std::vector<double> shapes(def.bodies.size()), ends(def.bodies.size());
  double fixed = static_cast<double>(def.terrain_boxes.size() + def.height_fields.size() +
                                     def.terrain_meshes.size());
  const auto moves = [&](int body) {
    return body != kWorld && !def.bodies[static_cast<std::size_t>(body)].fixed;
  };
  EachShape(def, [&](const auto& shape) {
    if (!shape.collides) return;
    (moves(shape.body) ? shapes[static_cast<std::size_t>(shape.body)] : fixed) += 1;
  });
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& a : cable.attachments) {
      if (moves(a.body)) ends[static_cast<std::size_t>(a.body)] += 1;
    }
  }
  double all = 0, within = 0, couplings = 0, most = 0, of_two = 0;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    all += shapes[b];
    within += shapes[b] * shapes[b];
    of_two = std::max(of_two, most * shapes[b]);
    most = std::max(most, shapes[b]);
    couplings += ends[b] * ends[b];
  }
  check.Require(std::max(all * fixed, of_two) <= kMaxShapePairs,
                "more than " + std::to_string(kMaxShapePairs) +
                    " pairs of shapes may collide with static shapes or between two bodies: "
                    "exclude shapes that cannot meet");
  check.Require(0.5 * (all * all - within) <= kMaxMovingShapePairs,
                "more than " + std::to_string(kMaxMovingShapePairs) +
                    " pairs of shapes of moving bodies may collide: exclude shapes that cannot "
                    "meet");
  check.Require(couplings <= kMaxCouplings,
                "more than " + std::to_string(kMaxCouplings) + " pairs of cables share a body");
}

}  // namespace

bool CheckModel(const ModelDef& def, Diagnostics& out) {
  const std::size_t before = out.items().size();
  Checker check(def, out);
  check.Finite(def.gravity_m_per_s2, "gravity");
  CheckBodies(def, check);
  CheckShapes(def, check);
  CheckCables(def, check);
  CheckSupplies(def, check);
  CheckGround(def, check);
  CheckJoints(def, check);
  CheckMotions(def, check);
  if (out.items().size() == before) CheckSizes(def, check);
  return out.items().size() == before;
}

}  // namespace taut::sim
