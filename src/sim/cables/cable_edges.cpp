#include "sim/cables/cable_edges.h"

#include "sim/geometry/box_cut.h"
#include "sim/geometry/surface_near.h"

namespace taut::sim {

bool CanLieOn(const BendPlace& place, const FreeSpan& span, double side) noexcept {
  const Wheel<Vec3> wheel{place.center, place.axis, place.radius_m, side * kPi, 1, 0.0, 0.0, 0.0};
  const Tangents<Vec3> lies = LayOn(wheel, span.from, span.to);
  if (!(lies.theta > 0.0) || !(Abs(lies.angle) < place.most_rad)) return false;
  const Vec3 middle = 0.5 * (lies.a + lies.b) - place.center;
  return Abs(Dot(middle, place.axis)) < place.half_m;
}

namespace {

/// Search for the terrain edge with the deepest penetration by a span.
class Search {
 public:
  Search(const View& m, const FreeSpan& span, double radius_m, const double* taken, int taken_count,
         bool any, BendFound* found) noexcept
      : world_(m.body_count),
        span_(span),
        radius_m_(radius_m),
        taken_(taken),
        taken_count_(taken_count),
        found_(found),
        any_(any) {}

  bool found() const noexcept { return is_new_; }
  bool IsTaken(double key) const noexcept { return sim::IsTaken(key, taken_, taken_count_); }

  /// Stores an edge if it is not taken and deeper than the present result.
  void Offer(TerrainEdge& edge, double depth_m) noexcept {
    BendPlace& place = edge.place;
    place.radius_m = radius_m_;
    const Vec3 way = span_.to - span_.from;
    const double side = Dot(way, Cross(place.axis, edge.out)) < 0.0 ? -1.0 : 1.0;
    if (!CanLieOn(place, span_, side)) return;
    if (any_ && !(depth_m > found_->depth_m)) return;
    any_ = is_new_ = true;
    *found_ = {place, depth_m, side};
  }

  int world() const noexcept { return world_; }
  const FreeSpan& span() const noexcept { return span_; }
  double radius_m() const noexcept { return radius_m_; }

 private:
  int world_;
  const FreeSpan& span_;
  double radius_m_;
  const double* taken_;
  int taken_count_;
  BendFound* found_;
  bool any_, is_new_ = false;
};

/// Search over the edges of one box that intersects the span.
class BoxSearch {
 public:
  BoxSearch(const BoxShape& box, double first_key, Search& search) noexcept
      : box_(box), first_key_(first_key), search_(search) {}

  void Run() noexcept {
    const FreeSpan& span = search_.span();
    bool through;
    cut_ = CutBox(box_, span.from, span.to, search_.radius_m(), span.starts, span.ends, &through);
    if (!through) return;
    const int in = static_cast<int>(cut_.in), out = static_cast<int>(cut_.out);
    if (in / 2 != out / 2) {
      Offer(in, out, CornerDepth(in, out));
      return;
    }
    // The span passes through opposite faces; lift it over the nearest of the other four faces.
    int over = -1;
    double least = 0.0;
    for (int face = 0; face < 6; ++face) {
      if (face / 2 == in / 2) continue;
      const double depth = Larger(cut_.Below(face, cut_.from), cut_.Below(face, cut_.to));
      if (over < 0 || depth < least) over = face, least = depth;
    }
    Offer(in, over, cut_.Below(over, cut_.from));
    Offer(over, out, cut_.Below(over, cut_.to));
  }

 private:
  /// Returns the depth of the span below the edge between two faces whose corner it cuts.
  double CornerDepth(int in, int out) const noexcept {
    const double a = cut_.Below(out, cut_.from), b = cut_.Below(in, cut_.to);
    return a * b / Larger(Sqrt(a * a + b * b), 1e-300);
  }

  /// Offers the edge between two faces to the search.
  void Offer(int f, int g, double depth_m) noexcept {
    if (f > g) return Offer(g, f, depth_m);
    const double key = first_key_ + NumberOfEdge<double>(f, g);
    if (search_.IsTaken(key)) return;
    const int along = 3 - f / 2 - g / 2;
    Vec3 center = Load(box_.center), out{0.0, 0.0, 0.0};
    for (const int face : {f, g}) {
      const Vec3 normal = (face % 2 == 1 ? 1.0 : -1.0) * AxisOf(box_, face / 2);
      center = center + box_.half_m[face / 2] * normal;
      out = out + 0.70710678118654752 * normal;
    }
    TerrainEdge edge{{key, search_.world(), center, AxisOf(box_, along), 1.5 * kPi,
                      box_.half_m[along] - kCornerRadii * search_.radius_m(), 0.0},
                     out};
    search_.Offer(edge, depth_m);
  }

  const BoxShape& box_;
  double first_key_;
  Search& search_;
  BoxCut<Vec3> cut_;
};

Vec3 Unit(const Vec3& a) noexcept { return (1.0 / Larger(Norm(a), 1e-300)) * a; }

/// Offers an edge of a surface to the search, with the depth of the span below it.
void OfferEdge(const SurfaceEdge& edge, double key, double reach_m, Search& search) noexcept {
  if (edge.sides != 2 || edge.border || search.IsTaken(key)) return;
  const Vec3 along = edge.to - edge.from;
  const double length_m = Norm(along);
  const Vec3 axis = Unit(along), center = 0.5 * (edge.from + edge.to);
  Vec3 side[2];
  for (int i = 0; i < 2; ++i) {
    const Vec3 to_apex = edge.apex[i] - edge.from;
    side[i] = Unit(to_apex - Dot(to_apex, axis) * axis);
  }
  const Vec3 across_solid = Cross(side[0], side[1]);
  const double solid = Atan2(Norm(across_solid), Dot(side[0], side[1]));
  TerrainEdge found{{key, search.world(), center, axis, 2.0 * kPi - solid, 0.5 * length_m, 0.0},
                    -1.0 * Unit(side[0] + side[1])};
  const FreeSpan& span = search.span();
  const Vec3 across = Cross(span.to - span.from, axis);
  const double across2 = Dot(across, across);
  if (!(across2 > 0.0)) return;
  const double apart = Dot(across, center - span.from) / Sqrt(across2);
  const double depth = search.radius_m() + (Dot(across, found.out) < 0.0 ? -apart : apart);
  if (depth > 0.0 && depth < reach_m) search.Offer(found, depth);
}

void SearchSurface(const SurfaceTable& s, double first_key, Search& search) noexcept {
  const FreeSpan& span = search.span();
  const double radius = search.radius_m();
  // Distance beyond which edges cannot be touched. For meshes, this distance includes the depth
  // that a cable can reach within a step.
  double reach = 2.0 * radius;
  if (s.is_field) {
    const Vec3 low{Smaller(span.from.x, span.to.x), Smaller(span.from.y, span.to.y), 0.0};
    const Vec3 high{Larger(span.from.x, span.to.x), Larger(span.from.y, span.to.y), 0.0};
    const Vec3 grown{radius, radius, 0.0};
    const double above = TopOver(s, low - grown, high + grown) - Smaller(span.from.z, span.to.z);
    if (above + radius < 0.0) return;
    reach = reach + Larger(above, 0.0);
  } else {
    constexpr double kMostM = 0.02;
    reach = reach + kMostM;
  }
  const LineReach line{span.from, span.to - span.from, 0.0, 1.0, reach};
  if (!s.is_field) {
    EachPiece(s, line, [&](const LineStretch&, const Vec3& low, const Vec3& high) noexcept {
      detail::EachOfMesh(s, low, high, [&](int triangle) noexcept {
        for (int e = s.first_edge[triangle]; e < s.first_edge[triangle + 1]; ++e) {
          OfferEdge(detail::EdgeOfMesh(s, s.edges[e]), first_key + e, reach, search);
        }
      });
    });
    return;
  }
  constexpr FieldMark kMarks[] = {kSharpAlongX, kSharpAlongY, kSharpDiagonal};
  detail::EachCellOfField(s, line, [&](int i, int j, double) noexcept {
    const int at = j * s.columns + i;
    for (int k = 0; k < 3; ++k) {
      if ((s.marks[at] & kMarks[k]) == 0) continue;
      OfferEdge(detail::EdgeOfField(s, i, j, kMarks[k]), first_key + (3.0 * at + k), reach, search);
    }
  });
}

RoundShape RoundOf(const FreeSpan& span, double radius_m) noexcept {
  return {{span.from.x, span.from.y, span.from.z}, {span.to.x, span.to.y, span.to.z}, radius_m};
}

/// Calls `use(shape, number)` for the boxes of the world that the span may reach.
template <class Use>
void EachBox(const View& m, const FreeSpan& span, double reach_m, const Use& use) noexcept {
  const auto look = [&](int number) noexcept {
    const Shape& shape = m.shapes[number].shape_P;
    if (shape.kind == ShapeKind::kBox) use(shape.box, number);
  };
  if (m.tree_shapes == 0) {
    for (int i = 0; i < m.world_shape_count; ++i) look(m.world_shapes[i]);
    return;
  }
  Shape round;
  round.round = RoundOf(span, 0.0);
  EachNear(m.tree, m.tree_nodes, BoundsOf(round), reach_m,
           [&](int i) noexcept { look(m.world_shapes[i]); });
}

}  // namespace

bool FindEdge(const View& m, const FreeSpan& span, double radius_m, const double* taken,
              int taken_count, bool any, BendFound* found) noexcept {
  Search search(m, span, radius_m, taken, taken_count, any, found);
  EachBox(m, span, radius_m, [&](const BoxShape& box, int number) noexcept {
    BoxSearch(box, kEdgesOfShape * number, search).Run();
  });
  for (int i = 0; i < m.ground_count; ++i) {
    const int number = m.first_ground + i;
    SearchSurface(*m.shapes[number].shape_P.surface.table, kEdgesOfShape * number, search);
  }
  return search.found();
}

double FreeDistance(const View& m, const FreeSpan& span, double radius_m,
                    double enough_m) noexcept {
  const RoundShape round = RoundOf(span, radius_m);
  double least = enough_m;
  EachBox(m, span, radius_m + enough_m,
          [&](const BoxShape& box, int) noexcept { least = Smaller(least, Distance(round, box)); });
  for (int i = 0; i < m.ground_count; ++i) {
    const SurfaceShape& surface = m.shapes[m.first_ground + i].shape_P.surface;
    least = Smaller(least, DistanceToGround(round, surface, least, nullptr));
  }
  return least;
}

}  // namespace taut::sim
