/// Pose and velocity of a kinematic body at any time (docs/theory/motion.md).
#pragma once

#include "sim/data/view.h"
#include "simd/vec3.h"
#include "simd/wide_angle.h"

namespace taut::sim {

using simd::Q4;
using simd::V3;

/// A coordinate and its rate.
template <class W>
struct Course {
  W x, rate;
};

template <class W>
Course<W> CourseAt(const View& m, const TimeLawTable& law, W t) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  Course<W> c{zero, zero};
  if (law.knot_count > 0) {
    const MotionKnot* const knots = m.motion_knots + law.first_knot;
    W from = zero, v = zero, x = zero, a = zero;
    for (int lane = 0; lane < W::kLanes; ++lane) {
      int low = 0, high = law.knot_count;
      while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        (knots[middle].t <= t[lane] ? low : high) = middle;
      }
      from.Set(lane, knots[low].t), v.Set(lane, knots[low].v);
      x.Set(lane, knots[low].x), a.Set(lane, knots[low].a);
    }
    const W since = t - from;
    c = {x + since * (v + half * a * since), v + a * since};
  }
  if (law.amplitude != 0) {
    W sine, cosine;
    simd::SinCosOfTurns(W::Splat(law.turns_per_s) * t + W::Splat(law.phase_turns), sine, cosine);
    c.x += W::Splat(law.amplitude) * sine - W::Splat(law.at_zero);
    c.rate += W::Splat(law.amplitude * 2 * simd::kPi * law.turns_per_s) * cosine;
  }
  const auto before = t < zero;
  return {Select(before, zero, c.x), Select(before, zero, c.rate)};
}

/// Pose and velocity of a kinematic body.
template <class W>
struct Motion {
  Course<W> slide, turn;
  V3<W> pos, v, w;
  Q4<W> quat;
};

/// Computes the motion at time `t` (docs/theory/motion.md, eq. 2 and 3).
template <class W>
Motion<W> MotionAt(const View& m, const MotionTable& table, W t) noexcept {
  Motion<W> at;
  at.slide = CourseAt(m, table.slide, t);
  at.turn = CourseAt(m, table.turn, t);
  const V3<W> axis = simd::Splat3<W>(table.axis), direction = simd::Splat3<W>(table.direction);
  W sine, cosine;
  simd::SinCosOfTurns(W::Splat(0.25 / simd::kPi) * at.turn.x, sine, cosine);
  at.quat = {cosine, sine * axis.x, sine * axis.y, sine * axis.z};
  const V3<W> arm = RotationOf(at.quat) * simd::Splat3<W>(table.arm);
  at.pos = simd::Splat3<W>(table.center) + at.slide.x * direction + arm;
  at.w = at.turn.rate * axis;
  at.v = at.slide.rate * direction + Cross(at.w, arm);
  return at;
}

}  // namespace taut::sim
