/// Rolling gait toward a goal: the signal of a cable depends on its place on the robot relative to
/// the goal direction and the vertical.
///
/// A rolling robot turns over, so none of its parts stays in front. Only the goal direction and the
/// vertical are fixed. This law computes the rotation of the robot from the directions of its
/// struts, then the place of each cable. The signal is a third-degree polynomial of this place.
/// Rolling needs no clock: as the robot turns, the places of the cables and therefore their signals
/// change. A slow modulation of the signal strength (beat) moves the robot out of poses in which
/// the signals balance.
///
/// Sensors on a real robot: an accelerometer and a compass on each strut measure the direction of
/// the strut in the world (not its rotation about its axis). A beacon and a compass measure the
/// horizontal direction of the goal. Equations: docs/theory/gaits.md.
#pragma once

#include <stddef.h>

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// Direction vector. For a strut: unit vector from its start to its end in W, in the described
/// pose.
template <class Real>
struct Direction {
  Real x, y, z;
};

/// Returns the dot product.
template <class Real>
constexpr Real Along(const Direction<Real>& a, const Direction<Real>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// S^-1 of struts with directions u_k in the described pose (G.22): the six elements of a symmetric
/// matrix.
template <class Real>
struct StrutFrame {
  Real xx, yy, zz, xy, yz, xz;
};

/// Transforms a world direction v to the frame of the robot in the described pose (G.23):
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

/// Coefficients of the signal polynomial, in the unit of the signal [m/s] or [m]. `ahead2_up` is
/// the coefficient of a^2 z.
template <class Real>
struct TowardGoal {
  Real offset, ahead, up, ahead2, ahead_up, up2, ahead3, ahead2_up, ahead_up2, up3;
};

/// Returns the signal strength at a time (G.25): s = 1 + b cos(2 pi f t). `beat`: b; `clock_turns`:
/// f t, -1/2..1/2.
template <class Real>
constexpr Real BeatStrength(Real beat, Real clock_turns) noexcept {
  return Literal<Real>(1.0f) + beat * CosTurns(clock_turns);
}

/// Returns the signal of a cable at the place `ahead` (a) and `up` (z), in radii of the robot, with
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
