/// Constraint of a cable with capstan friction on eyelets, wheels, edges or rods
/// (docs/theory/cables.md, eq. 16-19). The constraint has one row per span. The velocity u of a row
/// is the rate at which the span shortens after the step. The impulse of a row is the mean tension
/// of the span over the step, times h. The impulses depend on the velocities of all spans together.
#pragma once

#include "math/cable_law.h"
#include "sim/constraint/capstan.h"
#include "sim/constraint/links.h"

namespace taut::sim {

/// Link of one row.
template <class Num>
struct RowLink : Link<Num, 1> {
  int row;
};
template <class Num>
TAUT_INLINE void AddVelocity(const RowLink<Num>& link, const V3<Num>& v, const V3<Num>& w,
                             Num* u) noexcept {
  u[link.row] += Dot(link.lin[0], v) + Dot(link.ang[0], w);
}
template <class Num>
TAUT_INLINE void Push(const RowLink<Num>& link, const Num* l, V3<Num>& v, V3<Num>& w) noexcept {
  Push(static_cast<const Link<Num, 1>&>(link), l + link.row, v, w);
}

/// Span for the computation of its tension. Mean stretch over the step, before slip: `stretch` - h
/// / 4 u. Mean rate of its length: `rate` - u / 2.
template <class Num>
struct ChainSpan {
  Num stretch, rate;  ///< See above; units [m], [m/s].
  /// Increase of the tension per stretch, and its decrease per rest length that slips into the span
  /// [N/m].
  Num stiffness, slip_stiffness;
  Num damping;  ///< Damping coefficient [N s/m].
  Num ratio;    ///< Tension ratio at the slip point after the span: exp(mu theta).
  Num l;        ///< Impulse [N s].
};

template <class Num>
struct CableChain {
  static_assert(Num::kLanes == 1);
  using Number = Num;
  static constexpr int kRows = kMostSpans;  ///< Maximum number of rows.

  int rows;
  Num h;  ///< Step length [s].
  const ChainSpan<Num>* spans;
  int link_count;
  RowLink<Num>* links;
  Num A[kMostSpans];  ///< Inverse effective masses of the spans [1/kg].

  struct Branch {
    Capstan<Num> law;
    Num wish[kMostSpans];   ///< Impulses that satisfy the law [N s].
    Num bends[kMostSpans];  ///< Rest length that can slip into the span per decrease of u [s].
  };
  static bool Same(const Branch& a, const Branch& b) noexcept {
    bool same = true;
    for (int i = 0; i < a.law.count; ++i) {
      same = same && a.law.upper[i] == b.law.upper[i] && a.law.first[i] == b.law.first[i] &&
             (a.law.tension[i] > 0.0) == (b.law.tension[i] > 0.0) &&
             (i + 1 == a.law.count || a.law.way[i] == b.law.way[i]);
    }
    return same;
  }

  void FinishMasses() noexcept {
    for (int i = 0; i < rows; ++i) A[i] = Num::Splat(0.0);
    for (int i = 0; i < link_count; ++i) AddCoupling(links[i], links[i], &A[links[i].row]);
  }

  /// Solves the law, which depends on the velocities only.
  Branch BranchOf(const Num* u, const Num*) const noexcept {
    Branch b;
    const double step = h[0];
    b.law.count = rows;
    for (int i = 0; i < rows; ++i) {
      const ChainSpan<Num>& s = spans[i];
      const double k = s.stiffness[0], slips = s.slip_stiffness[0], c = s.damping[0];
      const double stretch = s.stretch[0] - 0.25 * step * u[i][0];
      const double rate = s.rate[0] - 0.5 * u[i][0];
      // The damper force is limited to the value that can have built up since the span became taut.
      b.law.spans[i].p = 1.0 / (slips + c / step);
      b.law.spans[i].q = 1.0 / (slips + 2.0 * c / step);
      b.law.spans[i].a = (math::CableLaw{k}.Force(stretch) + c * rate) * b.law.spans[i].p;
      b.law.spans[i].e = stretch;
      b.law.ratio[i] = s.ratio[0];
    }
    b.law.Solve();
    for (int i = 0; i < rows; ++i) {
      const ChainSpan<Num>& s = spans[i];
      b.wish[i] = h * Num::Splat(b.law.tension[i]);
      b.bends[i] = Num::Splat(0.25) * h;
      if (!b.law.upper[i]) {
        b.bends[i] =
            Num::Splat(b.law.spans[i].p) * (b.bends[i] * s.stiffness + Num::Splat(0.5) * s.damping);
      }
    }
    return b;
  }
  Branch Project(const Num* u, const Num*, Num, Num* out) const noexcept {
    const Branch b = BranchOf(u, out);
    for (int i = 0; i < rows; ++i) out[i] = b.wish[i];
    return b;
  }
  void ProjectFrozen(const Num* u, const Num* center, Num e, const Num*, Num* out) const noexcept {
    Project(u, center, e, out);
  }
  void Derivative(const Branch& b, Num, Num* g) const noexcept {
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < rows; ++j) {
        const bool together = b.law.first[i] == b.law.first[j] && b.law.tension[i] > 0.0;
        g[rows * i + j] = Num::Splat(0.0);
        if (!together) continue;
        g[rows * i + j] = h * Num::Splat(b.law.weight[i] / b.law.slope[i]) * b.bends[j];
      }
    }
  }
  void Stiffen(const Branch&, Num, Num*) const noexcept {}

  Num Residual(const Branch& b, const Num*, const Num* l_now) const noexcept {
    const Num one = Num::Splat(1.0);
    Num worst = Num::Splat(0.0);
    for (int i = 0; i < rows; ++i) {
      Num gain = Num::Splat(0.0);
      if (b.law.tension[i] > 0.0) {
        gain = h * Num::Splat(b.law.weight[i] / b.law.slope[i]) * b.bends[i];
      }
      worst = Max(Abs(b.wish[i] - l_now[i]) * A[i] / (one + gain * A[i]), worst);
    }
    return worst;
  }
  /// Linearizes the law: dl = f - g du. Returns whether g is symmetric.
  bool Step(const Branch& b, const Num*, const Num* l_now, Num e, Num* g, Num* f) const noexcept {
    Derivative(b, e, g);
    bool symmetric = true;
    for (int i = 0; i < rows; ++i) {
      f[i] = b.wish[i] - l_now[i];
      for (int j = 0; j < i; ++j) symmetric = symmetric && g[rows * i + j].v == g[rows * j + i].v;
    }
    return symmetric;
  }
  /// Moves the impulses toward the solution of this constraint alone.
  void SolveAlone(const Num* u, Num* l_now) const noexcept {
    const Branch b = BranchOf(u, l_now);
    const Num one = Num::Splat(1.0);
    for (int i = 0; i < rows; ++i) {
      Num gain = Num::Splat(0.0);
      for (int j = 0; j < rows; ++j) {
        if (b.law.first[i] != b.law.first[j] || !(b.law.tension[i] > 0.0)) continue;
        gain += h * Num::Splat(b.law.weight[i] / b.law.slope[i]) * b.bends[j] * A[j];
      }
      l_now[i] += (b.wish[i] - l_now[i]) / (one + gain);
    }
  }
  void Clamp(Num* l_now) const noexcept {
    for (int i = 0; i < rows; ++i) l_now[i] = Max(l_now[i], Num::Splat(0.0));
  }
};

}  // namespace taut::sim
