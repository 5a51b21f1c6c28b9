/// Fit of contact biases to a rigid motion (docs/theory/contact.md, eq. 12).
///
/// Separate biases of the sticking points of one body contradict each other in second order:
/// closing different gaps rotates the body, and this rotation moves the points along the surface.
/// No impulses can satisfy them exactly, and the solver would waste half of its time on a heap.
/// Therefore contacts that are nearly closed are grouped into patches with the same bodies and
/// normal. The biases of a patch are replaced by the biases of the best-fitting motion: a lift
/// along the normal and two tilts.
#pragma once

#include "math/scalar.h"
#include "sim/data/contacts.h"
#include "sim/data/island.h"
#include "simd/vec3.h"

namespace taut::sim {

/// Contacts that close or are pushed out faster than this keep their bias [m/s].
inline constexpr double kFittedMPerS = 0.05;
/// Normals count as equal if the cosine of their angle is larger.
inline constexpr double kSameNormal = 0.999;

/// Computes x <- A^-1 x for a symmetric positive definite A; reads and overwrites its lower
/// triangle.
template <class Num, int N>
TAUT_INLINE void SolveSymmetric(Num (&a)[N][N], Num (&x)[N]) noexcept {
  for (int k = 0; k < N; ++k) {
    const Num inverse = Num::Splat(1.0) / a[k][k];
    for (int i = k + 1; i < N; ++i) {
      const Num f = a[i][k] * inverse;
      for (int j = k + 1; j <= i; ++j) a[i][j] -= f * a[j][k];
      x[i] -= f * x[k];
    }
    a[k][k] = inverse;
  }
  for (int k = N - 1; k >= 0; --k) {
    for (int j = k + 1; j < N; ++j) x[k] -= a[j][k] * x[j];
    x[k] = x[k] * a[k][k];
  }
}

/// Fits the biases of one patch: the contacts with `share` 1, all between the same two bodies. `n`,
/// `t1`, `t2`: directions of the patch. `most`: largest allowed change of a bias [m/s]; if any bias
/// would change more, none changes.
template <class Num, int kLinks, class Share>
void FitPatch(Contact<Num, kLinks>* contacts, int count, const V3<Num>& n, const V3<Num>& t1,
              const V3<Num>& t2, const Share& share, double most) noexcept {
  // Regularization of the least-squares matrix, whose largest entries are about 1. The
  // regularization selects the smallest motion.
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
  SolveSymmetric(a, x);
  const V3<Num> v = x[0] * n, w = scale * (x[1] * t1 + x[2] * t2);
  auto fits = several;
  for (int i = 0; most < kFittedMPerS && i < count; ++i) {
    const Contact<Num, kLinks>& c = contacts[i];
    const V3<Num> u = v + Cross(w, c.arm[0] - centre);
    const Num change = share(i) * Abs(c.bias[0] + Dot(c.links[0].lin[0], u));
    fits = fits & (change < Num::Splat(most));
  }
  for (int i = 0; i < count; ++i) {
    Contact<Num, kLinks>& c = contacts[i];
    const auto replace = fits & (share(i) > zero);
    const V3<Num> u = v + Cross(w, c.arm[0] - centre);
    for (int r = 0; r < 3; ++r) {
      if (r == 2 && c.one_direction) continue;
      c.bias[r] = Select(replace, -Dot(c.links[0].lin[r], u), c.bias[r]);
    }
  }
}

/// Fits the biases of the contacts [0, count), all between the same two bodies, in `lanes`. The
/// first contact without a patch starts the next patch. `most`: see FitPatch.
template <class Num, int kLinks, class M>
void FitBiases(Contact<Num, kLinks>* contacts, int count, M lanes,
               double most = kFittedMPerS) noexcept {
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
    FitPatch(
        contacts + first, count - first, d[0], d[1], d[2],
        [&](int i) { return Select(contacts[first + i].patch == mine, one, zero); }, most);
    for (int i = first; i < count; ++i) {
      Num& patch = contacts[i].patch;
      patch = Select(patch == mine, taken, patch);
    }
  }
}

/// Makes the biases of a body's contacts with static geometry consistent if they have several
/// normals. For example, a body jammed in a groove sticks with more rows than it has degrees of
/// freedom. If the best-fitting motion deviates by less than kDisagreementMPerS, its biases replace
/// the original ones (docs/theory/contact.md, eq. 12b).
template <class Num, class M>
[[gnu::noinline]] void AgreeBiases(Contact<Num, 1>* contacts, int count, M lanes) noexcept {
  constexpr double kTiny = 1e-9, kNearlyClosed = 10 * kDisagreementMPerS;
  const Num zero = Num::Splat(0.0), one = Num::Splat(1.0);
  const int rows = contacts[0].one_direction ? 2 : 3;
  auto several = M::Splat(false);
  for (int i = 1; i < count; ++i) {
    const Num cosine = Dot(contacts[i].links[0].lin[0], contacts[0].links[0].lin[0]);
    several = several | ((contacts[i].live > zero) & (cosine < Num::Splat(kSameNormal)));
  }
  lanes = lanes & several;
  if (!Any(lanes)) return;
  Num reach = zero;
  for (int i = 0; i < count; ++i) {
    const auto closed = Abs(contacts[i].bias[0]) < Num::Splat(kNearlyClosed);
    contacts[i].patch = Select(lanes & (contacts[i].live > zero) & closed, one, zero);
    reach = Max(contacts[i].patch * Dot(contacts[i].arm[0], contacts[i].arm[0]), reach);
  }
  const Num scale = one / Sqrt(Max(reach, Num::Splat(1e-300)));
  Num a[6][6], x[6];
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) a[r][c] = zero;
    a[r][r] = Num::Splat(kTiny);
    x[r] = zero;
  }
  const auto row_of = [&](const Contact<Num, 1>& c, int r, Num(&row)[6]) {
    const V3<Num>& d = c.links[0].lin[r];
    const V3<Num> turn = Cross(scale * c.arm[0], d);
    row[0] = d.x, row[1] = d.y, row[2] = d.z, row[3] = turn.x, row[4] = turn.y, row[5] = turn.z;
  };
  Num row[6];
  for (int i = 0; i < count; ++i) {
    for (int r = 0; r < rows; ++r) {
      row_of(contacts[i], r, row);
      for (int j = 0; j < 6; ++j) {
        const Num f = contacts[i].patch * row[j];
        for (int k = 0; k <= j; ++k) a[j][k] += f * row[k];
        x[j] -= f * contacts[i].bias[r];
      }
    }
  }
  SolveSymmetric(a, x);
  const auto missed = [&](const Contact<Num, 1>& c, int r) {
    row_of(c, r, row);
    Num miss = c.bias[r];
    for (int j = 0; j < 6; ++j) miss += row[j] * x[j];
    return c.patch * miss;
  };
  Num most = zero;
  for (int i = 0; i < count; ++i) {
    for (int r = 0; r < rows; ++r) most = Max(Abs(missed(contacts[i], r)), most);
  }
  const Num relaxes = Select(most < Num::Splat(kDisagreementMPerS), one, zero);
  for (int i = 0; i < count; ++i) {
    for (int r = 0; r < rows; ++r) contacts[i].bias[r] -= relaxes * missed(contacts[i], r);
  }
}

}  // namespace taut::sim
