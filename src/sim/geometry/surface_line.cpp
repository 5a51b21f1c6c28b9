// Narrow phase of the flank of a rod with sharp edges and corners of a surface.
#include "math/scalar.h"
#include "sim/geometry/surface_near.h"
#include "sim/geometry/surface_sharp.h"
#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

/// A shorter segment, relative to the radius, has no separate contact.
constexpr double kShortStretch = 1e-6;
/// sin^2 of the angle below which rod and edge count as parallel and have no separate contact.
constexpr double kParallel = 1e-24;
/// Sine above which a piece that rises from a point of another one counts as nearer.
constexpr double kCovers = 1e-7;

/// Search for contacts of a line with edges and corners.
class LineSearch {
 public:
  LineSearch(const SurfaceTable& s, const LineReach& line, double radius_m, LinePlace* out,
             int most) noexcept
      : s_(s),
        from_(line.from),
        along_(line.along),
        reach_{line.low, line.high},
        along2_(Dot(along_, along_)),
        limit_m_(line.limit_m),
        short_(kShortStretch * radius_m / Sqrt(along2_)),
        apart_(1e-3 * radius_m / Sqrt(along2_)),
        out_(out),
        most_(most) {}

  template <class EdgeOf>
  void Edge(const LineStretch& piece, const Vec3& start, const Vec3& end,
            const EdgeOf& edge_of) noexcept {
    const Vec3 edge = end - start, a = from_ - start, c = Cross(along_, edge);
    const double edge2 = Dot(edge, edge), c2 = Dot(c, c), apart = Dot(a, c);
    if (!(c2 > kParallel * along2_ * edge2)) return;
    if (apart * apart > limit_m_ * limit_m_ * c2) return;  // the infinite lines are too far apart
    // Keep the part within the length of the edge and outside of all its triangles.
    LineStretch outside = reach_;
    const double from_edge = Dot(a, edge), along_edge = Dot(along_, edge);
    outside.CutAbove(-from_edge, -along_edge);
    outside.CutAbove(from_edge - edge2, along_edge);
    if (!(outside.high > outside.low)) return;
    const SurfaceEdge e = edge_of();
    for (int k = 0; k < e.sides; ++k) {
      const Vec3 in = e.apex[k] - e.from, inward = in - (Dot(in, edge) / edge2) * edge;
      outside.CutAbove(Dot(a, inward), Dot(along_, inward));
    }
    const double crossing = -Dot(Cross(a, edge), c) / c2;
    const auto at_edge = [&](double share) noexcept {
      return e.from + Clamp((from_edge + share * along_edge) / edge2, 0.0, 1.0) * edge;
    };
    if (outside.high - outside.low > short_) {
      const double share = Clamp(crossing, outside.low, outside.high);
      const Vec3 at = at_edge(share);
      if (s_.seams.count > 0 && !IsOpen(start, end, share, at, false)) return;
      Take(piece, share, at, false);
      return;
    }
    // Below a ridge: the line has passed through it, and exits over it.
    if (!s_.solid || e.sides != 2) return;
    const double beside = from_edge + crossing * along_edge;
    if (!(beside > 0.0 && beside < edge2)) return;
    const Vec3 under = a + crossing * along_;
    const auto inside = [&](int side, int other) noexcept {
      Vec3 n = Cross(edge, e.apex[side] - e.from);
      if (Dot(n, e.apex[other] - e.from) > 0.0) n = -1.0 * n;  // outward
      return Dot(n, under) < 0.0;
    };
    if (inside(0, 1) && inside(1, 0) && IsUnder(under + e.from)) {
      const Vec3 at = at_edge(crossing);
      if (s_.seams.count > 0 && !IsOpen(start, end, crossing, at, true)) return;
      Take(piece, crossing, at, true);
    }
  }

  template <class EachBeside>
  void Corner(const LineStretch& piece, const Vec3& p, const EachBeside& each_beside) noexcept {
    const Vec3 a = from_ - p;
    const double nearest = -Dot(a, along_) / along2_;
    const Vec3 apart = a + nearest * along_;
    if (Dot(apart, apart) > limit_m_ * limit_m_) return;
    LineStretch outside = reach_;
    each_beside([&](const Vec3& other) noexcept {
      outside.CutAbove(Dot(a, other - p), Dot(along_, other - p));
    });
    if (outside.high - outside.low > short_) {
      const double share = Clamp(nearest, outside.low, outside.high);
      if (s_.seams.count > 0 && !IsOpen(p, p, share, p, false)) return;
      Take(piece, share, p, false);
    }
  }
  int count() const noexcept { return count_; }

 private:
  /// Returns whether an edge point or a corner belongs to the joint surface of all adjacent pieces.
  /// Conditions: no piece is nearer to the line, and the pieces do not continue straight along the
  /// line on both sides. Where they continue straight, the contacts at the ends of the line
  /// suffice.
  bool IsOpen(const Vec3& start, const Vec3& end, double share, const Vec3& at,
              bool inside) const noexcept {
    const Vec3 away = from_ + share * along_ - at;
    const double distance = Norm(away);
    if (!(distance <= limit_m_ && distance > 0.0) || !IsOnSeam(s_.seams, at)) return true;
    const Vec3 normal = ((inside ? -1.0 : 1.0) / distance) * away;
    if (IsEdgeCovered(s_.seams, start, end, {at, normal, nullptr}, {0.0, kCovers})) return false;
    const Vec3 across = along_ - Dot(along_, normal) * normal;
    const double length = Norm(across);
    if (!(length * length > kParallel * along2_)) return true;
    const Vec3 way = (1.0 / length) * across;
    return !GoesStraightOn(&s_, s_.seams, at, way, true) ||
           !GoesStraightOn(&s_, s_.seams, at, -1.0 * way, true);
  }
  /// Returns whether a point is below a field. For a mesh returns true: the test of both triangles
  /// has already shown this.
  bool IsUnder(const Vec3& p) const noexcept { return !s_.is_field || DepthBelow(s_, p) > 0.0; }

  void Take(const LineStretch& piece, double share, const Vec3& at, bool inside) noexcept {
    if (!(share >= piece.low && share < piece.high)) return;
    if (share <= apart_ || share >= 1.0 - apart_) return;  // the ends have this contact
    const Vec3 away = from_ + share * along_ - at;
    const double distance = Norm(away);
    if (!(distance <= limit_m_ && distance > 0.0)) return;
    int place = count_;
    while (place > 0 && share < out_[place - 1].share) --place;
    const double sign = inside ? -1.0 : 1.0;
    const LinePlace found{share, {at, (sign / distance) * away, sign * distance}};
    // Of two contacts at the same place, the nearer one is kept.
    const bool repeats_before = place > 0 && share - out_[place - 1].share < apart_;
    const bool repeats_after = place < count_ && out_[place].share - share < apart_;
    if (repeats_before || repeats_after) {
      LinePlace& same = out_[repeats_before ? place - 1 : place];
      if (found.place.distance_m < same.place.distance_m) same = found;
      return;
    }
    if (count_ == most_) {
      // Remove the farthest contact.
      int farthest = 0;
      for (int i = 1; i < count_; ++i) {
        if (out_[i].place.distance_m > out_[farthest].place.distance_m) farthest = i;
      }
      if (!(found.place.distance_m < out_[farthest].place.distance_m)) return;
      for (int i = farthest; i + 1 < count_; ++i) out_[i] = out_[i + 1];
      --count_;
      if (place > farthest) --place;
    }
    for (int i = count_; i > place; --i) out_[i] = out_[i - 1];
    out_[place] = found;
    ++count_;
  }

  const SurfaceTable& s_;
  Vec3 from_, along_;
  LineStretch reach_;  ///< Outside of this part, nothing is within the limit.
  double along2_, limit_m_, short_, apart_;
  LinePlace* out_;
  int most_, count_ = 0;
};

}  // namespace

LineReach ReachOfLine(const SurfaceTable& s, const Vec3& from, const Vec3& to,
                      double limit_m) noexcept {
  LineReach line{from, to - from, 0.0, 1.0, limit_m};
  const Vec3 reach{limit_m, limit_m, limit_m};
  // After each large cut, the terrain below the rest may be lower.
  for (double before = 4.0; line.low <= line.high && line.high - line.low < 0.5 * before;) {
    before = line.high - line.low;
    const Vec3 a = line.At(line.low), b = line.At(line.high);
    const Vec3 low = Vec3{Smaller(a.x, b.x), Smaller(a.y, b.y), Smaller(a.z, b.z)} - reach;
    const Vec3 high = Vec3{Larger(a.x, b.x), Larger(a.y, b.y), Larger(a.z, b.z)} + reach;
    const bool beside = low.x > s.high.x || low.y > s.high.y || high.x < s.low.x ||
                        high.y < s.low.y || (!s.is_field && high.z < s.low.z);
    LineStretch part{line.low, beside ? line.low - 1.0 : line.high};
    const double top = s.is_field ? TopOver(s, low, high) : s.high.z;
    if (!beside) part.CutAbove(from.z - limit_m - top, line.along.z);
    line.low = part.low, line.high = part.high;
  }
  return line;
}

int NearestAlong(const SurfaceTable& s, const LineReach& line, double radius_m, LinePlace* out,
                 int most, const NearParts::Between* known) noexcept {
  LineSearch search(s, line, radius_m, out, most);
  if (line.low > line.high) return 0;
  if (known != nullptr && known->count <= NearParts::kMostBetween) {
    const LineStretch all{line.low, line.high};
    EachPart(
        s, *known, [](const SurfaceTriangle&) noexcept {},
        [&](const Vec3& start, const Vec3& end, const auto& edge_of) noexcept {
          search.Edge(all, start, end, edge_of);
        },
        [&](const Vec3& corner, const auto& each_beside) noexcept {
          search.Corner(all, corner, each_beside);
        });
    return search.count();
  }
  LineReach wide = line;
  wide.limit_m *= WiderLook(s);
  EachSharp(
      s, wide,
      [&](const LineStretch& piece, const Vec3& start, const Vec3& end,
          const auto& edge_of) noexcept { search.Edge(piece, start, end, edge_of); },
      [&](const LineStretch& piece, const Vec3& corner, const auto& each_beside) noexcept {
        search.Corner(piece, corner, each_beside);
      });
  return search.count();
}

}  // namespace taut::sim
