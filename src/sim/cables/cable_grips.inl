/// Capstan friction of cables on edges or rods (docs/theory/cables.md, section 7): chains
/// (cable_chains.inl) with the spans of lane_spans.inl.
#pragma once

#include "sim/cables/cable_chains.inl"
#include "sim/cables/cable_rods.inl"
#include "sim/cables/cable_wrapping.inl"
#include "sim/cables/lane_spans.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Distributes length among the spans on both sides of vanished bends, so that their strain is
/// equal.
template <class W>
void ShareLengths(const View& m, const Rows<W>& s, const CableTable& cable, const Scratch<W>& work,
                  W* length) noexcept {
  for (int lane = 0; lane < W::kLanes; ++lane) {
    const int count = SpansIn(m, s, cable, lane);
    for (int first = 0, end; first < count; first = end) {
      end = first + 1;
      while (end < count && !(work.wheels[end - 1].theta[lane] > 0.0)) ++end;
      if (end == first + 1) continue;
      double long_m = 0.0, rest_m = 0.0;
      for (int k = first; k < end; ++k) {
        long_m += length[k][lane], rest_m += s.span_rest[cable.first_span + k][lane];
      }
      for (int k = first; k < end; ++k) {
        length[k].Set(lane, long_m / rest_m * s.span_rest[cable.first_span + k][lane]);
      }
    }
  }
}

/// Computes lengths and tension ratios of the spans of a cable in its path on work.wheels.
template <class W>
[[gnu::noinline]] void MeasureGrips(const View& m, const Rows<W>& s, const CableTable& cable,
                                    const Scratch<W>& work, const AttachmentWork<W>* ends,
                                    W* length, W* ratio) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0), half = W::Splat(0.5);
  const W friction = W::Splat(m.touches[cable.touch].friction);
  const int used = work.bends_used, last = 2 * used + 1;
  for (int k = 0; k < cable.span_count; ++k) length[k] = zero, ratio[k] = one;
  V3<W> from = ends[0].p;
  W arc = zero;
  for (int k = 0; k < used; ++k) {
    const Wheel<V3<W>>& wheel = work.wheels[k];
    const AttachmentWork<W>&a = ends[1 + 2 * k], &b = ends[2 + 2 * k];
    const auto has = HasSpan(m, s, cable, k + 1), on = wheel.theta > zero;
    const W way = half * (Select(on, wheel.arc, zero) + Dot(b.u, b.p - a.p));
    length[k] = Select(has, arc + Dot(a.u, a.p - from) + way, zero);
    ratio[k] = Select(on, RatioOf(friction * Max(wheel.theta, zero)), one);
    arc = Select(has, way, arc);
    from = Pick(has, b.p, from);
  }
  const W rest = arc + Dot(ends[last].u, ends[last].p - from);
  for (int k = 0; k <= used; ++k) {
    auto is_last = HasSpan(m, s, cable, k);
    if (k < used) is_last = is_last & !HasSpan(m, s, cable, k + 1);
    length[k] = Select(is_last, rest, length[k]);
  }
  ShareLengths(m, s, cable, work, length);
}

/// Transports cable material on rotating rods; see CarryOver.
template <class W>
[[gnu::noinline]] void CarryOverGrips(const View& m, const Rows<W>& s, const CableTable& cable,
                                      const Scratch<W>& work, const AttachmentWork<W>* ends,
                                      const W* length, bool keep, W* rest) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0);
  const WrapPointNumbers<W>* const bends = &s.bend[m.touches[cable.touch].first_bend];
  for (int k = 1; k <= work.bends_used; ++k) {
    rest[k] = Select(HasSpan(m, s, cable, k), rest[k], one);
  }
  for (int k = 0; k < work.bends_used; ++k) {
    const Wheel<V3<W>>& wheel = work.wheels[k];
    const int slip = cable.first_slip + k;
    W &known = s.slip_place[slip], &known_height = s.slip_height[slip];
    const auto has = HasSpan(m, s, cable, k + 1);
    const W middle = MiddleOf(wheel, MarkOfBend(m, work, bends[k]), ends);
    W place = Select(known < W::Splat(kNotHeld), known, middle), height = known_height;
    // Null for readings, because the stored values of `lean` belong to another pose.
    const W* const lean = keep ? &work.across[slip].lean : nullptr;
    CarryOver(wheel, middle, k, ends, length, keep, lean, place, height, rest);
    if (keep) known = Select(has, place, known), known_height = Select(has, height, known_height);
  }
  for (int k = 1; k <= work.bends_used; ++k) {
    rest[k] = Select(HasSpan(m, s, cable, k), rest[k], zero);
  }
}

/// Applies the wound length in each lane.
template <class W>
[[gnu::noinline]] void WindGrips(const View& m, const Rows<W>& s, const CableTable& cable, W wound,
                                 W* rest) noexcept {
  for (int lane = 0; lane < W::kLanes; ++lane) {
    const int count = SpansIn(m, s, cable, lane);
    double own[kMostSpans];
    for (int i = 0; i < count; ++i) own[i] = rest[i][lane];
    WindFirstSpan(count, wound[lane], own);
    for (int i = 0; i < count; ++i) rest[i].Set(lane, own[i]);
  }
}

/// Links the spans to bodies: one link per span and body in any lane, sorted by both. Returns the
/// number of links.
template <class W>
[[gnu::noinline]] int LinkGrips(const View& m, const Rows<W>& s, const CableTable& cable,
                                const Scratch<W>& work, const AttachmentWork<W>* ends,
                                RowLink<W>* links) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  const WrapPointNumbers<W>* const bends = &s.bend[m.touches[cable.touch].first_bend];
  const int last = 2 * work.bends_used + 1;
  int count = 0;
  const auto pull = [&](int lane, int row, int body, const V3<W>& u, double side,
                        const AttachmentWork<W>& at) {
    if (body == m.body_count) return;
    int k = 0;
    while (k < count && (links[k].row < row || (links[k].row == row && links[k].body < body))) ++k;
    if (k == count || links[k].row != row || links[k].body != body) {
      TAUT_ASSERT(count < cable.link_room);
      for (int i = count++; i > k; --i) links[i] = links[i - 1];
      const W zero = W::Splat(0.0);
      links[k].row = row;
      links[k].body = body;
      links[k].inv_mass = s.inv_mass[body];
      links[k].lin[0] = links[k].ang[0] = {zero, zero, zero};
    }
    const Vec3 way = side * PlaceOf(u, lane);
    V3<W>&lin = links[k].lin[0], &ang = links[k].ang[0];
    SetPlace(lin, PlaceOf(lin, lane) + way, lane);
    SetPlace(ang, PlaceOf(ang, lane) + Cross(PlaceOf(at.arm, lane), way), lane);
  };
  for (int lane = 0; lane < W::kLanes; ++lane) {
    const int spans = SpansIn(m, s, cable, lane);
    pull(lane, 0, tables[0].body, ends[1].u, 1.0, ends[0]);
    for (int k = 0; k + 1 < spans; ++k) {
      const int body = BodyOfBend(m, bends[k], lane), at = 1 + 2 * k;
      pull(lane, k, body, ends[at].u, -1.0, ends[at]);
      pull(lane, k + 1, body, ends[at + 2].u, 1.0, ends[at + 1]);
    }
    pull(lane, spans - 1, tables[1].body, ends[last].u, -1.0, ends[last]);
  }
  for (int k = 0; k < count; ++k) {
    links[k].turn[0] = work.bodies[links[k].body].inv_inertia * links[k].ang[0];
  }
  return count;
}

}  // namespace taut::sim
