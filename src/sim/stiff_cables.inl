/// Cables that explicit forces would make unstable at this step: their tension is an impulse that
/// the solver finds together with the contacts (docs/theory/cables.md, eq. 8-11).
///
/// While taut, the implicit midpoint rule: length and rate are means of the start and the end of
/// the step. It is stable for any stiffness and loses no energy. A cable that was slack enters by
/// the length at the end of the step instead, so that a sudden stop of a fast end does not turn
/// into a larger rebound; its damper joins one step later, when the cable is known to be taut.

namespace taut::sim {

/// Limit of explicit springs: h^2 K / m, summed over the cables that a cable is coupled to (the
/// explicit scheme is stable below 4).
inline constexpr double kSoftSpring = 0.1;

template <class W>
void AddStiffCable(const View& m, const Rows<W>& s, Scratch<W>& work, int c,
                   const CableWork<W>& linked, W length, W stretch, W h, MaskOf<W> on) noexcept {
  const W zero = W::Splat(0.0), half = W::Splat(0.5);
  const CableTable& cable = m.cables[c];
  StiffCable<W>& row = work.stiff[work.stiff_count++];
  row.cable = c;
  row.live = Select(on, W::Splat(1.0), zero);
  row.links = linked.links;
  row.link_count = linked.link_count;
  W rate = zero;  // before the step
  for (int i = 0; i < row.link_count; ++i) {
    const Link<W, 1>& link = row.links[i];
    const BodyWork<W>& body = work.bodies[link.body];
    rate -= Dot(link.lin[0], body.v0) + Dot(link.ang[0], body.w0);
  }
  const W k = s.stiffness[c];
  // Stretched at the middle of the step before, a step's way ago, even if its damper held the
  // tension at zero.
  const W stretch_before = stretch - h * (rate - s.rest_rate[c]);
  const auto was_taut = (s.tension[c] > zero) | (stretch_before > zero);
  const W b = Select(was_taut & (stretch > zero), s.damping[c], zero);
  const W quarter_hk = W::Splat(0.25) * h * k;
  const W gain = Select(was_taut, quarter_hk + half * b, half * h * k);
  const W base = k * stretch + Select(was_taut, (half * b - quarter_hk) * rate, zero);
  row.base = h * base;
  row.gain = h * gain;
  row.FinishMasses();
  row.across = W::Splat(0.25) * h * h * s.stiff_k[c] / (k * length);
  row.upper = cable.clamped_damping ? h * Max(k * (stretch + stretch), zero) : W::Splat(1e300);
  row.l[0] = Select(on, Min(h * s.tension[c], row.upper), zero);
}

/// Share of the largest stable tension that a stiff cable has. Along itself it is stable at any
/// tension; across itself its force is explicit.
template <class W>
W ShareOfStableTension(const Rows<W>& s, const StiffCable<W>& row) noexcept {
  return Select(row.live > W::Splat(0.0), s.tension[row.cable] * row.across, W::Splat(0.0));
}

/// Tensions and angular momenta of what the solver found.
template <class W>
void FinishStiffCables(const Rows<W>& s, Scratch<W>& work, double step_s) noexcept {
  const W inv_h = W::Splat(1.0 / step_s);
  for (int i = 0; i < work.stiff_count; ++i) {
    const StiffCable<W>& row = work.stiff[i];
    s.tension[row.cable] = Select(row.live > W::Splat(0.0), inv_h * row.l[0], s.tension[row.cable]);
    for (int k = 0; k < row.link_count; ++k) {
      s.mom[row.links[k].body] += row.l[0] * row.links[k].ang[0];
    }
  }
}

}  // namespace taut::sim
