/// Triangles that enclose a solid.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "taut/types.h"

namespace taut::math {

using Triangles = std::vector<std::array<int, 3>>;

/// Six times the signed volume that the triangles enclose, by the divergence theorem [m^3].
double SixVolumes(const std::vector<Vec3>& corners_m, const Triangles& triangles);

/// Why they enclose nothing: every edge of a closed mesh belongs to two triangles, which run along
/// it in opposite directions, and corners run counter-clockwise seen from outside. " is not closed:
/// ..." to follow a name; empty if all is well. Corners have to be there.
std::string WhyNotClosed(const std::vector<Vec3>& corners_m, const Triangles& triangles);

}  // namespace taut::math
