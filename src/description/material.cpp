#include "description/material.h"

#include <cmath>

#include "math/elementary.h"
#include "math/vec.h"

namespace taut::description {
namespace {

Quat Normalized(const Quat& q) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Vec3 ReadAxis(const Value& value, std::string_view what, const Scope& scope) {
  if (value.kind == Value::Kind::kScalar) {
    return ReadChoice<Vec3>(value, what, {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}},
                            scope)
        .value_or(Vec3{0, 0, 1});
  }
  return ReadDirection(value, what, scope);
}

Quat ReadOneRotation(const Value& value, const std::string& what, const Scope& scope) {
  const MapReader map(value, what, {"axis", "angle_rad", "quaternion"}, scope);
  if (const Value* quaternion = map.Find("quaternion")) {
    if (map.Has("axis") || map.Has("angle_rad")) {
      map.Error("quaternion", what + " has both a quaternion and an axis or angle",
                "only one of them may be there");
    }
    const auto q = ReadNumbers(*quaternion, map.Path("quaternion"), 4, scope);
    if (!q) return {};
    const double square =
        (*q)[0] * (*q)[0] + (*q)[1] * (*q)[1] + (*q)[2] * (*q)[2] + (*q)[3] * (*q)[3];
    if (!(square > 1e-12) || std::isinf(square)) {
      scope.out.Error(quaternion->at, map.Path("quaternion") + " must not be zero",
                      "order w, x, y, z");
      return {};
    }
    return Normalized({(*q)[0], (*q)[1], (*q)[2], (*q)[3]});
  }
  const double angle = map.Number("angle_rad", Bound::kAny);
  const Value* axis_value = map.Require("axis");
  if (!axis_value || !(std::fabs(angle) <= math::kMaxAngle)) {
    if (std::fabs(angle) > math::kMaxAngle)
      map.Error("angle_rad", map.Path("angle_rad") + " is too large");
    return {};
  }
  const Vec3 v = math::Sin(0.5 * angle) * ReadAxis(*axis_value, map.Path("axis"), scope);
  return {math::Cos(0.5 * angle), v.x, v.y, v.z};
}

}  // namespace

Material ReadMaterial(const MapReader& map) {
  Material material;
  if (const auto friction = map.FindNumber("friction", Bound::kNonNegative)) {
    material.static_friction = material.kinetic_friction = *friction;
    for (const char* other : {"static_friction", "kinetic_friction"}) {
      if (map.Has(other)) {
        map.Error(other, map.Path("friction") + " already says what " + other + " is",
                  "friction alone, or static_friction and kinetic_friction");
      }
    }
  } else if (map.Has("static_friction") || map.Has("kinetic_friction")) {
    material.static_friction = map.Number("static_friction", Bound::kNonNegative);
    material.kinetic_friction = map.Number("kinetic_friction", Bound::kNonNegative);
    if (material.static_friction < material.kinetic_friction) {
      map.Error("static_friction", map.Path("static_friction") + " is below kinetic_friction",
                "a contact that sticks holds at least as much as one that slides");
    }
  }
  material.restitution = map.NumberOr("restitution", material.restitution, Bound::kFraction);
  return material;
}

Quat ReadRotation(const Value& value, std::string_view what, const Scope& scope) {
  const std::string name(what);
  if (value.kind != Value::Kind::kSequence) return ReadOneRotation(value, name, scope);
  Quat q;
  for (const ValuePtr& item : value.items) q = Normalized(ReadOneRotation(*item, name, scope) * q);
  return q;
}

}  // namespace taut::description
