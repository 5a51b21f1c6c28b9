/// Triangle meshes with shared corners: enclosed volume, and checks for faults.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "taut/types.h"

namespace taut::math {

using Triangles = std::vector<std::array<int, 3>>;

/// Returns six times the signed volume enclosed by the triangles (divergence theorem).
double SixVolumes(const std::vector<Vec3>& corners_m, const Triangles& triangles);

struct MeshFault {
  enum class Kind {
    kNoCorner,   ///< A triangle refers to a nonexistent corner.
    kNoArea,     ///< The corners of a triangle are collinear.
    kOpen,       ///< An edge of a closed mesh has only one triangle.
    kCrowded,    ///< An edge of a closed mesh has two triangles on one side, or more than two.
    kInsideOut,  ///< The triangles of a closed mesh face inward.
  };
  Kind kind;
  int triangle = -1;       ///< Triangle with the fault; -1: all.
  int from = -1, to = -1;  ///< Corners of a faulty edge.
};

/// Returns the first faults, at most `most`. Corners must be finite. Edges are checked only if all
/// triangles are valid and the mesh must be `closed`.
std::vector<MeshFault> FindFaults(const std::vector<Vec3>& corners_m, const Triangles& triangles,
                                  bool closed, std::size_t most);

}  // namespace taut::math
