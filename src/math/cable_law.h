/// Elastic law of a cable: force as a function of stretch (docs/theory/cables.md, eq. 1). This is
/// the only definition, for the step, statics, energies, starts and sizing. Callers add the damper
/// and the condition that a cable does not push.
#pragma once

namespace taut::math {

/// Linear spring with stiffness k [N/m]. `Num`: double or a SIMD number. Another law would be a
/// branch in the member functions; callers need no change.
template <class Num>
struct CableLaw {
  Num stiffness;

  /// Returns the force at a stretch (length minus rest length) > 0 [N].
  [[gnu::always_inline]] constexpr Num Force(Num stretch_m) const noexcept {
    return stiffness * stretch_m;
  }
  /// Returns the derivative of the force with respect to the stretch [N/m].
  [[gnu::always_inline]] constexpr Num Slope(Num) const noexcept { return stiffness; }
  /// Returns the stretch at a force >= 0 [m].
  [[gnu::always_inline]] constexpr Num Stretch(Num force_n) const noexcept {
    return force_n / stiffness;
  }
  /// Returns the stored energy at a stretch >= 0 [J].
  constexpr double Energy(double stretch_m) const noexcept {
    return 0.5 * stiffness * stretch_m * stretch_m;
  }
};
template <class Num>
CableLaw(Num) -> CableLaw<Num>;

}  // namespace taut::math
