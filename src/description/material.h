/// Friction and restitution, as rods, spheres, boxes and terrain spell them.
#pragma once

#include <string>
#include <vector>

#include "description/reader.h"
#include "taut/model_def.h"

namespace taut::description {

/// The keys that `ReadMaterial` reads, for `MapReader`.
inline const std::vector<std::string> kMaterialKeys{"friction", "static_friction",
                                                    "kinetic_friction", "restitution"};

/// `friction` (static and kinetic are the same), or `static_friction` and `kinetic_friction`;
/// `restitution`. What is missing stays as `Material` has it.
Material ReadMaterial(const MapReader& map);

/// One rotation `{axis: z, angle_rad: pi / 2}` (axis also [x, y, z]), `{quaternion: [w, x, y, z]}`,
/// or a list of them, applied one after the other about the fixed axes of W.
Quat ReadRotation(const Value& value, std::string_view what, const Scope& scope);

}  // namespace taut::description
