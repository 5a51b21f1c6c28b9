/// Rolling gait toward a goal: signal of a cable by its place on the robot relative to the goal
/// direction and the vertical.
///
/// A robot that rolls turns over, so that none of its parts stays in front. The direction to the
/// goal and the vertical are invariant. From the directions of its struts this law computes the
/// rotation of the robot, from it the place of each cable, and from that its signal, a polynomial
/// of the third degree. Rolling needs no clock: as the robot turns over, the cables' places and
/// thereby their signals change. A beat modulates the strength of the signals, so that a robot that
/// has come to rest where they balance leaves that pose.
///
/// Sensors on a real robot: direction of each strut in the world (accelerometer and compass on it;
/// its rotation about its axis does not matter), and horizontal direction of the goal (beacon and
/// compass). Equations: docs/theory/gaits.md.
#pragma once

#include <stddef.h>

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// Direction vector. Of a strut: unit vector from its start to its end in W, in the described pose.
template <class Real>
struct Direction {
  Real x, y, z;
};

/// Returns the dot product.
template <class Real>
constexpr Real Along(const Direction<Real>& a, const Direction<Real>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// S^-1 of struts u_k in the described pose (G.22): a symmetric matrix, by its six elements.
template <class Real>
struct StrutFrame {
  Real xx, yy, zz, xy, yz, xz;
};

/// Returns a world direction v in the frame of the robot as described (G.23):
///   v' = S^-1 sum_k u_k (u_k(t) . v)
/// `described[k]`: u_k; `now[k]`: u_k(t).
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

/// Coefficients of the signal, in the unit of the signal, m/s or m. `ahead2_up` is the coefficient
/// of a^2 z.
template <class Real>
struct TowardGoal {
  Real offset, ahead, up, ahead2, ahead_up, up2, ahead3, ahead2_up, ahead_up2, up3;
};

/// Returns the strength of the signal at a time (G.25): s = 1 + b cos(2 pi f t), with f t =
/// `clock_turns`, -1/2..1/2.
template <class Real>
constexpr Real BeatStrength(Real beat, Real clock_turns) noexcept {
  return Literal<Real>(1.0f) + beat * CosTurns(clock_turns);
}

/// Returns the signal of a cable at the place `ahead` a and `up` z, in radii of the robot, with
/// strength s (G.24):
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
