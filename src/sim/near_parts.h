/// What of a field is near a rod or a ball, kept from step to step: as long as it has moved by less
/// than a slack, only that is looked at again (surface_parts.h).
///
/// What is left out could have had no contact from anywhere within the slack, so what is found is
/// the same, to the bit, whether anything was kept or not, and whenever: nothing of it is state.
#pragma once

#include "math/vec.h"

namespace taut::sim {

/// A triangle, an edge or a corner of a field.
struct SurfacePart {
  enum Kind { kFirstFace, kSecondFace, kEdgeX, kEdgeY, kDiagonal, kCorner };
  int i;
  unsigned j_kind;  ///< 8 j + kind: a field has at most 1e8 corners.
  int j() const noexcept { return static_cast<int>(j_kind >> 3); }
  Kind kind() const noexcept { return static_cast<Kind>(j_kind & 7u); }
};

/// Those that count, in the order in which a search comes by them.
template <int kMost>
struct PartList {
  static constexpr int kTooMany = kMost + 1;
  int count;  ///< Or kTooMany.
  SurfacePart parts[kMost];

  void Add(int i, int j, SurfacePart::Kind kind) noexcept {
    if (count < kMost) parts[count] = {i, static_cast<unsigned>(j) << 3 | kind};
    if (count <= kMost) ++count;
  }
};

/// Zeros: nothing is known.
struct NearParts {
  static constexpr int kMostOfEnd = 8, kMostBetween = 16;
  using OfEnd = PartList<kMostOfEnd>;
  using Between = PartList<kMostBetween>;

  Vec3 from, to;   ///< Of the centre line when it was looked at [m].
  double limit_m;  ///< For any limit up to this; 0: nothing is kept.
  int looks;       ///< That it served for since, or that went by without it.
  bool by_x;       ///< In which order.
  OfEnd ends[2];
  Between between;
};

}  // namespace taut::sim
