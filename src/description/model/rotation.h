/// Rotations as files spell them.
#pragma once

#include <optional>

#include "description/yaml/keys.h"

namespace taut::description {

struct AxisForm {
  static constexpr const char* kSchema =
      R"("title": "x, y, z or [x, y, z]", "oneOf": [{"enum": ["x", "y", "z"]}, )"
      R"({"$ref": "#/$defs/vector"}])";
};
struct QuaternionForm {
  static constexpr const char* kSchema =
      R"("type": "array", "title": "[w, x, y, z]", "items": {"$ref": "#/$defs/number"}, )"
      R"("minItems": 4, "maxItems": 4)";
};

struct RotationText {
  Raw<AxisForm> axis;
  std::optional<double> angle_rad;
  Raw<QuaternionForm> quaternion;
  Quat q;  ///< The rotation; none after a complaint.
};
template <class Io>
void Keys(Io& io, Like<RotationText> auto& r) {
  io.Map("", "rotation",
         "One rotation: `axis` and `angle_rad`, or `quaternion`. Wherever a rotation is asked for, "
         "a list of rotations may stand, which follow each other, all about the fixed axes of the "
         "world.",
         R"({"axis": "z", "angle_rad": "pi / 2"})");
  io.Rule(R"("oneOf": [{"required": ["axis", "angle_rad"]}, {"required": ["quaternion"]}])");
  io("axis", r.axis, "Axis in the world frame; any length but zero. Right-handed.");
  io("angle_rad", r.angle_rad, "Angle.");
  io("quaternion", r.quaternion, "A quaternion of any length but zero.");
}
void Check(const MapReader& map, RotationText& rotation);

}  // namespace taut::description
