/// Searches near a field that keep what they came by (near_parts.h).
///
/// Part of a step: no standard library.
#pragma once

#include "sim/near_parts.h"
#include "sim/surface_sharp.h"

namespace taut::sim {

/// So much further than the limit all is looked for, so that bounds leave nothing out that the laws
/// would take: what is kept is found by others.
inline constexpr double kWiderLook = 1.0 + 1e-9;

/// Whether all that is near a rod is known, once that has been looked up if that is worth it: not
/// while it moves on at once.
bool KnowsParts(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
                NearParts& known) noexcept;

inline SurfaceEdge EdgeOfPart(const SurfaceTable& s, const SurfacePart& part) noexcept {
  constexpr FieldMark kMarks[] = {kSharpAlongX, kSharpAlongY, kSharpDiagonal};
  return detail::EdgeOfField(s, part.i, part.j(), kMarks[part.kind() - SurfacePart::kEdgeX]);
}

/// `use_edge` and `use_corner` as EachSharp has them; `use_face(triangle)`.
template <int kMost, class UseFace, class UseEdge, class UseCorner>
void EachPart(const SurfaceTable& s, const PartList<kMost>& list, const UseFace& use_face,
              const UseEdge& use_edge, const UseCorner& use_corner) noexcept {
  for (int k = 0; k < list.count; ++k) {
    const SurfacePart& part = list.parts[k];
    const int i = part.i, j = part.j();
    if (part.kind() <= SurfacePart::kSecondFace) {
      use_face(detail::TriangleOfField(s, i, j, part.kind() == SurfacePart::kSecondFace));
    } else if (part.kind() == SurfacePart::kCorner) {
      use_corner(detail::CornerOf(s, i, j),
                 [&](const auto& use) noexcept { detail::EachBesideOfField(s, i, j, use); });
    } else {
      const SurfaceEdge edge = EdgeOfPart(s, part);
      use_edge(edge.from, edge.to, [&]() noexcept { return edge; });
    }
  }
}

}  // namespace taut::sim
