/// Direct access to the body positions and velocities of a batch, without a copy: the counterpart
/// of `WorldBatch::Cables` for bodies.
///
/// Threads: these functions count as non-const functions of the batch; reading through the returned
/// pointers counts as a const one.
#pragma once

#include <cstddef>

#include "taut/world_batch.h"

namespace taut {

/// Bodies of the worlds that share a SIMD register: component i (x, y, z) of body b of world
/// `first_world + j` is at [(3 * b + i) * lanes + j]. The pointers lead into the batch, so the
/// values are always current, also of kinematic bodies.
struct BodyRows {
  int lanes = 1, first_world = 0;
  const double* position_m = nullptr;        ///< Centers of mass, in W.
  const double* velocity_m_per_s = nullptr;  ///< Velocities of the centers of mass, in W.
};

/// Returns the rows of all bodies of group `group`, 0 <= group < `WorldBatch::groups`. An index out
/// of range ends the program, as in `WorldBatch`.
BodyRows RowsOfBodies(WorldBatch& batch, int group) noexcept;

/// Returns the distance, in doubles, between the same row of successive groups: a pointer from
/// `WorldBatch::Cables` or `RowsOfBodies` for group g is g times this behind the pointer for group
/// 0. 0 if there is one group. Constant for the life of the batch.
std::ptrdiff_t GroupStride(WorldBatch& batch) noexcept;

}  // namespace taut
