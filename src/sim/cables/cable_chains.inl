/// Cables with capstan friction (constraint/cable_chain.h, docs/theory/cables.md, section 5). The
/// spans of these cables are measured in all lanes at once, and solved lane by lane together with
/// all other constraints.
#pragma once

#include "sim/cables/cable_across.inl"
#include "sim/cables/cable_follow.inl"
#include "sim/cables/cable_wheels.inl"
#include "sim/cables/lane_spans.inl"
#include "sim/cables/stage_cables.inl"
#include "sim/data/rows.h"

namespace taut::sim {

/// Transfers cable material between the two spans of a wheel that has turned since the previous
/// step (docs/theory/cables.md, eq. 15a). The amount is the displacement of the arc's middle on the
/// wheel, along the mean direction of the cable. `middle`: angle of the arc's middle; `length`:
/// lengths of the spans; `lean`: Lean::apart of a held bend, or null. `keep`: stores the new middle
/// in `place` and `height`.
template <class W>
TAUT_INLINE void CarryOver(const Wheel<V3<W>>& wheel, W middle, int span,
                           const AttachmentWork<W>* ends, const W* length, bool keep, const W* lean,
                           W& place, W& height, W* rest) noexcept {
  const W zero = W::Splat(0.0), one = W::Splat(1.0), half = W::Splat(0.5);
  const W before = Dot(ends[wheel.at].u, wheel.axis),
          behind = Dot(ends[wheel.at + 2].u, wheel.axis);
  const auto cos_of = [&](W sin) { return Sqrt(Max(one - sin * sin, zero)); };
  const W around = half * (cos_of(before) + cos_of(behind));
  const W along = lean != nullptr ? *lean : half * (before + behind);
  const W turn = TurnFrom(place, middle);
  const W at = Dot(half * (ends[wheel.at].p + ends[wheel.at + 1].p) - wheel.center, wheel.axis);
  const W rise = Select(height < W::Splat(kNotHeld), at - height, zero);
  if (keep) place = place + turn, height = at;
  const W way = Select(wheel.theta > zero, WayAround(wheel, turn) * around + rise * along, zero);
  const W strain = half * (length[span] / rest[span] + length[span + 1] / rest[span + 1]);
  W moves = way / Max(strain, one);
  moves = Max(Min(moves, half * rest[span + 1]), -(half * rest[span]));
  rest[span] += moves;
  rest[span + 1] -= moves;
}

/// Applies CarryOver to all wheels with friction on a cable.
template <class W>
void CarryOverAll(const View& m, const Rows<W>& s, const CableTable& cable, const Scratch<W>& work,
                  const AttachmentWork<W>* ends, const W* length, bool keep, W* rest) noexcept {
  if (cable.touch >= 0) return CarryOverGrips(m, s, cable, work, ends, length, keep, rest);
  for (int i = 0; i + 1 < cable.span_count; ++i) {
    const SlipTable& slip = m.slips[cable.first_slip + i];
    if (slip.wheel < 0) continue;
    const Wheel<V3<W>>& wheel = work.wheels[slip.wheel - cable.first_wheel];
    const V3<W> mark = work.spots[m.wheels[slip.wheel].mark_spot].p - wheel.center;
    const int at = cable.first_slip + i;
    const W* const lean = nullptr;
    CarryOver(wheel, MiddleOf(wheel, mark, ends), i, ends, length, keep, lean, s.slip_place[at],
              s.slip_height[at], rest);
  }
}

/// Computes the lengths of the spans in the current path, and the tension ratios between them.
template <class W>
void MeasureSpans(const View& m, const Rows<W>& s, const CableTable& cable, const Scratch<W>& work,
                  const AttachmentWork<W>* ends, W* length, W* ratio) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  int span = 0, slip = cable.first_slip, wheel = 0;
  for (int i = 0; i < cable.span_count; ++i) length[i] = zero;
  if (cable.touch >= 0) return MeasureGrips(m, s, cable, work, ends, length, ratio);
  for (int i = 1; i < cable.attachment_count; ++i) {
    if (wheel < cable.wheel_count && i == work.wheels[wheel].at + 1) {
      const W arc = work.wheels[wheel].arc;
      const bool parts =
          span + 1 < cable.span_count && m.slips[slip].wheel == cable.first_wheel + wheel;
      if (parts) {
        const W angle = Max(work.wheels[wheel].theta, zero);
        ratio[span] = W::Splat(m.slips[slip].friction) * angle;
        length[span] += half * arc;
        length[++span] += half * arc;
        ++slip;
      } else {
        length[span] += arc;
      }
      ++wheel;
      continue;
    }
    length[span] += Dot(ends[i].u, ends[i].p - ends[i - 1].p);
    if (span + 1 < cable.span_count && m.slips[slip].wheel < 0 && m.slips[slip].at == i) {
      const V3<W> turn = Cross(ends[i].u, ends[i + 1].u);
      const W angle = Atan2(Sqrt(Dot(turn, turn)), Dot(ends[i].u, ends[i + 1].u));
      ratio[span] = W::Splat(m.slips[slip].friction) * angle;
      ++slip, ++span;
    }
  }
  for (int i = 0; i + 1 < cable.span_count; ++i) ratio[i] = RatioOf(ratio[i]);
  ratio[cable.span_count - 1] = W::Splat(1.0);
}

/// Links the spans to bodies, with one link per span and body. Returns the number of links.
template <class W>
int LinkSpans(const View& m, const Rows<W>& s, const CableTable& cable, const Scratch<W>& work,
              const AttachmentWork<W>* ends, RowLink<W>* links) noexcept {
  if (cable.touch >= 0) return LinkGrips(m, s, cable, work, ends, links);
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  int span = 0, first = 0, count = 0;
  int slip = cable.first_slip;
  const auto pull = [&](int i, const V3<W>& direction) {
    const int body = tables[i].body;
    if (body == m.body_count) return;
    int k = first;
    while (k < count && links[k].body != body) ++k;
    if (k == count) {
      RowLink<W>& link = links[count++];
      link.row = span;
      link.body = body;
      link.inv_mass = s.inv_mass[body];
      link.lin[0] = direction;
      link.ang[0] = Cross(ends[i].arm, direction);
    } else {
      links[k].lin[0] += direction;
      links[k].ang[0] += Cross(ends[i].arm, direction);
    }
  };
  int wheel = 0;
  for (int i = 1; i < cable.attachment_count; ++i) {
    const bool over = wheel < cable.wheel_count && i == work.wheels[wheel].at + 1;
    if (over) {
      ++wheel;
    } else {
      pull(i - 1, ends[i].u);
      pull(i, -ends[i].u);
    }
    if (span + 1 == cable.span_count) continue;
    const SlipTable& next = m.slips[slip];
    if (next.wheel >= 0 ? over && next.at + 1 == i : next.at == i) {
      ++slip, ++span;
      first = count;
    }
  }
  TAUT_ASSERT(count <= cable.link_room);
  for (int k = 0; k < count; ++k) {
    links[k].turn[0] = work.bodies[links[k].body].inv_inertia * links[k].ang[0];
  }
  return count;
}

/// Removes wound length from the first span, and from the next spans if the first one is too short.
template <class S>
TAUT_INLINE void WindFirstSpan(int span_count, S wound, S* rest) noexcept {
  using C = Constant<S>;
  constexpr double kLeast = 1e-3;  ///< Smallest rest length of a span, relative to the mean.
  const S zero = C::Of(0.0);
  S all = zero;
  rest[0] += wound;
  for (int i = 0; i < span_count; ++i) all += rest[i];
  const S least = C::Of(kLeast / span_count) * all;
  for (int i = 0; i + 1 < span_count; ++i) {
    const S missing = Max(least - rest[i], zero);
    rest[i] += missing;
    rest[i + 1] -= missing;
  }
  // The last spans may be too short, too.
  for (int i = span_count - 1; i > 0; --i) {
    const S missing = Max(least - rest[i], zero);
    rest[i] += missing;
    rest[i - 1] -= missing;
  }
}

/// Prepares a cable with friction at the middle of the step: runs its actuator and sets up its
/// spans for the solver.
template <class W>
[[gnu::noinline]] void MeetChain(const View& m, const Rows<W>& s, Scratch<W>& work, int c, W h,
                                 W inv_h) noexcept {
  const W half = W::Splat(0.5), quarter = W::Splat(0.25);
  const CableTable& cable = m.cables[c];
  AttachmentWork<W>* const ends = work.attachments;
  const W l = cable.touch >= 0
                  ? FollowBends(m, s, work, cable, h)
                  : MeasureCable<false>(m, s, cable, cable.attachment_count, work, ends).l;
  KeepWheels(s, cable, work);
  const W before = s.rest[c], k = s.stiffness[c];
  W rest = before, rate = s.rest_rate[c];
  const W mean = Actuate(cable, k, l, s.target[c], h, inv_h, rest, rate);
  s.rest[c] = rest;
  s.rest_rate[c] = rate;
  W length[kMostSpans], ratio[kMostSpans], rests[kMostSpans];
  MeasureSpans(m, s, cable, work, ends, length, ratio);
  for (int i = 0; i < cable.span_count; ++i) rests[i] = s.span_rest[cable.first_span + i];
  CarryOverAll(m, s, cable, work, ends, length, true, rests);
  // The spans, connected in series, have the stiffness of the cable.
  const W area = k * before;
  if (cable.touch >= 0) {
    WindGrips(m, s, cable, rest - before, rests);
  } else {
    WindFirstSpan(cable.span_count, rest - before, rests);
  }
  RowLink<W>* const links = work.chain_links + cable.first_link;
  work.chain_link_count[c] = LinkSpans(m, s, cable, work, ends, links);
  W rate0[kMostSpans];
  for (int i = 0; i < cable.span_count; ++i) rate0[i] = W::Splat(0.0);
  for (int j = 0; j < work.chain_link_count[c]; ++j) {
    const BodyWork<W>& body = work.bodies[links[j].body];
    rate0[links[j].row] -= Dot(links[j].lin[0], body.v0) + Dot(links[j].ang[0], body.w0);
  }
  for (int i = 0; i < cable.span_count; ++i) {
    s.span_rest[cable.first_span + i] = rests[i];
    ChainSpan<W>& span = work.spans[cable.first_span + i];
    W stretch = length[i] - rests[i], speed = half * rate0[i];
    if (i == 0) stretch += rest - mean;
    span.stretch = stretch - quarter * h * rate0[i];
    span.rate = speed;
    span.stiffness = area / rests[i];
    span.slip_stiffness = span.stiffness * (Max(length[i], rests[i]) / rests[i]);
    span.damping = s.damping[c] * (before / rests[i]);
    span.ratio = ratio[i];
    span.l = h * s.span_tension[cable.first_span + i];
  }
  CableWork<W>& row = work.cables[c];
  row.soft = row.damped = MaskOf<W>::Splat(false);
  row.spring = row.stretch = row.tension = row.A = W::Splat(0.0);
  row.links = work.links.From(work.link_count);
  row.link_count = 0;
}

/// Returns the chain of a lane without its links. `spans`: memory for its spans.
template <class L, class W>
CableChain<L> ChainOfLane(const View& m, const Rows<W>& s, const CableTable& cable,
                          const Scratch<W>& work, ChainSpan<L>* spans, int lane, L h) noexcept {
  CableChain<L> chain;
  chain.rows = SpansIn(m, s, cable, lane);
  chain.h = h;
  chain.spans = spans;
  chain.link_count = 0;
  chain.links = nullptr;
  for (int i = 0; i < chain.rows; ++i) {
    const ChainSpan<W>& from = work.spans[cable.first_span + i];
    spans[i] = {OfLane<L>(from.stretch, lane),   OfLane<L>(from.rate, lane),
                OfLane<L>(from.stiffness, lane), OfLane<L>(from.slip_stiffness, lane),
                OfLane<L>(from.damping, lane),   OfLane<L>(from.ratio, lane),
                OfLane<L>(from.l, lane)};
  }
  return chain;
}

/// Applies the slip of a lane to the rest lengths (`rest`) and friction losses (`loss`) of a cable.
/// No span loses more than 80 % of its rest length.
template <class W, class Tag>
void Slip(const Capstan<Tag>& found, double area_n, int lane, W* rest, W* loss) noexcept {
  constexpr double kMost = 0.8;
  const int n = found.count;
  const auto gets = [&](int i) {
    return (i > 0 ? found.slip[i - 1] : 0.0) - (i + 1 < n ? found.slip[i] : 0.0);
  };
  double share = 1.0;
  for (int i = 0; i < n; ++i) {
    if (-gets(i) * share > kMost * rest[i][lane]) share = kMost * rest[i][lane] / -gets(i);
  }
  for (int i = 0; i < n; ++i) rest[i].Set(lane, rest[i][lane] + share * gets(i));
  for (int i = 0; i + 1 < n; ++i) {
    const double low = found.tension[i], high = found.tension[i + 1];
    const double stretched = 1.0 + 0.5 * (low + high) / area_n;
    const double work = (high - low) * found.slip[i] * share * stretched;
    loss[i].Set(lane, loss[i][lane] + Max(work, 0.0));
  }
}

/// Computes the readings of the spans, including slip that is not yet applied.
template <class W>
[[gnu::noinline]] void SenseChain(const View& m, const Rows<W>& s, Scratch<W>& work,
                                  int c) noexcept {
  const CableTable& cable = m.cables[c];
  const AttachmentWork<W>* const ends = work.attachments;
  W length[kMostSpans], ratio[kMostSpans], rests[kMostSpans], loss[kMostSpans];
  MeasureSpans(m, s, cable, work, ends, length, ratio);
  for (int i = 0; i < cable.span_count; ++i) rests[i] = s.span_rest[cable.first_span + i];
  for (int i = 0; i + 1 < cable.span_count; ++i) loss[i] = s.slip_loss[cable.first_slip + i];
  CarryOverAll(m, s, cable, work, ends, length, false, rests);
  // Large slip into a short span changes its stiffness, so the computation is repeated.
  constexpr int kRounds = 4;
  W elastic = W::Splat(0.0);
  for (int lane = 0; lane < W::kLanes; ++lane) {
    const double area_n = s.stiffness[c][lane] * s.rest[c][lane];
    for (int round = 0; round < kRounds; ++round) {
      Capstan<simd::Lane<W>> law;
      law.count = SpansIn(m, s, cable, lane);
      for (int i = 0; i < law.count; ++i) {
        const double L = rests[i][lane], l = length[i][lane];
        const double slips = area_n / L * (l > L ? l / L : 1.0);
        law.spans[i] = {area_n / L * (l - L) / slips, l - L, 1.0 / slips, 1.0 / slips};
        law.ratio[i] = ratio[i][lane];
      }
      law.Solve();
      Slip(law, area_n, lane, rests, loss);
      elastic.Set(lane, law.tension[0]);
    }
  }
  for (int i = 0; i < cable.span_count; ++i) {
    s.sense_span_length[cable.first_span + i] = length[i];
    s.sense_span_rest[cable.first_span + i] = rests[i];
    if (i + 1 < cable.span_count) s.sense_slip_loss[cable.first_slip + i] = loss[i];
  }
  s.sense_tension[c] = s.tension[c];
  s.sense_elastic[c] = elastic;
}

/// Applies the solved tensions: changes momenta, slip and friction losses.
template <class W>
void FinishChains(const View& m, const Rows<W>& s, const Scratch<W>& work, double step_s) noexcept {
  using L = simd::Lane<W>;
  const W zero = W::Splat(0.0), inv_h = W::Splat(1.0 / step_s);
  for (int c = 0; c < m.cable_count; ++c) {
    const CableTable& cable = m.cables[c];
    if (cable.span_count == 0) continue;
    W u[kMostSpans];
    for (int i = 0; i < cable.span_count; ++i) u[i] = zero;
    const RowLink<W>* const links = work.chain_links + cable.first_link;
    for (int j = 0; j < work.chain_link_count[c]; ++j) {
      const BodyWork<W>& body = work.bodies[links[j].body];
      AddVelocity(links[j], body.v, body.w, u);
      const V3<W> turn = work.spans[cable.first_span + links[j].row].l * links[j].ang[0];
      V3<W>& mom = s.mom[links[j].body];
      mom = cable.touch < 0 ? mom + turn : Pick(Pulls(links[j]), mom + turn, mom);
    }
    for (int i = 0; i < cable.span_count; ++i) {
      s.span_tension[cable.first_span + i] = inv_h * work.spans[cable.first_span + i].l;
    }
    s.tension[c] = s.span_tension[cable.first_span];
    for (int lane = 0; lane < W::kLanes; ++lane) {
      if (s.halted[0][lane] > 0) continue;
      ChainSpan<L> spans[kMostSpans];
      L rates[kMostSpans];
      const CableChain<L> chain = ChainOfLane<L>(m, s, cable, work, spans, lane, L::Splat(step_s));
      for (int i = 0; i < chain.rows; ++i) rates[i] = OfLane<L>(u[i], lane);
      const auto found = chain.BranchOf(rates, rates);
      Slip(found.law, s.stiffness[c][lane] * s.rest[c][lane], lane, &s.span_rest[cable.first_span],
           &s.slip_loss[cable.first_slip]);
      if (cable.touch < 0) continue;
      DriftAcross(s, work, cable, found.law, s.stiffness[c][lane] * s.rest[c][lane], lane);
    }
  }
}

}  // namespace taut::sim

#include "sim/cables/cable_grips.inl"
