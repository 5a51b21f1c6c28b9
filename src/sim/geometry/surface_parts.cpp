// Selection of the parts of a field that may have a contact with a rod after it has moved by less
// than a slack. The conditions are the same as in surface_near.cpp and surface_line.cpp, written as
// distances and relaxed by the slack. No such distance changes by more than the points of the rod
// move.
#include "sim/geometry/surface_parts.h"

#include "math/scalar.h"
#include "sim/geometry/surface_near.h"

namespace taut::sim {
namespace {

/// Tolerances for rounding, relative to the limit and in [m]; larger than those in the contact
/// conditions.
constexpr double kRounding = 1e-6, kRoundingM = 1e-9;

/// Search around a point or a rod: largest distance of relevant parts, and slack of all other
/// conditions.
struct Around {
  const SurfaceTable& s;
  double reach_m, slack_m;

  /// Returns whether the length `x` * sqrt(`unit2`) is at most the slack.
  bool Below(double x, double unit2) const noexcept {
    return x <= 0.0 || x * x <= slack_m * slack_m * unit2;
  }
};

class PointFilter {
 public:
  PointFilter(const Around& around, const Vec3& point) noexcept : a_(around), point_(point) {}

  bool Face(const SurfaceTriangle& t) const noexcept {
    const Vec3 n = Cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const double n2 = Dot(n, n), at = Dot(n, point_ - t.p[0]);
    if (at * at > a_.reach_m * a_.reach_m * n2) return false;
    for (int k = 0; k < 3; ++k) {
      const Vec3 edge = t.p[k == 2 ? 0 : k + 1] - t.p[k];
      if (!a_.Below(-Dot(Cross(n, edge), point_ - t.p[k]), n2 * Dot(edge, edge))) return false;
    }
    return true;
  }
  bool Edge(const SurfaceEdge& e) const noexcept {
    const Vec3 edge = e.to - e.from, a = point_ - e.from;
    const double along = Dot(a, edge), edge2 = Dot(edge, edge);
    if (!a_.Below(-along, edge2) || !a_.Below(along - edge2, edge2)) return false;
    const Vec3 away = a - (along / edge2) * edge;
    if (Dot(away, away) > a_.reach_m * a_.reach_m) return false;
    for (int k = 0; k < e.sides; ++k) {
      const Vec3 in = e.apex[k] - e.from;
      if (!a_.Below(Dot(away, in), Dot(in, in))) return false;
    }
    return true;
  }
  bool Corner(int i, int j) const noexcept {
    const Vec3 p = detail::CornerOf(a_.s, i, j), away = point_ - p;
    bool near = Dot(away, away) <= a_.reach_m * a_.reach_m;
    if (!near) return false;
    detail::EachBesideOfField(a_.s, i, j, [&](const Vec3& other) noexcept {
      near = near && a_.Below(Dot(away, other - p), Dot(other - p, other - p));
    });
    return near;
  }

 private:
  const Around& a_;
  Vec3 point_;
};

class LineFilter {
 public:
  LineFilter(const Around& around, const LineReach& line) noexcept
      : a_(around), from_(line.from), along_(line.along) {}

  bool Edge(const SurfaceEdge& e) const noexcept {
    const Vec3 edge = e.to - e.from, a = from_ - e.from;
    const double from_edge = Dot(a, edge), along_edge = Dot(along_, edge), edge2 = Dot(edge, edge);
    const double slack = a_.slack_m * Sqrt(edge2);
    LineStretch beside{0.0, 1.0};
    beside.CutAbove(-from_edge - slack, -along_edge);
    beside.CutAbove(from_edge - edge2 - slack, along_edge);
    if (beside.low > beside.high) return false;
    // Returns whether a segment comes near enough to the infinite line of the edge.
    const Vec3 apart = a - (from_edge / edge2) * edge;
    const Vec3 parting = along_ - (along_edge / edge2) * edge;
    const auto in_reach = [&](const LineStretch& stretch) noexcept {
      if (!(stretch.low <= stretch.high)) return false;
      const double least = Clamp(-Dot(apart, parting) / Larger(Dot(parting, parting), 1e-300),
                                 stretch.low, stretch.high);
      const Vec3 there = apart + least * parting;
      return Dot(there, there) <= a_.reach_m * a_.reach_m;
    };
    LineStretch outside = beside;
    for (int k = 0; k < e.sides; ++k) {
      const Vec3 in = e.apex[k] - e.from, inward = in - (Dot(in, edge) / edge2) * edge;
      const double away = a_.slack_m * Norm(inward);
      outside.CutAbove(Dot(a, inward) - away, Dot(along_, inward));
    }
    const bool touches = in_reach(outside);
    if (!a_.s.solid || e.sides != 2) return touches;
    for (int k = 0; k < 2; ++k) {
      Vec3 n = Cross(edge, e.apex[k] - e.from);
      if (Dot(n, e.apex[1 - k] - e.from) > 0.0) n = -1.0 * n;
      beside.CutAbove(Dot(n, a) - a_.slack_m * Norm(n), Dot(n, along_));
    }
    const bool under = in_reach(beside);
    under_ = under_ || under;
    return touches || under;
  }
  bool Corner(int i, int j) const noexcept {
    const Vec3 p = detail::CornerOf(a_.s, i, j), a = from_ - p;
    LineStretch outside{0.0, 1.0};
    detail::EachBesideOfField(a_.s, i, j, [&](const Vec3& other) noexcept {
      const double away = a_.slack_m * Norm(other - p);
      outside.CutAbove(Dot(a, other - p) - away, Dot(along_, other - p));
    });
    if (!(outside.low <= outside.high)) return false;
    const double least = Clamp(-Dot(a, along_) / Dot(along_, along_), outside.low, outside.high);
    const Vec3 there = a + least * along_;
    return Dot(there, there) <= a_.reach_m * a_.reach_m;
  }
  /// Returns whether the line may be below a tested edge.
  bool under() const noexcept { return under_; }

 private:
  const Around& a_;
  Vec3 from_, along_;
  mutable bool under_ = false;
};

template <int kMost>
void Add(PartList<kMost>& list, int i, int j, SurfacePart::Kind kind) noexcept {
  if (list.count == 0) list.i = i, list.j = j;
  const int di = i - list.i, dj = j - list.j;
  const bool far = di > SurfacePart::kFarthest || di < -SurfacePart::kFarthest ||
                   dj > SurfacePart::kFarthest || dj < -SurfacePart::kFarthest;
  if (far || list.count >= kMost) {
    list.count = list.kTooMany;
  } else {
    list.parts[list.count++] = {static_cast<short>(di), static_cast<short>(8 * dj + kind)};
  }
}

/// Adds all sharp edges and corners that pass a filter.
template <class Filter, int kMost>
void AddSharp(const Around& around, const LineReach& line, const Filter& filter,
              PartList<kMost>& list) noexcept {
  const SurfaceTable& s = around.s;
  detail::EachCellOfField(s, line, [&](int i, int j, double floor) noexcept {
    const int at = j * s.columns + i;
    const unsigned char marks = s.marks[at];
    const double* const z = s.height_m + at;
    const auto look = [&](FieldMark mark, SurfacePart::Kind kind, int from, int to) noexcept {
      if ((marks & mark) == 0 || Larger(z[from], z[to]) < floor) return;
      if (filter.Edge(detail::EdgeOfField(s, i, j, mark))) Add(list, i, j, kind);
    };
    const bool rises = (marks & kRising) != 0;
    look(kSharpAlongX, SurfacePart::kEdgeX, 0, 1);
    look(kSharpAlongY, SurfacePart::kEdgeY, 0, s.columns);
    look(kSharpDiagonal, SurfacePart::kDiagonal, rises ? 0 : 1, rises ? s.columns + 1 : s.columns);
    if ((marks & kSharpCorner) != 0 && z[0] >= floor && filter.Corner(i, j)) {
      Add(list, i, j, SurfacePart::kCorner);
    }
  });
}

/// Returns whether a point that has moved by less than the slack is above the rectangle of a field
/// and above the whole field there.
bool IsAbove(const Around& around, const Vec3& point) noexcept {
  const SurfaceTable& s = around.s;
  const Vec3 slack{around.slack_m, around.slack_m, around.slack_m};
  const Vec3 low = point - slack, high = point + slack;
  return low.x > s.low.x && low.y > s.low.y && high.x < s.high.x && high.y < s.high.y &&
         low.z > TopOver(s, low, high);
}

void LookAround(const Around& around, const Vec3& point, NearParts::OfEnd& list) noexcept {
  const SurfaceTable& s = around.s;
  const PointFilter filter(around, point);
  const Vec3 reach{around.reach_m, around.reach_m, around.reach_m};
  list.count = 0;
  detail::EachCell(s, point - reach, point + reach, [&](int i, int j) noexcept {
    const auto look = [&](SurfacePart::Kind kind) noexcept {
      const bool second = kind == SurfacePart::kSecondFace;
      if (filter.Face(detail::TriangleOfField(s, i, j, second))) Add(list, i, j, kind);
    };
    look(SurfacePart::kFirstFace), look(SurfacePart::kSecondFace);
  });
  AddSharp(around, {point, {0.0, 0.0, 0.0}, 0.0, 0.0, around.reach_m}, filter, list);
}

}  // namespace

double SlackOf(const SurfaceTable& s) noexcept {
  constexpr double kCells = 1.0 / 32;
  return kCells * s.cell_m;
}

bool Serves(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
            const NearParts& kept) noexcept {
  const double slack_m = SlackOf(s);
  const Vec3 moved = from - kept.from, also = to - kept.to;
  return limit_m <= kept.limit_m && Dot(moved, moved) <= slack_m * slack_m &&
         Dot(also, also) <= slack_m * slack_m && detail::GoesByX(to - from) == kept.by_x;
}

bool KeepParts(const SurfaceTable& s, const Vec3& from, const Vec3& to, double limit_m,
               NearParts& kept) noexcept {
  if (kept.limit_m > 0.0 && kept.looks < NearParts::kFewLooks) kept.limit_m = 0.0, kept.looks = 0;
  if (kept.limit_m == 0.0 && kept.looks < NearParts::kFewLooks) {
    ++kept.looks;
    return false;
  }
  const double slack_m = SlackOf(s);
  kept.looks = 0;
  kept.from = from, kept.to = to, kept.by_x = detail::GoesByX(to - from);
  kept.limit_m = limit_m + slack_m;
  // The third slack allows for rounding.
  const LineReach line = ReachOfLine(s, from, to, limit_m + 3.0 * slack_m);
  const Around around{s, line.limit_m, slack_m + kRounding * line.limit_m + kRoundingM};
  const bool ball = from.x == to.x && from.y == to.y && from.z == to.z;
  kept.ends[0].count = kept.ends[1].count = kept.between.count = 0;
  kept.above[0] = IsAbove(around, from), kept.above[1] = IsAbove(around, to);
  kept.over = true;
  LookAround(around, from, kept.ends[0]);
  if (ball) return true;
  LookAround(around, to, kept.ends[1]);
  if (line.low > line.high) return true;
  const LineFilter filter(around, line);
  AddSharp(around, line, filter, kept.between);
  kept.over = !filter.under();
  return true;
}

}  // namespace taut::sim
