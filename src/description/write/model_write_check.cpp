// Comparison of a robot with its copy after writing and reading a model file.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/write/model_write.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// Tolerance of rounding, relative to the number or to the distances from which it is computed.
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
  /// The tolerance grows with the body's distance from the origin because of cancellation.
  bool operator()(const Inertia& a, const Inertia& b, const BodyDef& body) const {
    const Vec3& c = body.com_m;
    const double size = a.xx + a.yy + a.zz + 1e-3 * body.mass_kg * std::sqrt(Dot(c, c));
    const auto near = [&](double x, double y) { return (*this)(x, y, size); };
    return near(a.xx, b.xx) && near(a.yy, b.yy) && near(a.zz, b.zz) && near(a.xy, b.xy) &&
           near(a.xz, b.xz) && near(a.yz, b.yz);
  }
  /// q and -q are the same orientation.
  bool operator()(const Quat& a, const Quat& b) const {
    const Vec3 x{1, 0, 0}, y{0, 1, 0};
    return (*this)(Rotate(a, x), Rotate(b, x)) && (*this)(Rotate(a, y), Rotate(b, y));
  }
};

/// Tolerance for a robot with joints. The writer merges the two points of a joint into one node,
/// which moves them by up to the gap. For parts of at least 1 cm, the relative change is at most
/// gap / 1 cm.
Nearness NearnessFor(const ModelDef& def) {
  double gap_m = 0;
  for (const JointDef& joint : def.joints) gap_m = std::max(gap_m, JointError(joint));
  return {std::max(kRounding, 100 * gap_m)};
}

// Each `Same` first handles fields that rounding may change or that have no effect. Then operator==
// compares all other fields exactly, including fields added in future.
bool Same(const Material& a, Material b, const Nearness& near) {
  if (a.directions && b.directions && near(a.directions->axis, b.directions->axis)) {
    b.directions->axis = a.directions->axis;
  }
  return a == b;
}
bool Same(const ActuatorDef& a, ActuatorDef b) {
  if (a.kind != b.kind) return false;
  if (a.kind == ActuatorDef::Kind::kNone || a.kind == ActuatorDef::Kind::kIdeal) return true;
  if (a.kind == ActuatorDef::Kind::kDcMotor) {  // `min_rest_length_m` is the only limit of a DC
                                                // motor
    b.max_speed_m_per_s = a.max_speed_m_per_s;
    b.max_acceleration_m_per_s2 = a.max_acceleration_m_per_s2;
    b.max_force_n = a.max_force_n;
    b.min_length_m = a.min_length_m;
  }
  return a == b;
}
bool Same(const JointDef& a, JointDef b, const Nearness& near) {
  // The axis of a ball joint without a limit has no effect.
  const bool free = a.kind == JointKind::kBall && !a.most;
  if (free || near(a.axis, b.axis)) b.axis = a.axis;
  if (free || near(a.turned, b.turned)) b.turned = a.turned;
  // The caller has compared these fields; bodies are compared by name.
  b.body_a = a.body_a, b.body_b = a.body_b, b.from_m = a.from_m, b.to_m = a.to_m;
  b.member = a.member;
  return a == b;
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
    Shapes("sphere", a_.spheres, b_.spheres, [&](const SphereDef& x, SphereDef& y) {
      return Settle(x.center_m, y.center_m) && x.radius_m == y.radius_m;
    });
    Shapes("rod", a_.capsules, b_.capsules, [&](const CapsuleDef& x, CapsuleDef& y) {
      return Settle(x.from_m, y.from_m) && Settle(x.to_m, y.to_m) && x.radius_m == y.radius_m;
    });
    std::vector<BoxDef> boxes = a_.boxes;
    std::erase_if(boxes, [&](const BoxDef& box) { return IsTerrain(a_, box.body); });
    Shapes("box", boxes, b_.boxes, [&](const BoxDef& x, BoxDef& y) {
      return Settle(x.center_m, y.center_m) && Settle(x.orientation, y.orientation) &&
             Settle(x.half_extents_m, y.half_extents_m);
    });
    Nodes();
    Cables();
    Joints();
    return good_;
  }

 private:
  /// Returns whether a and b are equal up to rounding. If so, sets b to a, so that operator==
  /// compares the other fields only.
  template <class T>
  bool Settle(const T& a, T& b) const {
    if (!near_(a, b)) return false;
    b = a;
    return true;
  }

  void Differs(const char* kind, const std::string& name, const char* what) {
    if (!good_) return;
    good_ = false;
    RefuseModel(out_,
                std::string("the ") + kind + " \"" + name + "\" would have a different " + what);
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
    std::vector<int> bodies;  // bodies except boxes of the terrain
    for (int i = 0; i < static_cast<int>(a_.bodies.size()); ++i) {
      if (!IsTerrain(a_, i)) bodies.push_back(i);
    }
    if (!SameCount("body", bodies, b_.bodies)) return;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const BodyDef& x = a_.bodies[static_cast<std::size_t>(bodies[i])];
      BodyDef y = b_.bodies[i];
      if (x.name != y.name) Differs("body", x.name, "name");
      if (IsAnchored(a_, bodies[i]) != y.fixed) Differs("body", x.name, "anchor");
      y.fixed = x.fixed;
      if (!near_(x.mass_kg, y.mass_kg, 0)) Differs("body", x.name, "mass");
      y.mass_kg = x.mass_kg;
      if (!Settle(x.com_m, y.com_m)) Differs("body", x.name, "center of mass");
      if (!near_(x.inertia_kg_m2, y.inertia_kg_m2, x)) Differs("body", x.name, "inertia");
      y.inertia_kg_m2 = x.inertia_kg_m2;
      // Model files contain no velocities.
      y.velocity_m_per_s = x.velocity_m_per_s;
      y.angular_velocity_rad_per_s = x.angular_velocity_rad_per_s;
      if (x != y) Differs("body", x.name, "value");
    }
  }

  /// Calls `compare(i, k)` for every part a[i] and the part b[k] with the same name.
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

  template <class Shape, class F>
  void Shapes(const char* kind, const std::vector<Shape>& a, const std::vector<Shape>& b,
              F settle_place) {
    if (!SameCount(kind, a, b)) return;
    ByName(kind, a, b, [&](std::size_t i, std::size_t k) {
      const Shape& x = a[i];
      Shape y = b[k];
      if (NameOf(a_, x.body) != NameOf(b_, y.body)) return Differs(kind, x.name, "body");
      y.body = x.body;
      if (!settle_place(x, y)) return Differs(kind, x.name, "position");
      if constexpr (requires { x.member; }) {
        if (x.member != y.member) return Differs(kind, x.name, "section or limit");
      }
      if (!Same(x.material, y.material, near_) || x.collides != y.collides) {
        return Differs(kind, x.name, "surface");
      }
      y.material = x.material;
      if (x != y) Differs(kind, x.name, "value");
    });
  }

  void Nodes() {
    ByName("node", a_.nodes, b_.nodes, [&](std::size_t i, std::size_t k) {
      const NodeDef& x = a_.nodes[i];
      NodeDef y = b_.nodes[k];
      if (NameOf(a_, x.body) != NameOf(b_, y.body)) Differs("node", x.name, "body");
      y.body = x.body;
      if (!Settle(x.position_m, y.position_m)) Differs("node", x.name, "position");
      if (x != y) Differs("node", x.name, "value");
      if (!Same(robot_.node_tags[i], read_.node_tags[k])) {
        Differs("node", x.name, "list of tags");
      }
    });
  }

  void Cables() {
    if (!SameCount("cable", a_.cables, b_.cables)) return;
    ByName("cable", a_.cables, b_.cables, [&](std::size_t i, std::size_t k) {
      const CableDef& x = a_.cables[i];
      CableDef y = b_.cables[k];
      bool same_path = x.attachments.size() == y.attachments.size();
      for (std::size_t j = 0; same_path && j < x.attachments.size(); ++j) {
        const AttachmentDef& from = x.attachments[j];
        AttachmentDef& to = y.attachments[j];
        same_path =
            Settle(from.position_m, to.position_m) && NameOf(a_, from.body) == NameOf(b_, to.body);
        to.body = from.body;
      }
      if (!same_path) Differs("cable", x.name, "path");
      if (!near_(x.rest_length_m, y.rest_length_m, 0)) Differs("cable", x.name, "rest length");
      y.rest_length_m = x.rest_length_m;
      if (x.member != y.member) Differs("cable", x.name, "section, mass or limit");
      if (!Same(x.actuator, y.actuator)) Differs("cable", x.name, "actuator");
      y.actuator = x.actuator;
      if (x != y) Differs("cable", x.name, "stiffness, damper or other number");
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
        Differs("joint", x.name, "position");
      } else if (!Same(x, y, near_)) {
        Differs("joint", x.name, "kind, axis or force");
      } else if (x.member != y.member) {
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
      RefuseModel(out_, "the lists in `apart` would be different");
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
