/// Searches near a height field that cache the parts found (contact_cache.h).
///
/// A step includes this header, so it does not use the standard library.
#pragma once

#include "sim/geometry/contact_cache.h"
#include "sim/geometry/surface_sharp.h"

namespace taut::sim {

/// Returns the factor on the limit for searches in a field. Cached parts are found with other
/// bounds. With a factor above 1, neither kind of bound excludes a part that the contact conditions
/// accept.
inline double WiderLook(const SurfaceTable& s) noexcept { return s.is_field ? 1.001 : 1.0; }

/// Returns whether the cache of a rod or a ball is valid for its current position.
bool Serves(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
            const NearParts& kept) noexcept;

/// Fills the cache, except while the shape leaves each cache after few uses. Returns whether the
/// cache was filled.
bool KeepParts(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
               NearParts& kept) noexcept;

inline SurfaceEdge EdgeOfPart(const SurfaceTable& s, int i, int j, int kind) noexcept {
  constexpr FieldMark kMarks[] = {kSharpAlongX, kSharpAlongY, kSharpDiagonal};
  return detail::EdgeOfField(s, i, j, kMarks[kind - SurfacePart::kEdgeX]);
}

/// Calls `use_edge` and `use_corner` like EachSharp, and `use_face(triangle)`.
template <int kMost, class UseFace, class UseEdge, class UseCorner>
void EachPart(const SurfaceTable& s, const PartList<kMost>& list, const UseFace& use_face,
              const UseEdge& use_edge, const UseCorner& use_corner) noexcept {
  for (int k = 0; k < list.count; ++k) {
    const SurfacePart& part = list.parts[k];
    const int i = list.i + part.di, j = list.j + (part.dj_kind >> 3), kind = part.dj_kind & 7;
    if (kind <= SurfacePart::kSecondFace) {
      use_face(detail::TriangleOfField(s, i, j, kind == SurfacePart::kSecondFace));
    } else if (kind == SurfacePart::kCorner) {
      use_corner(detail::CornerOf(s, i, j),
                 [&](const auto& use) noexcept { detail::EachBesideOfField(s, i, j, use); });
    } else {
      const SurfaceEdge edge = EdgeOfPart(s, i, j, kind);
      use_edge(edge.from, edge.to, [&]() noexcept { return edge; });
    }
  }
}

}  // namespace taut::sim
