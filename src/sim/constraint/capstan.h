/// Capstan friction of a cable (docs/theory/cables.md, section 5). Slip places divide the cable
/// into spans, each with a tension; at a place with the ratio c = exp(mu theta)
///
///   T / c <= T' <= c T,   and the cable slips, toward the greater tension, only at equality
///
/// This is one complementarity problem for all slip places, since solving them one by one would
/// make the result depend on the order. Numbers of one lane.
#pragma once

#include "math/scalar.h"

namespace taut::sim {

/// Largest number of spans of a cable with friction.
inline constexpr int kMostSpans = 16;

/// Relation between a span's tension T and the rest length x that slips into it:
///   x = min(a - p T, e - q T)   while T > 0; it is slack with more.
struct CapstanSpan {
  double a, e;  ///< [m]
  double p, q;  ///< > 0 [m/N]
};

/// `Tag`: type that differs between instruction sets, so that each gets its own instantiation.
template <class Tag>
struct Capstan {
  int count;
  CapstanSpan spans[kMostSpans];
  double ratio[kMostSpans];  ///< >= 1, per place: behind span i.

  // Found:
  double tension[kMostSpans];  ///< [N]
  double slip[kMostSpans];     ///< Rest length that moves from span i to span i + 1 [m].
  double weight[kMostSpans];   ///< Ratios of the tensions of spans that slip together.
  double slope[kMostSpans];    ///< Rest length lost per T, of the spans that slip together with i.
  int first[kMostSpans];       ///< First of the spans that slip together with i.
  bool upper[kMostSpans];      ///< The span is on the branch x = e - q T.
  int way[kMostSpans];         ///< 1: T' = c T, -1: T = c T', 0: it sticks.

  void Solve() noexcept {
    for (int i = 0; i + 1 < count; ++i) way[i] = ratio[i] > 1.0 ? 0 : 1;
    for (int round = 0; round < kMostRounds; ++round) {
      for (int i = 0; i < count;) i = SlipTogether(i);
      // Changing all wrong places at once is fast but may cycle; changing the first alone cannot
      // (Murty's rule).
      if (!Revise(round > 2 * count)) return;
    }
  }

 private:
  static constexpr int kMostRounds = 400;
  /// Differences of this relative size are rounding and do not change the state of a place.
  static constexpr double kRounding = 1e-13;

  /// Returns x of a span with the tension T, without slack.
  double RestAt(int i, double T) noexcept {
    const CapstanSpan& s = spans[i];
    const double lower_x = s.a - s.p * T, upper_x = s.e - s.q * T;
    upper[i] = upper_x < lower_x;
    return upper[i] ? upper_x : lower_x;
  }

  /// Solves the spans from `begin` on that slip together. Returns the first span after them.
  int SlipTogether(int begin) noexcept {
    int end = begin + 1;
    weight[begin] = 1.0;
    while (end < count && way[end - 1] != 0) {
      const double c = ratio[end - 1];
      weight[end] = way[end - 1] > 0 ? weight[end - 1] * c : weight[end - 1] / c;
      ++end;
    }
    // The sum of x decreases with T, ever more steeply: one Newton step from the left may go too
    // far; the following ones come back.
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
      // The total slack is divided equally, since its place is undetermined.
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

  /// Updates the slip places: places that slip against their tension stick; sticking places beyond
  /// the ratio slip. Returns whether any changed.
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
