/// Capstan friction of a cable (docs/theory/cables.md, section 5). Slip points divide the cable
/// into spans with different tensions. At a slip point with the tension ratio c = exp(mu theta):
///
///   T / c <= T' <= c T;  only at equality, the cable slips toward the greater tension
///
/// All slip points form one complementarity problem, because a solution one by one would depend on
/// their order. The code is scalar, for one lane.
#pragma once

#include "math/scalar.h"

namespace taut::sim {

/// Maximum number of spans of a cable with friction.
inline constexpr int kMostSpans = 16;

/// Relation between the tension T of a span and the rest length x that slips into it. A slack span
/// takes any larger x.
///   x = min(a - p T, e - q T)   while T > 0
struct CapstanSpan {
  double a, e;  ///< Coefficients a, e [m].
  double p, q;  ///< Coefficients p, q > 0 [m/N].
};

/// `Tag`: type that differs between instruction sets, so that each set has a separate
/// instantiation.
template <class Tag>
struct Capstan {
  int count;
  CapstanSpan spans[kMostSpans];
  double ratio[kMostSpans];  ///< >= 1, per slip point: point i is after span i.

  // Results:
  double tension[kMostSpans];  ///< Tension of each span [N].
  double slip[kMostSpans];     ///< Rest length that slips from span i to span i + 1 [m].
  double weight[kMostSpans];   ///< Tension ratios within a group of spans that slip together.
  /// Decrease of rest length per T of all spans that slip together with i.
  double slope[kMostSpans];
  int first[kMostSpans];   ///< First span of the group that slips together with i.
  bool upper[kMostSpans];  ///< The span is on the branch x = e - q T.
  int way[kMostSpans];     ///< 1: T' = c T, -1: T = c T', 0: the point sticks.

  void Solve() noexcept {
    for (int i = 0; i + 1 < count; ++i) way[i] = ratio[i] > 1.0 ? 0 : 1;
    for (int round = 0; round < kMostRounds; ++round) {
      for (int i = 0; i < count;) i = SlipTogether(i);
      // Changing all wrong states at once is fast but may cycle. Changing only the first one cannot
      // cycle (Murty's rule).
      if (!Revise(round > 2 * count)) return;
    }
  }

 private:
  static constexpr int kMostRounds = 400;
  /// Relative differences below this value are rounding errors and do not change the state of a
  /// slip point.
  static constexpr double kRounding = 1e-13;

  /// Returns x of a taut span with the tension T.
  double RestAt(int i, double T) noexcept {
    const CapstanSpan& s = spans[i];
    const double lower_x = s.a - s.p * T, upper_x = s.e - s.q * T;
    upper[i] = upper_x < lower_x;
    return upper[i] ? upper_x : lower_x;
  }

  /// Solves the group of spans that slip together, starting with `begin`. Returns the first span
  /// after it.
  int SlipTogether(int begin) noexcept {
    int end = begin + 1;
    weight[begin] = 1.0;
    while (end < count && way[end - 1] != 0) {
      const double c = ratio[end - 1];
      weight[end] = way[end - 1] > 0 ? weight[end - 1] * c : weight[end - 1] / c;
      ++end;
    }
    // The sum of x decreases with T at an increasing slope. One Newton step from the left may
    // overshoot; the next ones return.
    double T = 0.0, x[kMostSpans], sum = 0.0, steep = 0.0;
    for (int i = 0;; ++i) {
      sum = steep = 0.0;
      for (int k = begin; k < end; ++k) {
        x[k] = RestAt(k, weight[k] * T);
        sum += x[k];
        steep += weight[k] * (upper[k] ? spans[k].q : spans[k].p);
      }
      const double next = T + sum / steep;
      if (i == 2 * kMostSpans || !(next > 0.0) || next == T || (i > 1 && !(next < T))) break;
      T = next;
    }
    const bool slack = !(T > 0.0);
    double moved = 0.0;
    for (int k = begin; k < end; ++k) {
      // The total slack is distributed equally, since its distribution is indeterminate.
      const double gets = end == begin + 1 ? 0.0 : slack ? x[k] - sum / (end - begin) : x[k];
      moved -= gets;
      tension[k] = slack ? 0.0 : weight[k] * T;
      first[k] = begin;
      slope[k] = steep;
      if (k + 1 < end) slip[k] = moved;
    }
    if (end < count) slip[end - 1] = 0.0;
    return end;
  }

  /// Updates the slip points: a point that slips against its tension difference becomes sticking; a
  /// sticking point beyond the tension ratio becomes slipping. Returns whether any state changed.
  bool Revise(bool one_only) noexcept {
    bool changed = false;
    for (int i = 0; i + 1 < count && !(changed && one_only); ++i) {
      const double c = ratio[i];
      if (!(c > 1.0)) continue;
      const double room = 1.0 + kRounding;
      int now = way[i];
      if (now == 0) {
        if (tension[i + 1] > room * c * tension[i]) {
          now = 1;
        } else if (tension[i] > room * c * tension[i + 1]) {
          now = -1;
        }
      } else if (now * slip[i] < 0.0) {
        now = 0;
      }
      changed = changed || now != way[i];
      way[i] = now;
    }
    return changed;
  }
};

}  // namespace taut::sim
