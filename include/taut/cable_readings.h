/// What is read of a cable: the same fields for one cable's numbers, for rows of many cables and
/// for the lanes of a register. Without the standard library, so that code which is compiled once
/// an instruction set may include it.
#pragma once

namespace taut {

/// Number: double; a pointer to a row, with cable c of lane j at [c * lanes + j]; a wide number.
template <class Number>
struct CableReadings {
  Number rest_length_m{};  ///< L; a robot's encoder.
  Number length_m{};       ///< l: between its ends, along all attachments.
  Number rate_m_per_s{};   ///< dl/dt, exact.
  // Forces of stiff cables are means over the last step (docs/theory/cables.md, section 3).
  Number tension_n{};          ///< What a load cell feels: spring and damper.
  Number elastic_n{};          ///< max(0, k (l - L)) alone: what NTRT logs.
  Number stiffness_n_per_m{};  ///< k.
};

/// Of many cables.
using ReadingRows = CableReadings<const double*>;

/// f(field, same field of the next record, ...) of every field.
template <class F, class... Records>
[[gnu::always_inline]] constexpr void EachReading(F f, Records&&... of) {
  f(of.rest_length_m...);
  f(of.length_m...);
  f(of.rate_m_per_s...);
  f(of.tension_n...);
  f(of.elastic_n...);
  f(of.stiffness_n_per_m...);
}

/// A record of what f(field) gives for every field.
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
