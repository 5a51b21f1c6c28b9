#include "description/model/described_rotation.h"

#include <cmath>

#include "description/yaml/read_keys.h"
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

Quat ReadQuaternion(const Value& value, const std::string& path, const Scope& scope) {
  const auto q = ReadNumbers(value, path, 4, scope);
  if (!q) return {};
  const double square =
      (*q)[0] * (*q)[0] + (*q)[1] * (*q)[1] + (*q)[2] * (*q)[2] + (*q)[3] * (*q)[3];
  if (!(square > 1e-12) || std::isinf(square)) {
    scope.out.Error("rotation.zero", value.at, path + " must not be zero", "expected [w, x, y, z]");
    return {};
  }
  const Quat read{(*q)[0], (*q)[1], (*q)[2], (*q)[3]};
  // Keep a quaternion of length 1 (up to rounding) unchanged, so that files written by taut are
  // read back bit for bit.
  return std::fabs(square - 1.0) < 1e-15 ? read : Normalized(read);
}

Quat ReadOneRotation(const Value& value, const std::string& path, const Scope& scope) {
  RotationText rotation;
  ReadMapping(value, path, scope, rotation);
  return rotation.q;
}

}  // namespace

void Check(const MapReader& map, RotationText& rotation) {
  if (const Value* quaternion = rotation.quaternion.value) {
    if (map.Has("axis") || map.Has("angle_rad")) {
      map.Error("rotation.given_twice", "quaternion",
                map.what() + " has both a quaternion and an axis or angle",
                "give only one of them");
    }
    rotation.q = ReadQuaternion(*quaternion, map.Path("quaternion"), map.scope());
    return;
  }
  const Value* axis_value = map.Require("axis");
  if (!map.Require("angle_rad") || !axis_value) return;
  const double angle = *rotation.angle_rad;
  if (std::fabs(angle) > math::kMaxAngle)
    map.Error("rotation.too_large", "angle_rad", map.Path("angle_rad") + " is too large");
  const Vec3 axis = ReadAxis(*axis_value, map.Path("axis"), map.scope());
  if (!(std::fabs(angle) <= math::kMaxAngle)) return;
  const Vec3 v = math::Sin(0.5 * angle) * axis;
  rotation.q = {math::Cos(0.5 * angle), v.x, v.y, v.z};
}

Quat ReadRotation(const Value& value, std::string_view what, const Scope& scope) {
  const std::string path(what);
  if (value.kind != Value::Kind::kSequence) return ReadOneRotation(value, path, scope);
  Quat q;
  for (const ValuePtr& item : value.items) q = Normalized(ReadOneRotation(*item, path, scope) * q);
  return q;
}

}  // namespace taut::description
