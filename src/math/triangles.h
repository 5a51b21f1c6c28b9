/// Triangles with common corners: what they enclose, and what is wrong with them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "taut/types.h"

namespace taut::math {

using Triangles = std::vector<std::array<int, 3>>;

/// Six times the signed volume that the triangles enclose, by the divergence theorem.
double SixVolumes(const std::vector<Vec3>& corners_m, const Triangles& triangles);

struct MeshFault {
  enum class Kind {
    kNoCorner,   ///< A triangle refers to a corner that is not there.
    kNoArea,     ///< The corners of a triangle are on a line.
    kOpen,       ///< An edge of a closed mesh has one triangle only.
    kCrowded,    ///< An edge of a closed mesh has two triangles on one side, or more than two.
    kInsideOut,  ///< A closed mesh has its outside within.
  };
  Kind kind;
  int triangle = -1;       ///< One that has the fault; -1: all.
  int from = -1, to = -1;  ///< Corners of an edge.
};

/// The first faults, `most` at most. Corners must be finite. Edges are looked at where triangles
/// have none, and only if they are to be `closed`.
std::vector<MeshFault> FindFaults(const std::vector<Vec3>& corners_m, const Triangles& triangles,
                                  bool closed, std::size_t most);

}  // namespace taut::math
