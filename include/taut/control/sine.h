/// Sine wave as velocity input of impedance control, as in the hand-tuned gait of Mirletz et al.
/// 2015.
#pragma once

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// Wave of one cable.
template <class Real>
struct Sine {
  Real amplitude_m_per_s;  ///< Amplitude; may be negative.
  Real phase_turns;        ///< Phase at t = 0; -1/2..1/2.
  Real offset_m_per_s;
};

/// Returns the phase of a wave at a time [turns], -1/2..1/2. The product of time and frequency does
/// not drift, but in float it is accurate only for minutes. A microcontroller adds frequency times
/// period to a phase and wraps it instead.
template <class Real>
constexpr Real ClockTurns(Real frequency_hz, Real time_s) noexcept {
  return WrapTurns(frequency_hz * time_s);
}

/// Returns V0 = offset + amplitude cos(2 pi (clock + phase)) [m/s] (docs/theory/gaits.md, eq. G.1).
/// `clock_turns`: phase of the clock.
template <class Real>
constexpr Real SineVelocity(const Sine<Real>& wave, Real clock_turns) noexcept {
  return wave.offset_m_per_s +
         wave.amplitude_m_per_s * CosTurns(WrapTurns(clock_turns + wave.phase_turns));
}

}  // namespace control
}  // namespace taut
