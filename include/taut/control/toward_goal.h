/// Rolling towards a goal: how long a cable is to be, by where on the robot it is now, ahead or
/// behind, above or below its centre.
///
/// A robot that rolls turns over, so that none of its parts stays in front. What stays is the way
/// to the goal and the vertical. From the directions of its struts this law finds the turn of the
/// whole robot, from that where each cable is, and from that its signal, a polynomial of the third
/// degree. It needs no clock to roll: as the robot turns over, cables come to other places, and
/// their signals change with them. A beat makes the signals stronger and weaker in turn, so that a
/// robot that has come to rest where they balance comes away from there.
///
/// Sensors of a real robot: the direction of each strut in the world (an accelerometer and a
/// compass on it; about its own axis a strut may turn as it likes), and the horizontal direction of
/// the goal (a beacon and a compass). Equations: docs/theory/gaits.md.
#pragma once

#include <stddef.h>

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// A strut's is a unit vector from its start to its end in W, as the robot is described.
template <class Real>
struct Direction {
  Real x, y, z;
};

template <class Real>
constexpr Real Along(const Direction<Real>& a, const Direction<Real>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// S^-1 of struts u_k as described, row by row (G.22): symmetric, so that six numbers are enough.
template <class Real>
struct StrutFrame {
  Real xx, yy, zz, xy, yz, xz;
};

/// What a world direction v is in the frame of the robot as it is described (G.23):
///   v' = S^-1 sum_k u_k (u_k(t) . v)
/// `described[k]` is u_k, `now[k]` is u_k(t).
template <class Real>
constexpr Direction<Real> InRobot(const StrutFrame<Real>& frame, const Direction<Real>* described,
                                  const Direction<Real>* now, size_t count,
                                  const Direction<Real>& v) noexcept {
  const Real zero = Literal<Real>(0.0f);
  Direction<Real> sum{zero, zero, zero};
  for (size_t k = 0; k < count; ++k) {
    const Real share = Along(now[k], v);
    sum.x = sum.x + share * described[k].x;
    sum.y = sum.y + share * described[k].y;
    sum.z = sum.z + share * described[k].z;
  }
  return Direction<Real>{frame.xx * sum.x + frame.xy * sum.y + frame.xz * sum.z,
                         frame.xy * sum.x + frame.yy * sum.y + frame.yz * sum.z,
                         frame.xz * sum.x + frame.yz * sum.y + frame.zz * sum.z};
}

/// The coefficients of the signal, each in its unit, m/s or m. `ahead2_up` is that of a^2 z.
template <class Real>
struct TowardGoal {
  Real offset, ahead, up, ahead2, ahead_up, up2, ahead3, ahead2_up, ahead_up2, up3;
};

/// How strong the signal is at a time (G.25): s = 1 + b cos(2 pi f t), f t as `clock_turns`,
/// -1/2..1/2.
template <class Real>
constexpr Real BeatStrength(Real beat, Real clock_turns) noexcept {
  return Literal<Real>(1.0f) + beat * CosTurns(clock_turns);
}

/// The signal of a cable at `ahead` a and `up` z, in radii of the robot, at a strength s (G.24):
///   u = c + s (c_a a + c_z z + c_aa a^2 + c_az a z + c_zz z^2
///              + c_aaa a^3 + c_aaz a^2 z + c_azz a z^2 + c_zzz z^3)
template <class Real>
constexpr Real TowardGoalSignal(const TowardGoal<Real>& c, Real ahead, Real up,
                                Real strength) noexcept {
  const Real a = ahead, z = up;
  return c.offset + strength * (a * (c.ahead + a * (c.ahead2 + a * c.ahead3)) +
                                z * (c.up + a * (c.ahead_up + a * c.ahead2_up) +
                                     z * (c.up2 + a * c.ahead_up2 + z * c.up3)));
}

}  // namespace control
}  // namespace taut
