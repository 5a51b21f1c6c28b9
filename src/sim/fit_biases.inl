/// Biases that a rigid motion can fulfil (docs/theory/contact.md, eq. 12).
///
/// Points of one body that stick, each with a bias of its own, contradict each other in second
/// order: closing different gaps turns the body, and turning moves the points along the surface.
/// No impulses solve that to the last digit, and half of a heap's work would go into trying. So the
/// biases of contacts that are nearly closed, side by side with the same normal, are replaced by
/// those of the motion that fits them best: a lift along the normal and two tilts, with what the
/// tilts do along the surface.

namespace taut::sim {

/// Contacts that close or are pushed out faster than this keep their own bias [m/s].
inline constexpr double kFittedMPerS = 0.05;
/// Normals this near are the same (as cosine).
inline constexpr double kSameNormal = 0.999;

/// x <- A^-1 x, 3x3, symmetric positive definite; the lower triangle counts.
template <class Num>
TAUT_INLINE void SolveThree(Num (&a)[3][3], Num (&x)[3]) noexcept {
  for (int k = 0; k < 3; ++k) {
    const Num inverse = Num::Splat(1.0) / a[k][k];
    for (int i = k + 1; i < 3; ++i) {
      const Num f = a[i][k] * inverse;
      for (int j = k + 1; j <= i; ++j) a[i][j] -= f * a[j][k];
      x[i] -= f * x[k];
    }
    a[k][k] = inverse;
  }
  for (int k = 2; k >= 0; --k) {
    for (int j = k + 1; j < 3; ++j) x[k] -= a[j][k] * x[j];
    x[k] = x[k] * a[k][k];
  }
}

/// The contacts of one patch: those with `share` 1, all between the same two bodies. `n`, `t1`,
/// `t2`: the patch's directions.
template <class Num, int kLinks, class Share>
void FitPatch(Contact<Num, kLinks>* contacts, int count, const V3<Num>& n, const V3<Num>& t1,
              const V3<Num>& t2, const Share& share) noexcept {
  // Of the least squares' matrix, whose largest entries are about 1: picks the smallest motion.
  constexpr double kTiny = 1e-9;
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  Num number = zero, reach = zero;
  V3<Num> centre{zero, zero, zero};
  for (int i = 0; i < count; ++i) {
    number += share(i);
    centre += share(i) * contacts[i].arm[0];
  }
  const auto several = number > one;
  if (!Any(several)) return;
  centre = (one / Max(number, one)) * centre;
  for (int i = 0; i < count; ++i) {
    const V3<Num> arm = contacts[i].arm[0] - centre;
    reach = Max(share(i) * Dot(arm, arm), reach);
  }
  const Num scale = one / Sqrt(Max(reach, Num::Splat(1e-300)));
  Num a[3][3], x[3];
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) a[r][c] = zero;
    a[r][r] = Num::Splat(kTiny);
    x[r] = zero;
  }
  for (int i = 0; i < count; ++i) {
    const V3<Num>& own = contacts[i].links[0].lin[0];
    const V3<Num> turn = Cross(scale * (contacts[i].arm[0] - centre), own);
    const Num row[3] = {Dot(own, n), Dot(turn, t1), Dot(turn, t2)};
    for (int r = 0; r < 3; ++r) {
      const Num f = share(i) * row[r];
      for (int c = 0; c <= r; ++c) a[r][c] += f * row[c];
      x[r] -= f * contacts[i].bias[0];
    }
  }
  SolveThree(a, x);
  const V3<Num> v = x[0] * n, w = scale * (x[1] * t1 + x[2] * t2);
  for (int i = 0; i < count; ++i) {
    Contact<Num, kLinks>& c = contacts[i];
    const auto replace = several & (share(i) > zero);
    const V3<Num> u = v + Cross(w, c.arm[0] - centre);
    for (int r = 0; r < 3; ++r) {
      if (r == 2 && c.one_direction) continue;
      c.bias[r] = Select(replace, -Dot(c.links[0].lin[r], u), c.bias[r]);
    }
  }
}

/// The contacts [0, count) are all between the same two bodies; in `lanes`. Patch by patch, each
/// begun by the first contact that is in none yet.
template <class Num, int kLinks, class M>
void FitBiases(Contact<Num, kLinks>* contacts, int count, M lanes) noexcept {
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  const Num free = Num::Splat(0.0), taken = Num::Splat(1.0), mine = Num::Splat(2.0);
  for (int i = 0; i < count; ++i) {
    Contact<Num, kLinks>& c = contacts[i];
    const auto slow = Abs(c.bias[0]) < Num::Splat(kFittedMPerS);
    c.patch = Select(lanes & (c.live > zero) & slow, free, taken);
  }
  for (int first = 0; first + 1 < count; ++first) {
    const auto starts = contacts[first].patch == free;
    if (!Any(starts)) continue;
    const V3<Num>* const d = contacts[first].links[0].lin;
    for (int i = first; i < count; ++i) {
      const auto same = Dot(contacts[i].links[0].lin[0], d[0]) > Num::Splat(kSameNormal);
      Num& patch = contacts[i].patch;
      patch = Select(starts & (patch == free) & same, mine, patch);
    }
    FitPatch(contacts + first, count - first, d[0], d[1], d[2],
             [&](int i) { return Select(contacts[first + i].patch == mine, one, zero); });
    for (int i = first; i < count; ++i) {
      Num& patch = contacts[i].patch;
      patch = Select(patch == mine, taken, patch);
    }
  }
}

}  // namespace taut::sim
