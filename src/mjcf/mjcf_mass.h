/// Masses of MJCF bodies: sums over geoms, and the lower bounds in MuJoCo's compiler settings.
#pragma once

#include <cstddef>

#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {

/// Returns the volume of a sphere, capsule, cylinder or box [m^3]; 0 for planes.
double VolumeOf(const Shape& shape);

/// Sets a body's mass to the sum of its shapes. These must be the last shapes of the scene, from
/// index `first`. A search through all shapes for each body would take quadratic time.
void SumMassOfShapes(Scene& scene, int body, std::size_t first);

/// Applies the lower bounds `boundmass` and `boundinertia` to a moving body.
void BoundMass(Scene& scene, int body);

}  // namespace taut::mjcf
