/// Biases that a rigid motion can fulfil (docs/theory/contact.md, eq. 12).
///
/// Points of one body that stick, each with a bias of its own, contradict each other in second
/// order: closing different gaps turns the body, and turning moves the points along the surface.
/// No impulses solve that to the last digit, and half of a heap's work would go into trying. So the
/// biases of contacts that are nearly closed are replaced by those of the motion that fits them
/// best, along the surface, too.

namespace taut::sim {

/// Contacts that close or are pushed out faster than this keep their own bias [m/s].
inline constexpr double kFittedMPerS = 0.05;

/// x <- A^-1 x, 6x6, symmetric positive definite; the lower triangle counts.
template <class Num>
TAUT_INLINE void SolveSix(Num (&a)[6][6], Num (&x)[6]) noexcept {
  for (int k = 0; k < 6; ++k) {
    const Num inverse = Num::Splat(1.0) / a[k][k];
    for (int i = k + 1; i < 6; ++i) {
      const Num f = a[i][k] * inverse;
      for (int j = k + 1; j <= i; ++j) a[i][j] -= f * a[j][k];
      x[i] -= f * x[k];
    }
    a[k][k] = inverse;
  }
  for (int k = 5; k >= 0; --k) {
    for (int j = k + 1; j < 6; ++j) x[k] -= a[j][k] * x[j];
    x[k] = x[k] * a[k][k];
  }
}

/// The contacts [0, count) are all between the same two bodies; in `lanes`.
template <class Num, int kLinks, class M>
void FitBiases(Contact<Num, kLinks>* contacts, int count, M lanes) noexcept {
  // Of the least squares' matrix, whose largest entries are about 1: picks the smallest motion.
  constexpr double kTiny = 1e-9;
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  const auto taken = [&](const Contact<Num, kLinks>& c) {
    return Select((c.live > zero) & (Abs(c.bias[0]) < Num::Splat(kFittedMPerS)), one, zero);
  };
  Num number = zero, reach = zero;
  V3<Num> centre{zero, zero, zero};
  for (int i = 0; i < count; ++i) {
    const Num share = taken(contacts[i]);
    number += share;
    centre += share * contacts[i].arm[0];
  }
  const auto several = lanes & (number > one);
  if (!Any(several)) return;
  centre = (one / Max(number, one)) * centre;
  for (int i = 0; i < count; ++i) {
    const V3<Num> arm = contacts[i].arm[0] - centre;
    reach = Max(taken(contacts[i]) * Dot(arm, arm), reach);
  }
  const Num scale = one / Sqrt(Max(reach, Num::Splat(1e-300)));
  Num a[6][6], x[6];
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) a[r][c] = zero;
    a[r][r] = Num::Splat(kTiny);
    x[r] = zero;
  }
  for (int i = 0; i < count; ++i) {
    const Num share = taken(contacts[i]);
    const V3<Num>& n = contacts[i].links[0].lin[0];
    const V3<Num> turn = Cross(scale * (contacts[i].arm[0] - centre), n);
    const Num row[6] = {n.x, n.y, n.z, turn.x, turn.y, turn.z};
    for (int r = 0; r < 6; ++r) {
      const Num f = share * row[r];
      for (int c = 0; c <= r; ++c) a[r][c] += f * row[c];
      x[r] -= f * contacts[i].bias[0];
    }
  }
  SolveSix(a, x);
  const V3<Num> v{x[0], x[1], x[2]}, w = scale * V3<Num>{x[3], x[4], x[5]};
  for (int i = 0; i < count; ++i) {
    Contact<Num, kLinks>& c = contacts[i];
    const auto replace = several & (taken(c) > zero);
    const V3<Num> u = v + Cross(w, c.arm[0] - centre);
    for (int r = 0; r < 3; ++r) {
      if (r == 2 && c.one_direction) continue;
      c.bias[r] = Select(replace, -Dot(c.links[0].lin[r], u), c.bias[r]);
    }
  }
}

}  // namespace taut::sim
