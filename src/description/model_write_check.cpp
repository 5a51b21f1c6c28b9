// Whether a robot is still the same after it was written and read back.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/model_write.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// What rounding may change, of the size of a number and of the distances that go into it.
constexpr double kRounding = 1e-12;

bool Near(double a, double b, double size) {
  return a == b || std::fabs(a - b) <= kRounding * std::max(std::fabs(a), size);
}
bool Near(const Vec3& a, const Vec3& b) {
  const double size = std::max({1.0, std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
  return Near(a.x, b.x, size) && Near(a.y, b.y, size) && Near(a.z, b.z, size);
}
/// Between bodies far from the origin and their parts digits are lost.
bool Near(const Inertia& a, const Inertia& b, const BodyDef& body) {
  const Vec3& c = body.com_m;
  const double size = a.xx + a.yy + a.zz + 1e-3 * body.mass_kg * std::sqrt(Dot(c, c));
  return Near(a.xx, b.xx, size) && Near(a.yy, b.yy, size) && Near(a.zz, b.zz, size) &&
         Near(a.xy, b.xy, size) && Near(a.xz, b.xz, size) && Near(a.yz, b.yz, size);
}
/// q and -q are the same turn.
bool Near(const Quat& a, const Quat& b) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0};
  return Near(Rotate(a, x), Rotate(b, x)) && Near(Rotate(a, y), Rotate(b, y));
}
bool Same(const Material& a, const Material& b) {
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
                       !Near(a.directions->axis, b.directions->axis))) {
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
bool Same(Tags a, Tags b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

class Comparison {
 public:
  Comparison(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out)
      : robot_(robot), a_(robot.def), b_(read.def), read_(read), out_(out) {}

  bool Run() {
    Bodies();
    Shapes("sphere", a_.spheres, b_.spheres, [](const SphereDef& x, const SphereDef& y) {
      return x.radius_m == y.radius_m && Near(x.center_m, y.center_m);
    });
    Shapes("rod", a_.capsules, b_.capsules, [](const CapsuleDef& x, const CapsuleDef& y) {
      return x.radius_m == y.radius_m && Near(x.from_m, y.from_m) && Near(x.to_m, y.to_m);
    });
    Shapes("box", a_.boxes, b_.boxes, [](const BoxDef& x, const BoxDef& y) {
      return Near(x.center_m, y.center_m) && Near(x.orientation, y.orientation) &&
             Near(x.half_extents_m, y.half_extents_m);
    });
    Nodes();
    Cables();
    return good_;
  }

 private:
  void Differs(const char* kind, const std::string& name, const char* what) {
    if (!good_) return;
    good_ = false;
    RefuseModel(out_, std::string("the ") + kind + " \"" + name + "\" would have another " + what);
  }

  template <class Items>
  bool SameCount(const char* kind, const Items& a, const Items& b) {
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
    if (!SameCount("body", a_.bodies, b_.bodies)) return;
    for (std::size_t i = 0; i < a_.bodies.size(); ++i) {
      const BodyDef &x = a_.bodies[i], &y = b_.bodies[i];
      if (x.name != y.name) Differs("body", x.name, "name");
      if (x.fixed != y.fixed) Differs("body", x.name, "anchor");
      if (!Near(x.mass_kg, y.mass_kg, 0)) Differs("body", x.name, "mass");
      if (!Near(x.com_m, y.com_m)) Differs("body", x.name, "centre of mass");
      if (!Near(x.inertia_kg_m2, y.inertia_kg_m2, x)) Differs("body", x.name, "inertia");
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

  template <class Shape, class F>
  void Shapes(const char* kind, const std::vector<Shape>& a, const std::vector<Shape>& b, F same) {
    if (!SameCount(kind, a, b)) return;
    ByName(kind, a, b, [&](std::size_t i, std::size_t k) {
      const Shape &x = a[i], &y = b[k];
      if (NameOf(a_, x.body) != NameOf(b_, y.body)) {
        Differs(kind, x.name, "body");
      } else if (!same(x, y)) {
        Differs(kind, x.name, "place");
      } else if (!Same(x.material, y.material) || x.collides != y.collides) {
        Differs(kind, x.name, "surface");
      }
    });
  }

  void Nodes() {
    ByName("node", a_.nodes, b_.nodes, [&](std::size_t i, std::size_t k) {
      const NodeDef &x = a_.nodes[i], &y = b_.nodes[k];
      if (NameOf(a_, x.body) != NameOf(b_, y.body)) Differs("node", x.name, "body");
      if (!Near(x.position_m, y.position_m)) Differs("node", x.name, "place");
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
        same_path = Near(x.attachments[j].position_m, y.attachments[j].position_m) &&
                    NameOf(a_, x.attachments[j].body) == NameOf(b_, y.attachments[j].body);
      }
      if (!same_path) Differs("cable", x.name, "path");
      if (!Near(x.rest_length_m, y.rest_length_m, 0)) Differs("cable", x.name, "rest length");
      if (x.stiffness_n_per_m != y.stiffness_n_per_m ||
          x.damping_n_s_per_m != y.damping_n_s_per_m || x.damping_law != y.damping_law) {
        Differs("cable", x.name, "stiffness or damper");
      }
      if (!Same(x.actuator, y.actuator)) Differs("cable", x.name, "actuator");
      if (!Same(robot_.cable_tags[i], read_.cable_tags[k])) {
        Differs("cable", x.name, "list of tags");
      }
    });
  }

  const RobotSpec& robot_;
  const ModelDef &a_, &b_;
  const RobotSpec& read_;
  Diagnostics& out_;
  bool good_ = true;
};

}  // namespace

bool CheckReadBack(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out) {
  return Comparison(robot, read, out).Run();
}

}  // namespace taut::description
