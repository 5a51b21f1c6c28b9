/// Rotations in files: axis and angle, or quaternion.
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
  Quat q;  ///< Identity after an error.
};
template <class Io>
void Keys(Io& io, Like<RotationText> auto& r) {
  io.Map("", "rotation",
         "Rotation by `axis` and `angle_rad`, or by `quaternion`. A list of rotations is applied "
         "in order, all about the fixed axes of the world.",
         R"({"axis": "z", "angle_rad": "pi / 2"})");
  io.Rule(R"("oneOf": [{"required": ["axis", "angle_rad"]}, {"required": ["quaternion"]}])");
  io("axis", r.axis, "Rotation axis in the world frame (right-hand rule), of any length but zero.");
  io("angle_rad", r.angle_rad, "Rotation angle.");
  io("quaternion", r.quaternion, "Quaternion of any length but zero.");
}
void Check(const MapReader& map, RotationText& rotation);

}  // namespace taut::description
