/// Cable readings: length, rate, tension and stiffness. The same fields serve one cable, rows of
/// many cables, and the lanes of a SIMD register. Free of the standard library, because code that
/// is compiled once per instruction set includes this header.
#pragma once

namespace taut {

/// `Number` is one of: double; a pointer to a row with cable c of lane j at [c * lanes + j]; a SIMD
/// number.
template <class Number>
struct CableReadings {
  Number rest_length_m{};  ///< Rest length L, as measured by the encoder of a robot.
  Number length_m{};       ///< Path length l between the ends, along all attachments.
  Number rate_m_per_s{};   ///< Rate dl/dt of the length, exact, not a difference quotient.
  // Forces of stiff cables are averages over the last step (docs/theory/cables.md, section 3).
  Number tension_n{};          ///< Tension of spring and damper, as measured by a load cell.
  Number elastic_n{};          ///< Tension of the spring: max(0, k (l - L)), logged by NTRT.
  Number stiffness_n_per_m{};  ///< Stiffness k.
};

/// Readings of many cables.
using ReadingRows = CableReadings<const double*>;

/// Calls f(field of the first record, same field of the second record, ...) for each field.
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
