/// Shapes, motions and comparisons for the tests of sim/geometry/shape_contacts.h
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "math/vec.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

using Points = std::vector<TouchPoint>;

inline Vec3 AsVec(const double* p) { return {p[0], p[1], p[2]}; }
/// x -> R(q) x + p
struct Motion {
  Quat q = {1, 0, 0, 0};
  Vec3 p = {0, 0, 0};
  Vec3 operator()(const Vec3& x) const { return Rotate(q, x) + p; }
};

inline Motion Shift(const Vec3& p) { return {{1, 0, 0, 0}, p}; }
inline Motion Turn(const Vec3& axis, double angle_rad, const Vec3& p = {0, 0, 0}) {
  const double s = std::sin(0.5 * angle_rad) / Length(axis);
  return {{std::cos(0.5 * angle_rad), s * axis.x, s * axis.y, s * axis.z}, p};
}

inline RoundShape Rod(const Vec3& from, const Vec3& to, double radius_m) {
  return {{from.x, from.y, from.z}, {to.x, to.y, to.z}, radius_m};
}
inline RoundShape Ball(const Vec3& center, double radius_m) {
  return Rod(center, center, radius_m);
}
inline BoxShape Box(const Vec3& half_m, const Motion& at = {}) {
  BoxShape box{{at.p.x, at.p.y, at.p.z}, {}, {half_m.x, half_m.y, half_m.z}};
  const Vec3 axes[3] = {Rotate(at.q, {1, 0, 0}), Rotate(at.q, {0, 1, 0}), Rotate(at.q, {0, 0, 1})};
  for (int i = 0; i < 3; ++i) {
    box.axes[3 * i] = axes[i].x;
    box.axes[3 * i + 1] = axes[i].y;
    box.axes[3 * i + 2] = axes[i].z;
  }
  return box;
}
inline BoxShape Cube(double half_m, const Motion& at = {}) {
  return Box({half_m, half_m, half_m}, at);
}

inline RoundShape Moved(const RoundShape& s, const Motion& m) {
  return Rod(m(AsVec(s.from)), m(AsVec(s.to)), s.radius_m);
}
inline BoxShape Moved(const BoxShape& s, const Motion& m) {
  const Vec3 c = m(AsVec(s.center));
  BoxShape out{{c.x, c.y, c.z}, {}, {s.half_m[0], s.half_m[1], s.half_m[2]}};
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = Rotate(m.q, AsVec(s.axes + 3 * i));
    out.axes[3 * i] = axis.x;
    out.axes[3 * i + 1] = axis.y;
    out.axes[3 * i + 2] = axis.z;
  }
  return out;
}

/// Returns the points of a pair, in increasing order of features.
template <class A, class B>
Points Touch(const A& a, const B& b, double margin_m = 1e-4) {
  TouchPoint out[kMaxPointsPerPair];
  const int count = Touch(a, b, margin_m, out);
  Points points(out, out + count);
  std::sort(points.begin(), points.end(),
            [](const TouchPoint& p, const TouchPoint& q) { return p.feature < q.feature; });
  return points;
}

inline TouchPoint Deepest(const Points& points) {
  return *std::min_element(
      points.begin(), points.end(),
      [](const TouchPoint& p, const TouchPoint& q) { return p.gap_m < q.gap_m; });
}

inline Vec3 NearestOn(const RoundShape& s, const Vec3& p) {
  const Vec3 a = AsVec(s.from), ab = AsVec(s.to) - a;
  const double length2 = Dot(ab, ab);
  return length2 == 0 ? a : a + std::clamp(Dot(p - a, ab) / length2, 0.0, 1.0) * ab;
}
inline Vec3 NearestOn(const BoxShape& s, const Vec3& p) {
  Vec3 nearest = AsVec(s.center);
  const Vec3 d = p - nearest;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = AsVec(s.axes + 3 * i);
    nearest = nearest + std::clamp(Dot(d, axis), -s.half_m[i], s.half_m[i]) * axis;
  }
  return nearest;
}
inline double RadiusOf(const RoundShape& s) { return s.radius_m; }
inline double RadiusOf(const BoxShape&) { return 0; }

/// Returns an upper bound of the least distance of two shapes, by alternating projection between
/// them.
template <class A, class B>
double WalkedDistance(const A& a, const B& b, int rounds = 20000) {
  Vec3 on_b = NearestOn(b, {0, 0, 0}), on_a = on_b;
  double distance = 1e300;
  for (int i = 0; i < rounds; ++i) {
    on_a = NearestOn(a, on_b);
    on_b = NearestOn(b, on_a);
    const double now = Length(on_a - on_b);
    if (now >= distance) break;
    distance = now;
  }
  return std::max(distance - RadiusOf(a) - RadiusOf(b), 0.0);
}

/// Random shapes of sizes 0.02 to 0.4 m, placed within `spread_m`
class RandomShapes {
 public:
  explicit RandomShapes(unsigned seed) : random_(seed) {}

  double In(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 InCube(double half) { return {In(-half, half), In(-half, half), In(-half, half)}; }
  Motion Anywhere(double spread_m) {
    // Separate statements, because compilers evaluate arguments in any order.
    const Vec3 axis = InCube(1);
    const double angle = In(0, 6.28);
    return Turn(axis, angle, InCube(spread_m));
  }
  RoundShape Round(double spread_m) {
    const Vec3 from = InCube(spread_m), along = InCube(0.3);
    const bool ball = In(0, 1) < 0.2;
    const double radius = In(0.02, 0.1);
    return ball ? Ball(from, radius) : Rod(from, from + along, radius);
  }
  BoxShape AnyBox(double spread_m) {
    const Vec3 half{In(0.02, 0.2), In(0.02, 0.2), In(0.02, 0.2)};
    return Box(half, Anywhere(spread_m));
  }

 private:
  std::mt19937_64 random_;
};

/// Returns the distance of `point` from the closest mixture of two of the points `others`: the sum
/// of the differences of place, gap and (times `lever_m`) normal.
inline double Uncovered(const TouchPoint& point, const Points& others, double lever_m) {
  double best = 1e300;
  for (const TouchPoint& p : others) {
    for (const TouchPoint& q : others) {
      const Vec3 along = AsVec(q.point) - AsVec(p.point);
      const double length2 = Dot(along, along);
      const double share =
          length2 == 0
              ? 0
              : std::clamp(Dot(AsVec(point.point) - AsVec(p.point), along) / length2, 0.0, 1.0);
      const Vec3 place = AsVec(p.point) + share * along;
      const Vec3 normal = AsVec(p.normal) + share * (AsVec(q.normal) - AsVec(p.normal));
      const double gap = p.gap_m + share * (q.gap_m - p.gap_m);
      best = std::min(best, Length(place - AsVec(point.point)) + std::fabs(gap - point.gap_m) +
                                lever_m * Length(normal - AsVec(point.normal)));
    }
  }
  return best;
}

/// Returns the largest difference between the contact points of two successive steps, ignoring
/// points that are about to pass the margin of 1e-4 m.
inline double WorstChange(const Points& before, const Points& now, double lever_m) {
  double worst = 0;
  for (const TouchPoint& p : now) {
    if (p.gap_m < 0.9e-4) worst = std::max(worst, Uncovered(p, before, lever_m));
  }
  for (const TouchPoint& p : before) {
    if (p.gap_m < 0.9e-4) worst = std::max(worst, Uncovered(p, now, lever_m));
  }
  return worst;
}

}  // namespace taut::sim
