/// Direct access to the body positions and velocities of a batch without a copy.
/// `WorldBatch::Cables` gives direct access to cables.
///
/// Threads: these functions count as non-const functions of the batch. Reads through the returned
/// pointers count as const functions.
#pragma once

#include <cstddef>

#include "taut/world_batch.h"

namespace taut {

/// Body data of a group (the worlds that share a SIMD register). Component i (x, y, z) of body b of
/// world `first_world + j` is at [(3 * b + i) * lanes + j]. The pointers refer to memory of the
/// batch, so the values are always current, also for kinematic bodies.
struct BodyRows {
  int lanes = 1, first_world = 0;
  const double* position_m = nullptr;        ///< Centers of mass, in W.
  const double* velocity_m_per_s = nullptr;  ///< Velocities of the centers of mass, in W.
};

/// Returns the rows of all bodies of group `group`, 0 <= group < `WorldBatch::groups`. An index out
/// of range aborts the program, as in `WorldBatch`.
BodyRows RowsOfBodies(WorldBatch& batch, int group) noexcept;

/// Returns the distance, in doubles, between the same rows of successive groups; 0 if there is one
/// group. A pointer from `WorldBatch::Cables` or `RowsOfBodies` for group g is the pointer for
/// group 0 plus g times this distance. Constant for the lifetime of the batch.
std::ptrdiff_t GroupStride(WorldBatch& batch) noexcept;

}  // namespace taut
