/// Groups of cables that are implicit in tension and direction (docs/theory/cables.md, section 3).
/// A group contains all cables of bodies that cables connect. A group is implicit if one of its
/// cables is stiff at this step. The selection depends on the model, its parameters and the step,
/// never on the state.
#pragma once

#include "sim/data/view.h"

namespace taut::sim {

/// Largest h^2 K / m of explicit springs, where K sums over coupled cables. The explicit scheme is
/// stable below 4.
inline constexpr double kSoftSpring = 0.1;
/// Value of (w h)^2 above which a damped stiff cable gets the second stage.
inline constexpr double kUnresolvedSpring = 4.0;
/// Largest number of bodies of a group with implicit cables; cables of larger groups stay explicit.
/// Equal to LaneMemory::kFullBodies (scratch_memory.h), so the solver has memory for a full matrix.
inline constexpr int kMostInGroup = 128;

enum GroupKind : uint8_t {
  kGroupStiff = 1,   ///< At least one cable of the group is stiff.
  kGroupOther = 2,   ///< The group has cables or bodies that the scheme does not support.
  kGroupDamped = 4,  ///< The group has a damped stiff cable with vibrations too fast for the step.
  kGroupJoints = 8,  ///< The group has joints.
};

/// Returns whether the scheme supports a cable: straight between body points, without a DC motor.
TAUT_INLINE bool IsStraight(const View& m, const CableTable& cable) noexcept {
  if (cable.wheel_count > 0 || cable.touch >= 0 || cable.span_count > 0) return false;
  if (cable.motor >= 0) return false;
  for (int i = 0; i < cable.attachment_count; ++i) {
    if (m.HasMotion(m.attachments[cable.first_attachment + i].body)) return false;
  }
  return true;
}

/// Returns whether the scheme supports a joint: it only constrains a point or a distance of bodies
/// that are not kinematic (implicit_joints.inl).
TAUT_INLINE bool OnlyHolds(const View& m, const JointTable& j) noexcept {
  if (j.a_is_moved || j.b_is_moved) return false;
  for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
    if (m.joint_rows[r].role != JointRole::kHold) return false;
  }
  return j.holds_point || (j.coordinate == JointMeasure::kDistance && j.rest > 0);
}

/// Groups of a world. Each array has one element per body.
struct CableGroups {
  int *group, *size;  ///< Lowest body of the group; number of bodies, at the lowest body.
  uint8_t* kind;      ///< Bits of GroupKind, stored at the lowest body.

  /// Returns whether the cables of a body are implicit in tension and direction.
  TAUT_INLINE bool IsImplicit(int body) const noexcept {
    return (kind[group[body]] & (kGroupStiff | kGroupOther)) == kGroupStiff;
  }
  /// Returns whether a damper acts on a stiff cable of the group with vibrations too fast for the
  /// step.
  TAUT_INLINE bool HasDamper(int body) const noexcept {
    return (kind[group[body]] & kGroupDamped) != 0;
  }
  /// Groups with joints have no second stage, because it would extrapolate the bodies away from
  /// each other.
  TAUT_INLINE bool HasSecondStage(int body) const noexcept {
    return (kind[group[body]] & (kGroupDamped | kGroupJoints)) == kGroupDamped;
  }
};

template <class Moves, class F>
TAUT_INLINE void ForEachMoved(const View& m, const CableTable& cable, const Moves& moves,
                              const F& f) noexcept {
  for (int i = 0; i < cable.attachment_count; ++i) {
    const int body = m.attachments[cable.first_attachment + i].body;
    if (body < m.body_count && moves(body)) f(body);
  }
}

/// Finds the groups. `moves(body)`: whether impulses move a body; `stiffness(cable)`: K of eq. 7
/// [1/s^2]; `damps(cable)`: whether a cable has a damper.
template <class Moves, class Stiffness, class Damps>
TAUT_INLINE void FindGroups(const View& m, double step_s, const Moves& moves,
                            const Stiffness& stiffness, const Damps& damps,
                            const CableGroups& x) noexcept {
  const auto root = [&](int body) {
    while (x.group[body] != body) body = x.group[body];
    return body;
  };
  const auto join = [&](int a, int b) {
    a = root(a), b = root(b);
    x.group[a > b ? a : b] = a > b ? b : a;
  };
  for (int b = 0; b < m.body_count; ++b) x.group[b] = b, x.size[b] = 0, x.kind[b] = 0;
  for (int c = 0; c < m.cable_count; ++c) {
    int first = -1;
    ForEachMoved(m, m.cables[c], moves, [&](int body) {
      if (first >= 0) join(first, body);
      first = body;
    });
  }
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    if (j.a_moves && j.b_moves) join(j.a, j.b);
  }
  for (int b = 0; b < m.body_count; ++b) {
    x.group[b] = root(b);
    ++x.size[x.group[b]];
  }
  const auto mark = [&](int body, uint8_t kind) {
    uint8_t& all = x.kind[x.group[body]];
    all = static_cast<uint8_t>(all | kind);
  };
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    const uint8_t kind = OnlyHolds(m, j) ? kGroupJoints : kGroupOther;
    if (j.a_moves) mark(j.a, kind);
    if (j.b_moves) mark(j.b, kind);
  }
  for (int b = 0; b < m.body_count; ++b) {
    if (x.size[b] > kMostInGroup) mark(b, kGroupOther);
  }
  for (int c = 0; c < m.cable_count; ++c) {
    const double K = stiffness(c);
    int kind = IsStraight(m, m.cables[c]) ? 0 : kGroupOther;
    if (K > kSoftSpring / (step_s * step_s)) kind |= kGroupStiff;
    if (K > kUnresolvedSpring / (step_s * step_s) && damps(c)) kind |= kGroupDamped;
    if (m.cables[c].touch >= 0) {
      // The cable may touch any rod of its list in a later step.
      const TouchTable& touch = m.touches[m.cables[c].touch];
      for (int i = 0; i < touch.rod_count; ++i) {
        mark(m.touch_rods[touch.first_rod + i].body, kGroupOther);
      }
    }
    ForEachMoved(m, m.cables[c], moves, [&](int body) { mark(body, static_cast<uint8_t>(kind)); });
  }
}

}  // namespace taut::sim
