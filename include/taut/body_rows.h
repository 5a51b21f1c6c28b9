/// Bodies of many worlds where a batch keeps them, without a copy: what `Batch::Cables` is for
/// cables.
///
/// Threads: as functions of a batch that are not const; reading where the rows point to as those
/// that are.
#pragma once

#include <cstddef>

#include "taut/batch.h"

namespace taut {

/// Bodies of the worlds that share a register: number i (x, y, z) of body b of world
/// `first_world + j` is at [(3 * b + i) * lanes + j]. Points into the batch: what is read there is
/// always of now, also of bodies that a motion moves.
struct BodyRows {
  int lanes = 1, first_world = 0;
  const double* position_m = nullptr;        ///< Of the centres of mass, in W.
  const double* velocity_m_per_s = nullptr;  ///< Of the same, in W.
};

/// All bodies of group `group` (`Batch::groups`); out of range it is a mistake of the caller, as in
/// `Batch`.
BodyRows RowsOfBodies(Batch& batch, int group) noexcept;

/// By how many numbers a row of a group lies before the same row of the next one: what
/// `Batch::Cables` and `RowsOfBodies` give of group g is g times this behind what they give of
/// group 0. 0 if there is one group. Never changes.
std::ptrdiff_t GroupStride(Batch& batch) noexcept;

}  // namespace taut
