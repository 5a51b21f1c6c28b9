/// Sine wave as velocity input of impedance control: the paper's hand-tuned gait.
#pragma once

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// Wave of one cable.
template <class Real>
struct Sine {
  Real amplitude_m_per_s;  ///< May be negative.
  Real phase_turns;        ///< At t = 0; -1/2..1/2.
  Real offset_m_per_s;
};

/// Returns the phase of a wave at a time [turns], -1/2..1/2. It is computed from the time, so it
/// does not drift; in float it is accurate for minutes (a microcontroller adds frequency times
/// period to a phase and wraps it).
template <class Real>
constexpr Real ClockTurns(Real frequency_hz, Real time_s) noexcept {
  return WrapTurns(frequency_hz * time_s);
}

/// Returns V0 = offset + amplitude cos(2 pi (clock + phase)) [m/s] (docs/theory/gaits.md, eq. G.1),
/// with the clock's phase `clock_turns`.
template <class Real>
constexpr Real SineVelocity(const Sine<Real>& wave, Real clock_turns) noexcept {
  return wave.offset_m_per_s +
         wave.amplitude_m_per_s * CosTurns(WrapTurns(clock_turns + wave.phase_turns));
}

}  // namespace control
}  // namespace taut
