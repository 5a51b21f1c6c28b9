/// Directions that a joint constrains, as separate rows (docs/theory/joints.md, section 1).
#pragma once

#include <cmath>
#include <vector>

#include "math/vec.h"
#include "taut/joint_def.h"

namespace taut {

/// Force at the joint point and torque, on body b; body a gets the opposite.
struct Wrench {
  Vec3 force, torque;
};

/// n: joint axis; s, t: two directions normal to it.
enum class HeldRow { kAlong, kAcross1, kAcross2, kSwing1, kSwing2, kTwist, kDistance };

struct JointAxes {
  Vec3 n, s, t;  ///< In W, in the described pose.
};
inline JointAxes AxesOf(const JointDef& j) {
  const Vec3 n = j.axis, other = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 s = other - Dot(other, n) * n;
  s = (1 / std::sqrt(Dot(s, s))) * s;
  return {n, s, Cross(n, s)};
}

inline std::vector<HeldRow> HeldRowsOf(const JointDef& j) {
  const HeldMotions held = ConstrainedMotions(j.kind);
  std::vector<HeldRow> rows;
  if (held.along) rows.push_back(HeldRow::kAlong);
  if (held.across) rows.insert(rows.end(), {HeldRow::kAcross1, HeldRow::kAcross2});
  if (held.swing) rows.insert(rows.end(), {HeldRow::kSwing1, HeldRow::kSwing2});
  if (held.twist) rows.push_back(HeldRow::kTwist);
  if (j.kind == JointKind::kDistance && HoldsLength(j)) rows.push_back(HeldRow::kDistance);
  return rows;
}

/// Returns the derivative of the coordinate of a row, for coinciding axes of both bodies: a unit
/// wrench with its force at `to_m`.
inline Wrench UnitOf(const JointDef& j, HeldRow row) {
  const JointAxes axes = AxesOf(j);
  switch (row) {
    case HeldRow::kAlong:
      return {axes.n, {}};
    case HeldRow::kAcross1:
      return {axes.s, {}};
    case HeldRow::kAcross2:
      return {axes.t, {}};
    case HeldRow::kSwing1:
      return {{}, axes.t};
    case HeldRow::kSwing2:
      return {{}, -1.0 * axes.s};
    case HeldRow::kTwist:
      return {{}, axes.n};
    case HeldRow::kDistance:
      break;
  }
  const Vec3 apart = j.to_m - j.from_m;
  return {(1 / std::sqrt(Dot(apart, apart))) * apart, {}};
}

}  // namespace taut
