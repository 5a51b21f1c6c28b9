/// Cable readings: length, rate, tension and stiffness, with the same fields for one cable, for
/// rows of many cables and for the lanes of a SIMD register. Free of the standard library, because
/// code that is compiled once per instruction set includes it.
#pragma once

namespace taut {

/// Number: double; a pointer to a row, with cable c of lane j at [c * lanes + j]; or a SIMD number.
template <class Number>
struct CableReadings {
  Number rest_length_m{};  ///< L, as a robot's encoder measures it.
  Number length_m{};       ///< l: path length between the ends, along all attachments.
  Number rate_m_per_s{};   ///< dl/dt, exact.
  // Forces of stiff cables are means over the last step (docs/theory/cables.md, section 3).
  Number tension_n{};          ///< Spring and damper, as a load cell measures it.
  Number elastic_n{};          ///< Spring only, max(0, k (l - L)): NTRT logs this as tension.
  Number stiffness_n_per_m{};  ///< k.
};

/// Readings of many cables.
using ReadingRows = CableReadings<const double*>;

/// Calls f(field, same field of the next record, ...) for each field.
template <class F, class... Records>
[[gnu::always_inline]] constexpr void EachReading(F f, Records&&... of) {
  f(of.rest_length_m...);
  f(of.length_m...);
  f(of.rate_m_per_s...);
  f(of.tension_n...);
  f(of.elastic_n...);
  f(of.stiffness_n_per_m...);
}

/// Returns a record of f(field) for each field.
template <class F, class Number>
[[gnu::always_inline]] constexpr auto MapReadings(F f, const CableReadings<Number>& of)
    -> CableReadings<decltype(f(of.length_m))> {
  return {.rest_length_m = f(of.rest_length_m),
          .length_m = f(of.length_m),
          .rate_m_per_s = f(of.rate_m_per_s),
          .tension_n = f(of.tension_n),
          .elastic_n = f(of.elastic_n),
          .stiffness_n_per_m = f(of.stiffness_n_per_m)};
}

}  // namespace taut
