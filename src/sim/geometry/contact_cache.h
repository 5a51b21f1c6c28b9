/// Cache of the parts of a height field near a rod or a ball, kept from step to step: while the
/// shape has moved by less than a slack, only these parts are tested (surface_parts.h).
///
/// Parts that are left out can have no contact from any place within the slack, so results are the
/// same to the bit with and without the cache, whenever it was filled: it is no part of the state.
#pragma once

#include "math/vec.h"

namespace taut::sim {

struct SurfaceTable;
/// Returns how far a rod may move before its cache is invalid [m].
double SlackOf(const SurfaceTable& s) noexcept;

/// A triangle, an edge or a corner of a field.
struct SurfacePart {
  enum Kind { kFirstFace, kSecondFace, kEdgeX, kEdgeY, kDiagonal, kCorner };
  static constexpr int kFarthest = 4095;  ///< Largest offset from the list's cell [cells].
  short di, dj_kind;                      ///< 8 dj + kind
};

/// Relevant parts, in the order in which a search finds them.
template <int kMost>
struct PartList {
  static constexpr int kTooMany = kMost + 1;
  int count;  ///< Or kTooMany.
  int i, j;   ///< Reference cell of the offsets.
  SurfacePart parts[kMost];
};

/// Zero-initialized: empty.
struct NearParts {
  static constexpr int kMostOfEnd = 8, kMostBetween = 24;
  /// A cache that served fewer looks than this is discarded, and refilled only after as many more
  /// looks.
  static constexpr int kFewLooks = 4;
  using OfEnd = PartList<kMostOfEnd>;
  using Between = PartList<kMostBetween>;

  Vec3 from, to;   ///< Centerline when the cache was filled [m].
  double limit_m;  ///< Valid for any limit up to this; 0: empty.
  int looks;       ///< Looks that it served since, or that passed while it was empty.
  bool by_x;       ///< Order of the parts: along x, else along y.
  bool above[2];   ///< Within the slack, the end is above the whole field around it.
  bool over;       ///< Within the slack, the line is under no edge.
  OfEnd ends[2];
  Between between;
};

}  // namespace taut::sim
