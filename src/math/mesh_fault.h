/// What is wrong with triangles that are to be ground.
#pragma once

#include <cstddef>
#include <vector>

#include "taut/model_def.h"

namespace taut::math {

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
/// have none.
std::vector<MeshFault> FindFaults(const TerrainMeshDef& mesh, std::size_t most);

}  // namespace taut::math
