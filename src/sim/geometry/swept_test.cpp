// Continuous collision detection by conservative advancement (swept_test.h).
#include "sim/geometry/swept_test.h"

#include "sim/geometry/touch_list.h"

namespace taut::sim {
namespace {

ShapePose PoseAfter(const MovingShape& s, double t) noexcept {
  ShapePose pose = s.at;
  const Vec3 turn = t * Load(s.w);
  const double angle2 = Dot(turn, turn);
  const Vec3 half = (0.5 * (1.0 + angle2 / 12.0)) * turn;  // tan(angle / 2), as in position updates
  const double scale = 2.0 / (1.0 + Dot(half, half));
  for (int k = 0; k < 3; ++k) {
    const Vec3 column{s.at.r[k], s.at.r[3 + k], s.at.r[6 + k]};
    const Vec3 once = Cross(half, column);
    const Vec3 turned = column + scale * (once + Cross(half, once));
    pose.r[k] = turned.x, pose.r[3 + k] = turned.y, pose.r[6 + k] = turned.z;
    pose.origin[k] += t * s.v[k];
  }
  return pose;
}

Vec3 VelocityAt(const MovingShape& s, const Vec3& point, double t) noexcept {
  const Vec3 origin = Load(s.at.origin) + t * Load(s.v);
  return Load(s.v) + Cross(Load(s.w), point - origin);
}

/// Returns the rate of the gap at a point at time `t` from now [m/s].
double Rate(const MovingShape& a, const MovingShape& b, const TouchPoint& p, double t) noexcept {
  const Vec3 point = Load(p.point);
  return Dot(Load(p.normal), VelocityAt(a, point, t) - VelocityAt(b, point, t));
}

double FastestApproach(const MovingShape& a, const MovingShape& b) noexcept {
  return Norm(Load(a.v) - Load(b.v)) + Norm(Load(a.w)) * a.bound_m + Norm(Load(b.w)) * b.bound_m;
}

/// Returns the point in `later`, computed at the time of contact, that corresponds to `point`, or
/// null.
const TouchPoint* Same(const TouchPoint& point, bool only_one, const TouchPoint* later,
                       int later_count) noexcept {
  for (int i = 0; i < later_count; ++i) {
    if (later[i].feature == point.feature) return later + i;
  }
  return only_one && later_count > 0 ? later : nullptr;
}

/// Like Same for surfaces, whose features are numbered in the order of detection: returns the
/// nearest point, if the shape can have moved that far.
const TouchPoint* SameOfGround(const TouchPoint& point, double travel_m, const TouchPoint* later,
                               int later_count) noexcept {
  const TouchPoint* same = nullptr;
  for (int i = 0; i < later_count; ++i) {
    const double apart = Norm(Load(later[i].point) - Load(point.point));
    if (apart <= travel_m) travel_m = apart, same = later + i;
  }
  return same;
}

}  // namespace

uint32_t ClosingPoints(const MovingShape& a, const MovingShape& b, double step_s,
                       const TouchPoint* points, int count) noexcept {
  uint32_t closing = 0;
  for (int i = 0; i < count; ++i) {
    const TouchPoint& p = points[i];
    if (p.gap_m > 0.0 && p.gap_m + step_s * Rate(a, b, p, 0.0) < 0.0) closing |= 1u << i;
  }
  return closing;
}

int KeepMeeting(const MovingShape& a, const MovingShape& b, double step_s, uint32_t closing,
                TouchPoint* points, int count) noexcept {
  // Distances that count as contact, relative to the displacement and to the size.
  constexpr double kNearTravel = 1e-3, kNearSize = 1e-9;
  constexpr int kMaxLooks = 1000;
  constexpr double kSamePlane = 1.0 - 1e-12;
  const auto distance_after = [&](double t, double enough_m) noexcept {
    if (a.kept != nullptr) {
      return DistanceToGround(Moved(a.shape->round, PoseAfter(a, t)), b.shape->surface, enough_m,
                              a.kept);
    }
    return DistanceOfShapes(*a.shape, PoseAfter(a, t), *b.shape, PoseAfter(b, t), enough_m);
  };
  const auto touch_after = [&](double t, double margin_m, TouchPoint* out) noexcept {
    if (a.kept != nullptr) {
      return TouchGround(Moved(a.shape->round, PoseAfter(a, t)), b.shape->surface, margin_m, 0,
                         a.kept, out);
    }
    return TouchShapes(*a.shape, PoseAfter(a, t), *b.shape, PoseAfter(b, t), margin_m, out);
  };
  const double speed = FastestApproach(a, b);
  const double near_m = kNearTravel * speed * step_s + kNearSize * (a.bound_m + b.bound_m);
  double t = 0.0;
  bool meet = true;
  // Conservative advancement: no point can close the distance in less time than distance / speed.
  for (int look = 0; look < kMaxLooks; ++look) {
    const double distance = distance_after(t, speed * (step_s - t) + near_m);
    if (distance < near_m) break;
    t += distance / speed;
    meet = t < step_s;
    if (!meet) break;
  }
  if (meet && !(t > 0.0)) return count;  // already in contact
  TouchPoint later[kMaxPointsPerPair];
  const int later_count = meet ? touch_after(t, 2.0 * near_m, later) : 0;
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const TouchPoint* met = nullptr;
    if (closing >> i & 1u) {
      if (!meet) continue;
      met = b.shape->kind == ShapeKind::kSurface
                ? SameOfGround(points[i], speed * step_s + near_m, later, later_count)
                : Same(points[i], count == 1, later, later_count);
    }
    // On straight terrain, both points are in the same plane.
    if (met != nullptr && b.goes_on &&
        Dot(Load(met->normal), Load(points[i].normal)) > kSamePlane) {
      met = nullptr;
    }
    TouchPoint p = met == nullptr ? points[i] : *met;
    if (met != nullptr) {
      const double rate = Rate(a, b, p, t);
      if (!(rate < 0.0)) continue;
      p.feature = points[i].feature;
      p.gap_m -= rate * t;
      p.when_s = t;
    }
    points[kept++] = p;
  }
  return kept;
}

}  // namespace taut::sim
