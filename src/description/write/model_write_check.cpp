// Whether a robot is still the same after it was written and read back.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/write/model_write.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// What rounding may change, of the size of a number and of the distances that go into it.
constexpr double kRounding = 1e-12;

struct Nearness {
  double share = kRounding;

  bool operator()(double a, double b, double size) const {
    return a == b || std::fabs(a - b) <= share * std::max(std::fabs(a), size);
  }
  bool operator()(const Vec3& a, const Vec3& b) const {
    const double size = std::max({1.0, std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
    return (*this)(a.x, b.x, size) && (*this)(a.y, b.y, size) && (*this)(a.z, b.z, size);
  }
  /// Between bodies far from the origin and their parts digits are lost.
  bool operator()(const Inertia& a, const Inertia& b, const BodyDef& body) const {
    const Vec3& c = body.com_m;
    const double size = a.xx + a.yy + a.zz + 1e-3 * body.mass_kg * std::sqrt(Dot(c, c));
    const auto near = [&](double x, double y) { return (*this)(x, y, size); };
    return near(a.xx, b.xx) && near(a.yy, b.yy) && near(a.zz, b.zz) && near(a.xy, b.xy) &&
           near(a.xz, b.xz) && near(a.yz, b.yz);
  }
  /// q and -q are the same turn.
  bool operator()(const Quat& a, const Quat& b) const {
    const Vec3 x{1, 0, 0}, y{0, 1, 0};
    return (*this)(Rotate(a, x), Rotate(b, x)) && (*this)(Rotate(a, y), Rotate(b, y));
  }
};

/// The points that a joint holds together become one node. Of parts of a centimetre and more, what
/// that moves is this share.
Nearness NearnessFor(const ModelDef& def) {
  double gap_m = 0;
  for (const JointDef& joint : def.joints) gap_m = std::max(gap_m, HeldGap(joint));
  return {std::max(kRounding, 100 * gap_m)};
}

bool Same(const Material& a, const Material& b, const Nearness& near) {
  if (a.stribeck.has_value() != b.stribeck.has_value() ||
      a.directions.has_value() != b.directions.has_value()) {
    return false;
  }
  if (a.stribeck &&
      (a.stribeck->speed_m_per_s != b.stribeck->speed_m_per_s ||
       a.stribeck->viscous_friction_s_per_m != b.stribeck->viscous_friction_s_per_m)) {
    return false;
  }
  if (a.directions && (a.directions->forward != b.directions->forward ||
                       a.directions->backward != b.directions->backward ||
                       a.directions->sideways != b.directions->sideways ||
                       !near(a.directions->axis, b.directions->axis))) {
    return false;
  }
  return a.static_friction == b.static_friction && a.kinetic_friction == b.kinetic_friction &&
         a.restitution == b.restitution;
}
bool Same(const ActuatorDef& a, const ActuatorDef& b) {
  if (a.kind != b.kind || a.kind == ActuatorDef::Kind::kNone) return a.kind == b.kind;
  if (a.kind == ActuatorDef::Kind::kIdeal) return true;
  if (a.kind == ActuatorDef::Kind::kDcMotor) {
    return a.min_rest_length_m == b.min_rest_length_m && a.dc_motor == b.dc_motor;
  }
  return a.max_speed_m_per_s == b.max_speed_m_per_s &&
         a.max_acceleration_m_per_s2 == b.max_acceleration_m_per_s2 &&
         a.max_force_n == b.max_force_n && a.min_rest_length_m == b.min_rest_length_m &&
         a.min_length_m == b.min_length_m;
}
bool Same(const JointDef& a, const JointDef& b, const Nearness& near) {
  // Nothing acts about the axis of a ball without a stop; those of rods of `class_k` have no say.
  const bool free = a.kind == JointKind::kBall && !a.most;
  const bool along = free || (near(a.axis, b.axis) && near(a.turned, b.turned));
  return a.kind == b.kind && along && a.least == b.least && a.most == b.most &&
         a.restitution == b.restitution && a.friction == b.friction && a.stiffness == b.stiffness &&
         a.damping == b.damping && a.rest == b.rest && a.collides == b.collides;
}
bool Same(const MemberDef& a, const MemberDef& b) {
  return a.area_m2 == b.area_m2 && a.young_pa == b.young_pa &&
         a.second_moment_m4 == b.second_moment_m4 && a.buckling_length_m == b.buckling_length_m &&
         a.yield_pa == b.yield_pa && a.strength_n == b.strength_n &&
         a.expansion_per_k == b.expansion_per_k && a.mass_kg == b.mass_kg && a.mass == b.mass;
}
bool Same(Tags a, Tags b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

class Comparison {
 public:
  Comparison(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out)
      : robot_(robot),
        a_(robot.def),
        b_(read.def),
        read_(read),
        out_(out),
        near_(NearnessFor(a_)) {}

  bool Run() {
    Bodies();
    Shapes("sphere", a_.spheres, b_.spheres, [&](const SphereDef& x, const SphereDef& y) {
      return x.radius_m == y.radius_m && near_(x.center_m, y.center_m);
    });
    Shapes("rod", a_.capsules, b_.capsules, [&](const CapsuleDef& x, const CapsuleDef& y) {
      return x.radius_m == y.radius_m && near_(x.from_m, y.from_m) && near_(x.to_m, y.to_m);
    });
    std::vector<BoxDef> boxes = a_.boxes;
    std::erase_if(boxes, [&](const BoxDef& box) { return IsTerrain(a_, box.body); });
    Shapes("box", boxes, b_.boxes, [&](const BoxDef& x, const BoxDef& y) {
      return near_(x.center_m, y.center_m) && near_(x.orientation, y.orientation) &&
             near_(x.half_extents_m, y.half_extents_m);
    });
    Nodes();
    Cables();
    Joints();
    return good_;
  }

 private:
  void Differs(const char* kind, const std::string& name, const char* what) {
    if (!good_) return;
    good_ = false;
    RefuseModel(out_, std::string("the ") + kind + " \"" + name + "\" would have another " + what);
  }

  template <class Items, class OtherItems>
  bool SameCount(const char* kind, const Items& a, const OtherItems& b) {
    if (a.size() == b.size()) return true;
    if (good_) {
      RefuseModel(out_, "it would have " + std::to_string(b.size()) + " of kind " + kind +
                            ", not " + std::to_string(a.size()));
    }
    return good_ = false;
  }

  std::string NameOf(const ModelDef& def, int body) const {
    return body == kWorld ? "" : def.bodies[static_cast<std::size_t>(body)].name;
  }

  void Bodies() {
    std::vector<int> bodies;  // of the robot
    for (int i = 0; i < static_cast<int>(a_.bodies.size()); ++i) {
      if (!IsTerrain(a_, i)) bodies.push_back(i);
    }
    if (!SameCount("body", bodies, b_.bodies)) return;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const BodyDef &x = a_.bodies[static_cast<std::size_t>(bodies[i])], &y = b_.bodies[i];
      if (x.name != y.name) Differs("body", x.name, "name");
      if (IsAnchored(a_, bodies[i]) != y.fixed) Differs("body", x.name, "anchor");
      if (!near_(x.mass_kg, y.mass_kg, 0)) Differs("body", x.name, "mass");
      if (!near_(x.com_m, y.com_m)) Differs("body", x.name, "centre of mass");
      if (!near_(x.inertia_kg_m2, y.inertia_kg_m2, x)) Differs("body", x.name, "inertia");
    }
  }

  /// Calls `compare` with the places of every part and of the one read back that has its name.
  template <class Part, class F>
  void ByName(const char* kind, const std::vector<Part>& a, const std::vector<Part>& b, F compare) {
    std::map<std::string, std::size_t> read;
    for (std::size_t k = 0; k < b.size(); ++k) read[b[k].name] = k;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto found = read.find(a[i].name);
      if (found == read.end()) {
        Differs(kind, a[i].name, "name");
      } else {
        compare(i, found->second);
      }
    }
  }

  template <class Shape>
  static bool SameMember(const Shape& x, const Shape& y) {
    if constexpr (requires { x.member; }) return Same(x.member, y.member);
    return true;
  }

  template <class Shape, class F>
  void Shapes(const char* kind, const std::vector<Shape>& a, const std::vector<Shape>& b, F same) {
    if (!SameCount(kind, a, b)) return;
    ByName(kind, a, b, [&](std::size_t i, std::size_t k) {
      const Shape &x = a[i], &y = b[k];
      if (NameOf(a_, x.body) != NameOf(b_, y.body)) {
        Differs(kind, x.name, "body");
      } else if (!same(x, y)) {
        Differs(kind, x.name, "place");
      } else if (!SameMember(x, y)) {
        Differs(kind, x.name, "section or limit");
      } else if (!Same(x.material, y.material, near_) || x.collides != y.collides) {
        Differs(kind, x.name, "surface");
      }
    });
  }

  void Nodes() {
    ByName("node", a_.nodes, b_.nodes, [&](std::size_t i, std::size_t k) {
      const NodeDef &x = a_.nodes[i], &y = b_.nodes[k];
      if (NameOf(a_, x.body) != NameOf(b_, y.body)) Differs("node", x.name, "body");
      if (!near_(x.position_m, y.position_m)) Differs("node", x.name, "place");
      if (!Same(robot_.node_tags[i], read_.node_tags[k])) {
        Differs("node", x.name, "list of tags");
      }
    });
  }

  void Cables() {
    if (!SameCount("cable", a_.cables, b_.cables)) return;
    ByName("cable", a_.cables, b_.cables, [&](std::size_t i, std::size_t k) {
      const CableDef &x = a_.cables[i], &y = b_.cables[k];
      bool same_path = x.attachments.size() == y.attachments.size();
      for (std::size_t j = 0; same_path && j < x.attachments.size(); ++j) {
        same_path = near_(x.attachments[j].position_m, y.attachments[j].position_m) &&
                    NameOf(a_, x.attachments[j].body) == NameOf(b_, y.attachments[j].body);
      }
      if (!same_path) Differs("cable", x.name, "path");
      if (!near_(x.rest_length_m, y.rest_length_m, 0)) Differs("cable", x.name, "rest length");
      if (x.stiffness_n_per_m != y.stiffness_n_per_m ||
          x.damping_n_s_per_m != y.damping_n_s_per_m || x.damping_law != y.damping_law ||
          x.touches != y.touches || x.radius_m != y.radius_m ||
          x.touch_friction != y.touch_friction) {
        Differs("cable", x.name, "stiffness or damper");
      }
      if (!Same(x.member, y.member)) Differs("cable", x.name, "section, mass or limit");
      if (!Same(x.actuator, y.actuator)) Differs("cable", x.name, "actuator");
      if (!Same(robot_.cable_tags[i], read_.cable_tags[k])) {
        Differs("cable", x.name, "list of tags");
      }
    });
  }

  void Joints() {
    if (!SameCount("joint", a_.joints, b_.joints)) return;
    ByName("joint", a_.joints, b_.joints, [&](std::size_t i, std::size_t k) {
      const JointDef &x = a_.joints[i], &y = b_.joints[k];
      if (NameOf(a_, x.body_a) != NameOf(b_, y.body_a) ||
          NameOf(a_, x.body_b) != NameOf(b_, y.body_b)) {
        Differs("joint", x.name, "pair of bodies");
      } else if (!near_(x.from_m, y.from_m) || !near_(x.to_m, y.to_m)) {
        Differs("joint", x.name, "place");
      } else if (!Same(x, y, near_)) {
        Differs("joint", x.name, "kind, axis or force");
      } else if (!Same(x.member, y.member)) {
        Differs("joint", x.name, "section, mass or limit");
      }
    });
    const auto apart = [&](const ModelDef& def) {
      std::set<std::pair<std::string, std::string>> names;
      for (const ApartDef& pair : def.apart) {
        names.insert(std::minmax({NameOf(def, pair.body_a), NameOf(def, pair.body_b)}));
      }
      return names;
    };
    if (good_ && apart(a_) != apart(b_)) {
      good_ = false;
      RefuseModel(out_, "other bodies would be kept apart");
    }
  }

  const RobotSpec& robot_;
  const ModelDef &a_, &b_;
  const RobotSpec& read_;
  Diagnostics& out_;
  const Nearness near_;
  bool good_ = true;
};

}  // namespace

bool CheckReadBack(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out) {
  return Comparison(robot, read, out).Run();
}

}  // namespace taut::description
