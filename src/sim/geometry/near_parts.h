/// What of a field is near a rod or a ball, kept from step to step: as long as it has moved by less
/// than a slack, only that is looked at again (surface_parts.h).
///
/// What is left out could have had no contact from anywhere within the slack, so what is found is
/// the same, to the bit, whether anything was kept or not, and whenever: nothing of it is state.
#pragma once

#include "math/vec.h"

namespace taut::sim {

struct SurfaceTable;
/// So far a rod may move before it is looked up anew [m].
double SlackOf(const SurfaceTable& s) noexcept;

/// A triangle, an edge or a corner of a field.
struct SurfacePart {
  enum Kind { kFirstFace, kSecondFace, kEdgeX, kEdgeY, kDiagonal, kCorner };
  static constexpr int kFarthest =
      4095;           ///< From a cell that all parts of a list are near [cells].
  short di, dj_kind;  ///< 8 dj + kind
};

/// Those that count, in the order in which a search comes by them.
template <int kMost>
struct PartList {
  static constexpr int kTooMany = kMost + 1;
  int count;  ///< Or kTooMany.
  int i, j;   ///< The cell.
  SurfacePart parts[kMost];
};

/// Zeros: nothing is known.
struct NearParts {
  static constexpr int kMostOfEnd = 8, kMostBetween = 24;
  /// What did not serve so often is not kept anew before so many more looks have gone by.
  static constexpr int kFewLooks = 4;
  using OfEnd = PartList<kMostOfEnd>;
  using Between = PartList<kMostBetween>;

  Vec3 from, to;   ///< Of the centre line when it was looked at [m].
  double limit_m;  ///< For any limit up to this; 0: nothing is kept.
  int looks;       ///< That it served for since, or that went by without it.
  bool by_x;       ///< In which order.
  bool above[2];   ///< The end is above all that is below it, within the slack;
  bool over;       ///< the line is under no edge.
  OfEnd ends[2];
  Between between;
};

}  // namespace taut::sim
