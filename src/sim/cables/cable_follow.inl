/// Update of cable bends between steps (docs/theory/cables.md, section 6). A bend is added where a
/// straight part of the path penetrates an edge or rod, and removed where the cable lifts off.
#pragma once

#include "sim/cables/cable_across.inl"
#include "sim/cables/cable_edges.h"
#include "sim/cables/cable_rods.inl"
#include "sim/cables/cable_wrapping.inl"
#include "sim/cables/lane_spans.inl"
#include "sim/cables/wrap_unchanged.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Edges and rods that the cable of one lane has left during an update. These edges and rods are
/// excluded from the rest of the update, so that it terminates.
struct LeftBehind {
  static constexpr int kMost = 2 * kMostBends;
  double key[kMost];
  int count = 0;
};

/// Sets the status bit of a lane whose cable touches more than kMostBends edges and rods.
template <class W>
TAUT_INLINE void Crowd(Scratch<W>& work, const TouchTable& touch, int lane) noexcept {
  work.no_room |= 1u << lane;
  work.crowded_cable[lane] = touch.cable;
}

/// Returns a bend of one lane to remove, or -1. A bend is removed if its rod contains an end of the
/// cable or the next path point. Of two consecutive bends on overlapping rods, the bend with the
/// smaller wrap angle is removed.
template <class W>
int BendToLetGo(const View& m, const Rows<W>& s, const Scratch<W>& work, const TouchTable& touch,
                int used, int count, int lane) noexcept {
  for (int k = 0; touch.rod_count > 0 && k < count; ++k) {
    if (IsInsideRod(m, s, work, touch, used, k)[lane]) return k;
    if (k + 1 == count || !RanIntoNextRod(m, s, work, touch, k, false)[lane]) continue;
    return work.wheels[k + 1].theta[lane] < work.wheels[k].theta[lane] ? k + 1 : k;
  }
  return -1;
}

/// Changes the bends of a lane once, according to the current path. Removes bends that the cable
/// has left, and bends beyond the end of an edge or inside the ground. Adds a bend at the edge or
/// rod that a straight part penetrates most. `resolved`: bodies have moved by at most half a rod
/// radius since the previous path. Returns whether the bends changed.
template <class W>
bool ChangeBends(const View& m, const Rows<W>& s, Scratch<W>& work, const TouchTable& touch,
                 int used, int lane, bool resolved, LeftBehind& left) noexcept {
  const AttachmentWork<W>* const ends = work.attachments;
  const Wheel<V3<W>>* const wheels = work.wheels;
  LaneBends<W> bends(m, s, touch, lane);
  const int before = bends.count();
  const auto drop = [&](int k, bool forget) {
    if (forget) ForgetSide(m, s, touch, bends.Key(k), lane);
    if (left.count < LeftBehind::kMost) left.key[left.count++] = bends.Key(k);
    bends.Remove(k);
  };
  for (int k = before - 1; k >= 0; --k) {
    const Vec3 middle =
        0.5 * (PlaceOf(ends[1 + 2 * k].p, lane) + PlaceOf(ends[2 + 2 * k].p, lane)) -
        PlaceOf(wheels[k].center, lane);
    const bool lies = wheels[k].theta[lane] > 0.0;
    const bool within = Abs(Dot(middle, PlaceOf(wheels[k].axis, lane))) < bends.Half(k) &&
                        Abs(wheels[k].angle[lane]) < bends.Most(k);
    if (lies && within) continue;
    drop(k, lies);  // the cable slips off and is inside the obstacle
  }
  if (bends.count() < before) return true;
  const int weaker = BendToLetGo(m, s, work, touch, used, before, lane);
  if (weaker >= 0) {
    drop(weaker, true);
    Crowd(work, touch, lane);
    return true;
  }
  if (left.count == LeftBehind::kMost) return false;
  double taken[kMostBends + LeftBehind::kMost];
  int taken_count = 0;
  for (int k = 0; k < bends.count(); ++k) taken[taken_count++] = bends.Key(k);
  for (int k = 0; k < left.count; ++k) taken[taken_count++] = left.key[k];
  StraightParts parts;
  parts.count = bends.count() + 1;
  for (int k = 0; k < parts.count; ++k) {
    const bool end = k == bends.count();
    parts.span[k] = {PlaceOf(ends[2 * k].p, lane),
                     PlaceOf(ends[end ? 2 * used + 1 : 1 + 2 * k].p, lane), k == 0, end};
  }
  BendFound deepest;
  int part = -1;
  for (int k = 0; touch.terrain && k < parts.count; ++k) {
    if (FindEdge(m, parts.span[k], touch.radius_m, taken, taken_count, part >= 0, &deepest)) {
      part = k;
    }
  }
  FindRod(m, s, work, touch, parts, lane, taken, taken_count, part >= 0, &deepest, &part);
  if (part < 0) return false;
  if (resolved && deepest.place.body != m.body_count && deepest.depth_m > deepest.place.radius_m) {
    // The cable is deeper in this rod than possible after a short substep. A bend would make the
    // length jump, so the cable passes through the rod.
    ForgetSide(m, s, touch, deepest.place.key, lane);
    Crowd(work, touch, lane);
    return true;
  }
  const double arc_before = part > 0 ? wheels[part - 1].arc[lane] : 0.0;
  const double arc_behind = part < bends.count() ? wheels[part].arc[lane] : 0.0;
  const double share = ShareBefore(m, s, work, deepest.place, parts.span[part], 0.5 * arc_before,
                                   0.5 * arc_behind, lane);
  if (bends.Insert(part, deepest, share)) return true;
  // The cable already has kMostBends bends: it passes through this obstacle, and its length stays
  // continuous.
  ForgetSide(m, s, touch, deepest.place.key, lane);
  Crowd(work, touch, lane);
  return false;
}

/// Computes the path of a cable. `start`, `end`: its ends at the middle of the step. `ago`: time of
/// the path before the middle of the step [s]; null: 0.
template <class W>
void LayThen(const View& m, const Rows<W>& s, Scratch<W>& work, const TouchTable& touch, int used,
             const AttachmentWork<W>& start, const AttachmentWork<W>& end, const W* ago) noexcept {
  AttachmentWork<W>* const ends = work.attachments;
  ends[0] = start, ends[2 * used + 1] = end;
  if (touch.rod_count > 0) PlaceRods(m, s, work, touch, ago);
  if (ago == nullptr) {
    LayOverBends(m, s, touch, used, ends, work.wheels, PoseNow(s, work));
    return;
  }
  const AttachmentTable* const tables = m.attachments + m.cables[touch.cable].first_attachment;
  const auto then = [&](int body, AttachmentWork<W>& at) {
    const BodyThen<W> was(work.bodies[body], *ago);
    at.p = at.p - was.way + (was.Turned(at.arm) - at.arm);
  };
  then(tables[0].body, ends[0]);
  then(tables[1].body, ends[2 * used + 1]);
  LayOverBends(
      m, s, touch, used, ends, work.wheels, [&](int body, const V3<W>& center, const V3<W>& axis) {
        const M3<W>& R = work.bodies[body].R;
        const BodyThen<W> was(work.bodies[body], *ago);
        return Spot<W>{s.pos[body] - was.way + was.Turned(R * center), was.Turned(R * axis)};
      });
}

/// Maximum number of substeps for updates of bends. In each substep, bodies move by at most half a
/// rod radius, except very fast ones. Therefore the cable meets rods one after the other from
/// outside, and each new bend gets its correct place in the path.
inline constexpr int kMostParts = 32;
template <class W>
[[gnu::noinline]] W PartsOf(const View& m, const Scratch<W>& work, const TouchTable& touch,
                            W time) noexcept {
  const W half = W::Splat(0.5), one = W::Splat(1.0);
  const auto length = [](const V3<W>& v) { return Sqrt(Dot(v, v)); };
  W ends = W::Splat(0.0), rods = ends;
  double least_m = 1e300;
  for (int i = 0; i < 2; ++i) {
    const AttachmentTable& at = m.attachments[m.cables[touch.cable].first_attachment + i];
    const BodyWork<W>& body = work.bodies[at.body];
    ends = Max(ends, length(body.v0) + length(body.w0) * length(work.spots[at.spot].arm));
  }
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    const TouchRodTable& rod = m.touch_rods[i];
    const BodyWork<W>& body = work.bodies[rod.body];
    rods = Max(rods, length(body.v0) + length(body.w0) * W::Splat(m.bound_m[rod.body]));
    if (rod.radius_m < least_m) least_m = rod.radius_m;
  }
  const W parts = (W::Splat(2.0 / least_m) * time) * (ends + rods);
  return Max(Min(Round(parts + half), W::Splat(kMostParts)), one);
}

/// Updates the bends of `lanes` to the middle of the step. Returns the number of bends in use.
/// `time`: time since the middle of the previous step [s].
template <class W>
[[gnu::noinline]] int ChangeAll(const View& m, const Rows<W>& s, Scratch<W>& work,
                                const TouchTable& touch, int used, MaskOf<W> lanes,
                                const AttachmentWork<W>& start, const AttachmentWork<W>& end,
                                W time) noexcept {
  constexpr int kMostRounds = 4 * kMostBends;
  const W one = W::Splat(1.0), zero = W::Splat(0.0);
  const W parts = touch.rod_count > 0 ? PartsOf(m, work, touch, time) : one;
  for (int part = 1; part <= kMostParts; ++part) {
    const auto here = lanes & !(parts < W::Splat(part));
    if (!Any(here)) break;
    const W ago = Select(here, time * (one - W::Splat(part) / parts), zero);
    LeftBehind left[W::kLanes];
    auto busy = here;
    for (int round = 0;; ++round) {
      LayThen(m, s, work, touch, used, start, end, &ago);
      if (round == kMostRounds) break;
      busy = busy & MayChangeBends(m, s, work, touch, used);
      for (int lane = 0; lane < W::kLanes; ++lane) {
        if (busy[lane]) {
          const bool resolved = parts[lane] < kMostParts;
          busy.Set(lane, ChangeBends(m, s, work, touch, used, lane, resolved, left[lane]));
        }
      }
      if (!Any(busy)) break;
      used = BendsInUse(s, touch);
    }
    KeepAngles(s, work, touch, used, here);
    KeepSides(m, s, work, touch, used, here);
  }
  return used;
}

/// Updates the bends of a cable to the middle of the step. Returns its length.
template <class W>
[[gnu::noinline]] W FollowBends(const View& m, const Rows<W>& s, Scratch<W>& work,
                                const CableTable& cable, W h) noexcept {
  constexpr double kEnoughM = 0.05;
  const TouchTable& touch = m.touches[cable.touch];
  int used = BendsInUse(s, touch);
  AttachmentWork<W>* const ends = work.attachments;
  const AttachmentWork<W> start = Attachment(m.attachments[cable.first_attachment], work);
  const AttachmentWork<W> end = Attachment(m.attachments[cable.first_attachment + 1], work);
  const V3<W>&first = start.p, &last = end.p;
  ends[0] = start, ends[1] = end;
  const auto free = s.bend[touch.first_bend].key == W::Splat(kNoKey);
  auto look = (!free) | MayTouchRods(m, s, work, touch, first, last, free);
  if (touch.terrain) look = look | MayTouch(s, cable.touch, first, last);
  look = look & (s.halted[0] == W::Splat(0.0));
  if (!Any(look)) return MeasureTouching(m, s, cable, work, ends).l;  // a cable without bends
  const W* const now = nullptr;
  LayThen(m, s, work, touch, used, start, end, now);
  const auto busy = look & MayChangeBends(m, s, work, touch, used);
  if (Any(busy)) {
    const W time = W::Splat(0.5) * (h + s.last_step[0]);
    used = ChangeAll(m, s, work, touch, used, busy, start, end, time);
    LayThen(m, s, work, touch, used, start, end, now);
  }
  if (touch.friction > 0 && used > 0) SlideAcross(m, s, work, touch, used, ends);
  KeepAngles(s, work, touch, used, look);
  KeepSides(m, s, work, touch, used, look);
  if (touch.terrain) {
    // For a cable without bends: the distance that its ends may move before the next check.
    const auto bent = !(s.bend[touch.first_bend].key == W::Splat(kNoKey));
    W& far = s.touch_free[cable.touch];
    far = Select(look & bent, W::Splat(0.0), far);
    s.touch_from[cable.touch] = Pick(look, first, s.touch_from[cable.touch]);
    s.touch_to[cable.touch] = Pick(look, last, s.touch_to[cable.touch]);
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (!look[lane] || bent[lane]) continue;
      const FreeSpan span{PlaceOf(first, lane), PlaceOf(last, lane), true, true};
      far.Set(lane, FreeDistance(m, span, touch.radius_m, kEnoughM));
    }
  }
  return MeasureLaid(m, s, touch, used, work, ends).l;
}

}  // namespace taut::sim
