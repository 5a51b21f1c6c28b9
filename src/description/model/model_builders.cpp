// Checks of builder keys.
#include <limits>

#include "description/model/model_keys.h"

namespace taut::description {

ActuatorText::ActuatorText() {
  max_speed_m_per_s = max_acceleration_m_per_s2 = max_force_n =
      std::numeric_limits<double>::infinity();
}

void Check(const MapReader& map, RodText& rod) {
  rod.material = ToMaterial(map, rod.surface, true);
  CheckSection(map, MemberOf::kRod);
  if (rod.pins && !rod.class_k) {
    map.Error("rod.pins_without_class_k", "pins",
              map.Path("pins") + " has no effect: this rod is welded at its nodes",
              "write `class_k: true`, or leave out `pins`");
  }
}

void Check(const MapReader& map, SphereText& sphere) {
  sphere.material = ToMaterial(map, sphere.surface);
}

void Check(const MapReader& map, PointMassText& mass) {
  const std::size_t count = mass.inertia_kg_m2.size();
  if (!map.Has("inertia_kg_m2")) return;
  if (count != 3 && count != 6) {
    map.Error(
        "point_mass.bad_inertia", "inertia_kg_m2",
        "point_mass.inertia_kg_m2 must have three or six numbers, got " + std::to_string(count),
        "expected [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]");
    mass.inertia_kg_m2.assign(6, NAN);
  }
  mass.inertia_kg_m2.resize(6, 0.0);
  if (map.Has("radius_m")) {
    map.Error("point_mass.inertia_given_twice", "radius_m",
              "point_mass has both inertia_kg_m2 and radius_m", "give only one of them");
  }
}

void Check(const MapReader& map, BoxText& box) {
  box.material = ToMaterial(map, box.surface);
  box.along_pair = map.Has("width_m") || map.Has("height_m");
  std::vector<std::string> masses{"mass_kg", "density_kg_per_m3"};
  if (box.along_pair) masses.push_back("mass_kg_per_m");
  map.ExactlyOne(masses);
  if (box.along_pair) {
    for (const char* other : {"size_m", "half_extents_m"}) {
      if (!map.Has(other)) continue;
      map.Error("box.width_given_twice", other, "box has both width_m and " + std::string(other),
                "give width_m and height_m along a pair, size_m or half_extents_m at a node");
    }
    if (map.Has("rotate")) {
      map.Error("box.rotation_without_effect", "rotate",
                "a box along a pair cannot be rotated: its nodes define its orientation",
                "leave out `rotate`, or give size_m or half_extents_m at a node");
    }
    map.Require("width_m");
    map.Require("height_m");
    return;
  }
  const std::string key = map.ExactlyOne({"size_m", "half_extents_m", "width_m"});
  if (key == "size_m")
    box.half_extents_m = {0.5 * box.size_m.x, 0.5 * box.size_m.y, 0.5 * box.size_m.z};
  if (map.Has("mass_kg_per_m")) {
    map.Error("box.no_length", "mass_kg_per_m", "a box at a node cannot have a mass per length",
              "give mass_kg or density_kg_per_m3");
  }
}

void Check(const MapReader& map, DcMotorDef& motor) {
  if (!(motor.static_friction_torque_n_m < motor.friction_torque_n_m)) return;
  const char* const key =
      map.Has("static_friction_torque_n_m") ? "static_friction_torque_n_m" : "friction_torque_n_m";
  map.Error("motor.static_below_friction", key,
            map.Path("static_friction_torque_n_m") + " is " +
                Shown(motor.static_friction_torque_n_m) + ", below friction_torque_n_m of " +
                Shown(motor.friction_torque_n_m),
            "static friction must be at least the friction of a turning rotor");
}

/// Checks an actuator with a DC motor. Its only limits are the motor's data.
void CheckMotor(const MapReader& map, ActuatorText& actuator) {
  actuator.kind = ActuatorDef::Kind::kDcMotor;
  for (const char* other :
       {"ideal", "max_speed_m_per_s", "max_acceleration_m_per_s2", "max_force_n", "min_length_m"}) {
    if (!map.Has(other)) continue;
    map.Error("actuator.given_twice", other,
              map.what() + " has both dc_motor and " + std::string(other),
              "with a dc_motor only min_rest_length_m is allowed");
  }
}

void Check(const MapReader& map, ActuatorText& actuator) {
  const bool limited = map.HasAnyBut("ideal");
  if (actuator.dc_motor) return CheckMotor(map, actuator);
  if (actuator.ideal && limited) {
    map.Error("actuator.ideal_has_no_limits", "ideal", "an ideal actuator cannot have limits",
              "leave out `ideal`, or the limits");
  } else if (!actuator.ideal && !limited && map.is_map()) {
    map.scope().out.Error("actuator.limits_missing", map.at(),
                          map.what() + " needs limits, a `dc_motor`, or `ideal: true`",
                          "leave out the actuator for a fixed rest length");
  }
  actuator.kind = actuator.ideal ? ActuatorDef::Kind::kIdeal : ActuatorDef::Kind::kLimited;
}

void Check(const MapReader& map, CableText& cable) {
  for (const char* key : {"prestress_n", "rest_length_m", "rest_length_ratio"}) {
    if (map.Has(key)) cable.rest_at = map.Find(key)->at;
  }
  CheckStiffness(map);
  CheckSection(map, MemberOf::kCable);
  CheckOwnMass(map, cable.member, cable.density_kg_per_m3);
  cable.own_damping_law = map.Has("damping_law");
  if (map.Has("ends")) cable.ends_at = map.Find("ends")->at;
  const bool touches = cable.touches != CableTouches::kNone;
  if (touches && cable.radius_m == 0) {
    map.Error("cable.touches_without_radius", "touches",
              map.Path("touches") + " needs a `radius_m` above 0",
              "half the cable's thickness, such as 0.001");
  } else if (!touches && map.Has("radius_m")) {
    map.Error("cable.radius_without_touches", "radius_m",
              map.Path("radius_m") + " has no effect without `touches`",
              "write `touches: terrain`, `touches: rods` or `touches: all`");
  }
  if (!touches && map.Has("touch_friction")) {
    map.Error("cable.touch_friction_without_touches", "touch_friction",
              map.Path("touch_friction") + " has no effect without `touches`",
              "write `touches: terrain`, `touches: rods` or `touches: all`; eyelets and pulleys "
              "have `friction` in the route");
  }
  if (cable.actuator_text) cable.actuator = *cable.actuator_text;
  if (cable.touch_friction > 0 && cable.actuator.kind == ActuatorDef::Kind::kDcMotor) {
    map.Error("cable.touch_friction_of_motor", "touch_friction",
              map.Path("touch_friction") +
                  ": a cable with friction on obstacles cannot have a `dc_motor`",
              "use `ideal: true` or an actuator with limits, or leave out `touch_friction`");
  }
}

void Check(const MapReader& map, JointText& joint) {
  const bool ball = joint.kind == JointKind::kBall;
  for (const char* key : {"least_rad", "least_m", "most_rad", "most_m", "friction_n_m",
                          "friction_n", "stiffness_n_m_per_rad", "stiffness_n_per_m",
                          "damping_n_m_s_per_rad", "damping_n_s_per_m", "rest_rad", "rest_m"}) {
    if (!map.Has(key)) continue;
    if (!HasCoordinate(joint.kind)) {
      map.Error("joint.no_single_coordinate", key,
                map.Path(key) + ": a joint of this kind has no single coordinate");
    } else if (ball && key == std::string_view("least_rad")) {
      map.Error("joint.ball_has_no_lower_stop", key,
                map.Path(key) + ": a ball joint has no lower limit",
                "use most_rad, the largest angle of its axis from the described direction");
    } else if (ball && key == std::string_view("rest_rad")) {
      map.Error(
          "joint.ball_spring_offset", key,
          map.Path(key) + ": the spring of a ball joint is always at rest in the described pose",
          "rotate its bodies in the model instead");
    }
  }
  const char* const most = IsAngle(joint.kind) ? "most_rad" : "most_m";
  if (ball && joint.most && *joint.most <= 0 && map.Has(most)) {
    map.Error("joint.stop_not_positive", most,
              map.Path(most) + " must be positive, got " + Shown(*joint.most),
              "it is the largest angle of a ball joint's axis from the described direction");
  }
  if (joint.kind == JointKind::kDistance) {
    const bool below = joint.least && *joint.least < 0;
    if (below)
      map.Error("joint.negative_distance", "least_m",
                map.Path("least_m") + " must not be negative: it is a distance");
    if (joint.most && *joint.most <= 0 && map.Has(most)) {
      map.Error("joint.stop_not_positive", most,
                map.Path(most) + " must be positive, got " + Shown(*joint.most),
                "it is a distance");
    }
    if (below) return;
  }
  if (!joint.least || !joint.most || *joint.least < *joint.most) return;
  if (!map.Has(most)) return;
  map.Error("joint.empty_range", most,
            map.Path(most) + " is " + Shown(*joint.most) + ", not above the lower limit of " +
                Shown(*joint.least),
            "the upper limit must be above the lower limit");
}

void Check(const MapReader& map, BuilderText& builder) {
  if (map.Has("match")) builder.match_at = map.Find("match")->at;
  for (const char* kind : {"rod", "sphere", "point_mass", "box", "convex", "cable", "bar", "anchor",
                           "joint", "support"}) {
    if (!map.Has(kind)) continue;
    builder.kind = builder.kind.empty() ? kind : "several";
  }
}

void FinishBuilders(const MapReader& map, ModelText& model) {
  const Value* list = map.Find("builders");
  if (!list) return;
  if (list->kind != Value::Kind::kSequence) model.builders_complete = false;
  if (model.builders.size() > static_cast<std::size_t>(kMaxBuilders)) {
    map.scope().out.Error("builder.too_many", list->at,
                          "the model has more than " + std::to_string(kMaxBuilders) + " builders",
                          "match tags that several nodes or pairs share");
    model.builders_complete = false;
    model.builders.clear();
  }
  const auto bad = [](const BuilderText& b) {
    return b.match.empty() || b.kind.empty() || b.kind == "several";
  };
  if (std::erase_if(model.builders, bad) > 0) model.builders_complete = false;
}

}  // namespace taut::description
