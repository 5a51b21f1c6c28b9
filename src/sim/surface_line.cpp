// Straight lines beside a surface: where edges and corners that stick out touch the flank of a rod.
#include "math/scalar.h"
#include "sim/surface_near.h"
#include "sim/touch_list.h"

namespace taut::sim {
namespace {

/// A stretch of a line shorter than this share of the radius has no contact of its own.
constexpr double kShortStretch = 1e-6;
constexpr int kMaxNear = 64, kMaxPieces = 4096;

/// Two straight lines, where they are nearest.
struct Crossing {
  double s = 0, t = 0;  ///< Shares of the two, not bounded.
  bool parallel = true;
};

Crossing CrossingOf(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v) noexcept {
  const Vec3 c = Cross(u, v), ab = b - a;
  const double c2 = Dot(c, c);
  if (!(c2 > 1e-24 * Dot(u, u) * Dot(v, v))) return {};
  return {Dot(Cross(ab, v), c) / c2, Dot(Cross(ab, u), c) / c2, false};
}

/// Where along a line something holds, as shares.
struct Stretch {
  double low, high;
  /// Keeps where `at + share * slope` is not above 0.
  void CutAbove(double at, double slope) noexcept {
    if (slope > 0.0) {
      high = Smaller(high, -at / slope);
    } else if (slope < 0.0) {
      low = Larger(low, -at / slope);
    } else if (at > 0.0) {
      high = low - 1.0;
    }
  }
};

double DistanceOfLines(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v) noexcept {
  const double u2 = Dot(u, u), v2 = Dot(v, v);
  const auto to_line = [](const Vec3& p, const Vec3& q, const Vec3& w, double w2) noexcept {
    const double t = w2 > 0.0 ? Clamp(Dot(p - q, w) / w2, 0.0, 1.0) : 0.0;
    return Norm(p - (q + t * w));
  };
  double least = Smaller(to_line(a, b, v, v2), to_line(a + u, b, v, v2));
  least = Smaller(least, Smaller(to_line(b, a, u, u2), to_line(b + v, a, u, u2)));
  const Crossing c = CrossingOf(a, u, b, v);
  if (!c.parallel && c.s > 0.0 && c.s < 1.0 && c.t > 0.0 && c.t < 1.0) {
    least = Smaller(least, Norm((a + c.s * u) - (b + c.t * v)));
  }
  return least;
}

/// Whether a line goes through a triangle; else how far its ends are from the plane, where they are
/// above the triangle.
double DistanceFromFace(const SurfaceTriangle& t, const Vec3& from, const Vec3& to) noexcept {
  const Vec3 ab = t.p[1] - t.p[0], ac = t.p[2] - t.p[0], n = Cross(ab, ac);
  const double n2 = Dot(n, n), length = Sqrt(n2);
  const double at_from = Dot(n, from - t.p[0]), at_to = Dot(n, to - t.p[0]);
  const auto above = [&](const Vec3& p) noexcept {
    for (int k = 0; k < 3; ++k) {
      const Vec3& corner = t.p[k];
      if (Dot(Cross(t.p[k == 2 ? 0 : k + 1] - corner, p - corner), n) < 0.0) return false;
    }
    return true;
  };
  double least = 1e300;
  if (above(from)) least = Smaller(least, Abs(at_from) / length);
  if (above(to)) least = Smaller(least, Abs(at_to) / length);
  if (at_from * at_to < 0.0 && above(from + (at_from / (at_from - at_to)) * (to - from)))
    return 0.0;
  return least;
}

double DistanceOf(const SurfaceTriangle& t, const Vec3& from, const Vec3& to) noexcept {
  const Vec3 along = to - from;
  double least = DistanceFromFace(t, from, to);
  for (int k = 0; k < 3; ++k) {
    const Vec3& a = t.p[k];
    least = Smaller(least, DistanceOfLines(from, along, a, t.p[k == 2 ? 0 : k + 1] - a));
  }
  return least;
}

/// Whether a line is further from a triangle's plane than that, all of it on one side: most are.
bool IsClear(const SurfaceTriangle& t, const Vec3& from, const Vec3& to, double limit_m) noexcept {
  const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  const double at_from = Dot(n, from - t.p[0]), at_to = Dot(n, to - t.p[0]);
  if (!(at_from * at_to > 0.0)) return false;
  const double least = Smaller(Abs(at_from), Abs(at_to));
  return least * least > limit_m * limit_m * Dot(n, n);
}

/// `use` with every triangle near a line, piece by piece of the line, and which piece it is.
template <class Use>
void EachNearLine(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
                  const Use& use) noexcept {
  const double length = Norm(to - from);
  const double piece_m = Larger(s.is_field ? s.cell_m : s.bucket_m, limit_m);
  const int pieces = CellAt(length / piece_m, kMaxPieces) + 1;
  const Vec3 reach{limit_m, limit_m, limit_m};
  for (int k = 0; k < pieces; ++k) {
    const double low = static_cast<double>(k) / pieces, high = (k + 1.0) / pieces;
    const Vec3 a = from + low * (to - from), b = from + high * (to - from);
    const Vec3 least{Smaller(a.x, b.x), Smaller(a.y, b.y), Smaller(a.z, b.z)};
    const Vec3 most{Larger(a.x, b.x), Larger(a.y, b.y), Larger(a.z, b.z)};
    use(least - reach, most + reach, Stretch{low, high}, a, b);
  }
}

/// The triangles beside one piece of a line.
struct Beside {
  SurfaceTriangle all[kMaxNear];
  int count = 0;
};

/// A line between edges and corners, and what it found.
class LineSearch {
 public:
  LineSearch(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
             double radius_m, LinePlace* out, int most) noexcept
      : s_(s),
        from_(from),
        along_(to - from),
        length_m_(Norm(along_)),
        limit_m_(limit_m),
        short_(kShortStretch * radius_m / length_m_),
        apart_(1e-3 * radius_m / length_m_),
        out_(out),
        most_(most) {}

  void Look(const Beside& near, const Stretch& piece) noexcept {
    piece_ = piece;
    for (int i = 0; i < near.count; ++i) {
      for (int k = 0; k < 3; ++k) {
        Edge(near, i, k);
        Corner(near, i, k);
      }
    }
  }
  int count() const noexcept { return count_; }

 private:
  /// The edge from corner k of triangle i to the next one: once of the two triangles that share it.
  void Edge(const Beside& near, int i, int k) noexcept {
    const SurfaceTriangle& t = near.all[i];
    const int l = k == 2 ? 0 : k + 1, m = 3 - k - l;
    const Vec3 &p = t.p[k], edge = t.p[l] - p;
    const SurfaceTriangle* other = nullptr;
    Vec3 other_apex;
    for (int j = 0; j < near.count; ++j) {
      if (j == i) continue;
      const SurfaceTriangle& u = near.all[j];
      for (int n = 0; n < 3; ++n) {
        const int o = n == 2 ? 0 : n + 1;
        const bool same = (u.corner[n] == t.corner[l] && u.corner[o] == t.corner[k]) ||
                          (u.corner[n] == t.corner[k] && u.corner[o] == t.corner[l]);
        if (!same) continue;
        if (j < i) return;
        other = &u, other_apex = u.p[3 - n - o];
      }
    }
    const Vec3 a = from_ - p;
    const double edge2 = Dot(edge, edge);
    // Above the edge's own length, and beyond both of its triangles.
    Stretch outside{0.0, 1.0};
    outside.CutAbove(-Dot(a, edge), -Dot(along_, edge));
    outside.CutAbove(Dot(a, edge) - edge2, Dot(along_, edge));
    const auto cut = [&](const Vec3& apex) noexcept {
      const Vec3 in = apex - p, inward = in - (Dot(in, edge) / edge2) * edge;
      outside.CutAbove(Dot(a, inward), Dot(along_, inward));
    };
    cut(t.p[m]);
    if (other != nullptr) cut(other_apex);
    const Crossing c = CrossingOf(from_, along_, p, edge);
    const double nearest = c.parallel ? 0.5 * (outside.low + outside.high) : c.s;
    const auto at_edge = [&](double share) noexcept {
      const Vec3 point = from_ + share * along_;
      return p + Clamp(Dot(point - p, edge) / edge2, 0.0, 1.0) * edge;
    };
    if (!c.parallel && outside.high - outside.low > short_) {
      const double share = Clamp(nearest, outside.low, outside.high);
      Take(share, at_edge(share), false);
      return;
    }
    // Under a ridge: the line has gone through it, and leaves across it.
    if (!s_.solid || c.parallel || other == nullptr || !(c.t > 0.0 && c.t < 1.0)) return;
    const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const Vec3 m_other = Cross(other->p[1] - other->p[0], other->p[2] - other->p[0]);
    const Vec3 under = from_ + c.s * along_ - p;
    const bool sticks_out = Dot(n, other_apex - p) < 0.0;
    if (sticks_out && Dot(n, under) < 0.0 && Dot(m_other, under) < 0.0 && IsUnder(under + p)) {
      Take(c.s, at_edge(c.s), true);
    }
  }

  /// Of a field it can be told; of a mesh both triangles have said so.
  bool IsUnder(const Vec3& p) const noexcept { return !s_.is_field || DepthBelow(s_, p) > 0.0; }

  void Corner(const Beside& near, int i, int k) noexcept {
    const SurfaceTriangle& t = near.all[i];
    const int corner = t.corner[k];
    const Vec3 &p = t.p[k], a = from_ - p;
    Stretch outside{0.0, 1.0};
    for (int j = 0; j < near.count; ++j) {
      const SurfaceTriangle& u = near.all[j];
      for (int n = 0; n < 3; ++n) {
        if (u.corner[n] != corner) continue;
        if (j < i) return;  // looked at
        for (int o = 0; o < 3; ++o) {
          if (o == n) continue;
          const Vec3 edge = u.p[o] - p;
          outside.CutAbove(Dot(a, edge), Dot(along_, edge));
        }
      }
    }
    if (outside.high - outside.low > short_) {
      Take(Clamp(-Dot(a, along_) / Dot(along_, along_), outside.low, outside.high), p, false);
    }
  }

  void Take(double share, const Vec3& at, bool inside) noexcept {
    if (!(share >= piece_.low && share < piece_.high)) return;
    if (share <= apart_ || share >= 1.0 - apart_) return;  // the ends have it
    const Vec3 away = from_ + share * along_ - at;
    const double distance = Norm(away);
    if (!(distance <= limit_m_ && distance > 0.0)) return;
    int place = count_;
    while (place > 0 && share < out_[place - 1].share) --place;
    if (place > 0 && share - out_[place - 1].share < apart_) return;
    if (place < count_ && out_[place].share - share < apart_) return;
    const double sign = inside ? -1.0 : 1.0;
    const LinePlace found{share, {at, (sign / distance) * away, sign * distance}};
    if (count_ == most_) {
      // The farthest goes.
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
  double length_m_, limit_m_, short_, apart_;
  LinePlace* out_;
  int most_, count_ = 0;
  Stretch piece_{0.0, 1.0};
};

}  // namespace

int NearestAlong(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
                 double radius_m, LinePlace* out, int most) noexcept {
  LineSearch search(s, from, to, limit_m, radius_m, out, most);
  EachNearLine(s, from, to, limit_m,
               [&](const Vec3& low, const Vec3& high, const Stretch& piece, const Vec3& a,
                   const Vec3& b) noexcept {
                 Beside near;
                 EachTriangle(s, low, high, [&](const SurfaceTriangle& t) noexcept {
                   if (near.count == kMaxNear || IsClear(t, a, b, limit_m)) return;
                   if (!(DistanceOf(t, a, b) <= limit_m)) return;
                   near.all[near.count++] = t;
                 });
                 if (near.count > 0) search.Look(near, piece);
               });
  return search.count();
}

double DistanceOfLine(const SurfaceTable& s, const Vec3& from, const Vec3& to,
                      double limit_m) noexcept {
  double least = limit_m;
  EachNearLine(s, from, to, limit_m,
               [&](const Vec3& low, const Vec3& high, const Stretch&, const Vec3& a,
                   const Vec3& b) noexcept {
                 EachTriangle(s, low, high, [&](const SurfaceTriangle& t) noexcept {
                   if (!IsClear(t, a, b, least)) least = Smaller(least, DistanceOf(t, a, b));
                 });
               });
  // Inside, the surface may be far.
  const Vec3* const ends[] = {&from, &to};
  for (const Vec3* const end : ends) {
    SurfacePlace place;
    if (s.solid && NearestPlaces(s, *end, 0.0, &place, 1) > 0 && place.distance_m < 0.0) return 0.0;
  }
  return least;
}

}  // namespace taut::sim
