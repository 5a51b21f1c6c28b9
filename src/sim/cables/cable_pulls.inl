/// Pulls of a cable on its bodies: links, mean rate, and the tensions of soft cables by
/// Gauss-Seidel relaxation over all cables (docs/theory/integrator.md, eq. I7, I8).
///
/// `kTwo`: the cable joins two bodies (CableTable::joins_two). A compile-time constant keeps the
/// links in registers.
#pragma once

#include "sim/cables/cable_wrapping.inl"
#include "sim/data/rows.h"

namespace taut::sim {

template <class W>
TAUT_INLINE void AddLink(const Rows<W>& s, CableWork<W>& row, int body, const V3<W>& direction,
                         const V3<W>& arm) noexcept {
  Link<W, 1>& link = row.links[row.link_count++];
  link.body = body;
  link.inv_mass = s.inv_mass[body];
  link.lin[0] = direction;
  link.ang[0] = Cross(arm, direction);
}

/// Adds a pull to the link of its body.
template <class W>
TAUT_INLINE void AddPull(const View& m, const Rows<W>& s, CableWork<W>& row, int body,
                         const V3<W>& direction, const V3<W>& arm) noexcept {
  if (body == m.body_count) return;
  Link<W, 1>* link = row.links;
  Link<W, 1>* const end = link + row.link_count;
  while (link != end && link->body != body) ++link;
  if (link == end) {
    AddLink(s, row, body, direction, arm);
  } else {
    link->lin[0] += direction;
    link->ang[0] += Cross(arm, direction);
  }
}

/// Sets the links of a cable: one per body, with the sum of all pulls on it.
template <bool kTwo, class W>
TAUT_INLINE void LinkCable(const View& m, const Rows<W>& s, Scratch<W>& work,
                           const CableTable& cable, const AttachmentWork<W>* ends,
                           CableWork<W>& row) noexcept {
  const AttachmentTable* const tables = m.attachments + cable.first_attachment;
  row.links = work.links.From(work.link_count);
  row.link_count = 0;
  if constexpr (kTwo) {
    AddLink(s, row, tables[0].body, ends[1].u, ends[0].arm);
    AddLink(s, row, tables[1].body, -ends[1].u, ends[1].arm);
  } else {
    const int last = cable.attachment_count - 1;
    if (cable.touch >= 0) {
      const int count = 2 + 2 * work.bends_used;
      AddPull(m, s, row, tables[0].body, PullAt(count, ends, 0), ends[0].arm);
      AddPull(m, s, row, tables[last].body, PullAt(count, ends, count - 1), ends[count - 1].arm);
      if (m.touches[cable.touch].rod_count > 0) LinkRods(m, s, work, cable, ends, row);
    } else {
      for (int i = 0; i <= last; ++i) {
        AddPull(m, s, row, tables[i].body, PullAt(last + 1, ends, i), ends[i].arm);
      }
    }
  }
  work.link_count += row.link_count;
}

/// Computes the velocity changes of the bodies per impulse along the cable.
template <bool kTwo, class W>
TAUT_INLINE void FinishLinks(const Scratch<W>& work, CableWork<W>& row) noexcept {
  if constexpr (kTwo) {
    Link<W, 1>&a = row.links[0], &b = row.links[1];
    a.turn[0] = work.bodies[a.body].inv_inertia * a.ang[0];
    b.turn[0] = work.bodies[b.body].inv_inertia * b.ang[0];
    row.A = a.inv_mass + b.inv_mass + (Dot(a.ang[0], a.turn[0]) + Dot(b.ang[0], b.turn[0]));
  } else {
    row.A = W::Splat(0.0);
    for (int i = 0; i < row.link_count; ++i) {
      Link<W, 1>& link = row.links[i];
      link.turn[0] = work.bodies[link.body].inv_inertia * link.ang[0];
      AddCoupling(link, link, &row.A);
    }
  }
}

/// Returns the mean rate over the step from the latest mean velocities.
template <bool kTwo, class W>
TAUT_INLINE W MeanRate(const Scratch<W>& work, const CableWork<W>& row) noexcept {
  W dl = W::Splat(0.0);
  for (int i = 0; i < (kTwo ? 2 : row.link_count); ++i) {
    const BodyWork<W>& body = work.bodies[row.links[i].body];
    dl -= Dot(row.links[i].lin[0], body.v_mid) + Dot(row.links[i].ang[0], body.w_mid);
  }
  return dl;
}

/// Updates the tension of a soft cable by its law T = k s + b dl >= 0, where dl is the mean rate
/// over the step (eq. I8). The result is exact if no other tension changes. Also updates the mean
/// velocities of the bodies, unless `half_h` is 0.
template <bool kTwo, class W>
TAUT_INLINE void RelaxCable(Scratch<W>& work, CableWork<W>& row, W dl, W half_h) noexcept {
  const W zero = W::Splat(0.0);
  const int link_count = kTwo ? 2 : row.link_count;
  const W wish = row.tension + row.share * (row.spring + row.damping * dl - row.tension);
  const W tension = Select(row.damped, Min(Max(wish, zero), row.upper), row.spring);
  const W change = half_h * (tension - row.tension);
  row.tension = tension;
  for (int i = 0; i < link_count; ++i) {
    BodyWork<W>& body = work.bodies[row.links[i].body];
    Push(row.links[i], &change, body.v_mid, body.w_mid);
  }
}

/// Applies the final tension of a soft cable to its bodies. `kAllSoft`: the cable is soft in all
/// lanes.
template <bool kTwo, bool kAllSoft, class W>
TAUT_INLINE void PullCable(const Rows<W>& s, Scratch<W>& work, int c) noexcept {
  const CableWork<W>& row = work.cables[c];
  const int link_count = kTwo ? 2 : row.link_count;
  const W pull = kAllSoft ? row.tension : Select(row.soft, row.tension, W::Splat(0.0));
  s.tension[c] = kAllSoft ? pull : Select(row.soft, row.tension, s.tension[c]);
  for (int i = 0; i < link_count; ++i) {
    BodyWork<W>& body = work.bodies[row.links[i].body];
    body.force += pull * row.links[i].lin[0];
    body.torque += pull * row.links[i].ang[0];
  }
}

/// Second relaxation of all cables, in reverse order.
template <bool kAllSoft, class W>
TAUT_INLINE void RelaxBack(const View& m, const Rows<W>& s, Scratch<W>& work, W half_h) noexcept {
  for (int c = m.cable_count - 1; c >= 0; --c) {
    CableWork<W>& row = work.cables[c];
    if (!kAllSoft && !Any(row.soft)) continue;
    if (m.cables[c].joins_two) {
      RelaxCable<true>(work, row, MeanRate<true>(work, row), half_h);
      PullCable<true, kAllSoft>(s, work, c);
    } else {
      RelaxCable<false>(work, row, MeanRate<false>(work, row), half_h);
      PullCable<false, kAllSoft>(s, work, c);
    }
  }
}

}  // namespace taut::sim
