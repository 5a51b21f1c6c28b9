/// Cache of the parts of a height field near a rod or a ball. The cache is valid until the shape
/// has moved by more than a slack; until then, only these parts are tested (surface_parts.h).
/// Omitted parts can have no contact within the slack. Therefore results are bit-identical with and
/// without the cache, at any age of the cache, and the cache is not part of the state.
#pragma once

#include "math/vec.h"

namespace taut::sim {

struct SurfaceTable;
/// Returns the slack: how far a rod may move before its cache is invalid [m].
double SlackOf(const SurfaceTable& s) noexcept;

/// Triangle, edge or corner of a field.
struct SurfacePart {
  enum Kind { kFirstFace, kSecondFace, kEdgeX, kEdgeY, kDiagonal, kCorner };
  /// Largest offset from the reference cell of the list [cells].
  static constexpr int kFarthest = 4095;
  short di, dj_kind;  ///< Cell offsets; dj_kind = 8 dj + kind.
};

/// Relevant parts, in the order of the search.
template <int kMost>
struct PartList {
  static constexpr int kTooMany = kMost + 1;
  int count;  ///< Number of parts, or kTooMany.
  int i, j;   ///< Reference cell of the offsets.
  SurfacePart parts[kMost];
};

/// Cache; empty if zero-initialized.
struct NearParts {
  static constexpr int kMostOfEnd = 8, kMostBetween = 24;
  /// Minimum number of uses. A cache with fewer uses is discarded, and refilled only after as many
  /// further searches.
  static constexpr int kFewLooks = 4;
  using OfEnd = PartList<kMostOfEnd>;
  using Between = PartList<kMostBetween>;

  Vec3 from, to;   ///< Centerline when the cache was filled [m].
  double limit_m;  ///< Valid for search limits up to this; 0: empty.
  int looks;       ///< Uses since the cache was filled, or searches while it was empty.
  bool by_x;       ///< Parts are sorted along x; false: along y.
  bool above[2];   ///< Within the slack, this end is above the whole field around it.
  bool over;       ///< Within the slack, the line is below no edge.
  OfEnd ends[2];
  Between between;
};

}  // namespace taut::sim
