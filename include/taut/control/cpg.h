/// A central pattern generator: phase oscillators with amplitude dynamics, coupled in a network.
///
/// Sources: Mirletz, Park, Quinn, SunSpiral, "Towards bridging the reality gap between tensegrity
/// simulation and robotic hardware", IROS 2015, eq. 4-6; A. Crespi, A. J. Ijspeert, "AmphiBot II:
/// an amphibious snake robot that crawls and swims using a central pattern generator", CLAWAR 2006,
/// whose equations these are. Derivations and differences: docs/theory/gaits.md.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// What one oscillator tends to. It may change at any time: phase and amplitude stay smooth.
template <class Real>
struct CpgLaw {
  Real frequency_hz;       ///< v: of the oscillator left to itself.
  Real amplitude_m_per_s;  ///< R >= 0.
  Real convergence_per_s;  ///< a > 0.
};

/// The pull of oscillator `from` on oscillator `to`. Made by `MakeCoupling`.
template <class Real>
struct CpgCoupling {
  uint16_t to, from;
  Real along, across;  ///< w / (2 pi) times cosine and sine of phi [turns/m].
};

/// w in rad/s per m/s of the neighbour's amplitude; phi in turns, -1/2..1/2: the coupling pulls
/// theta_from - theta_to towards it.
template <class Real>
constexpr CpgCoupling<Real> MakeCoupling(uint16_t to, uint16_t from, Real weight_per_m,
                                         Real phase_turns) noexcept {
  const Real weight = weight_per_m * control::FromScalar<Real>(kTurnsPerRad);
  return CpgCoupling<Real>{to, from, weight * CosTurns(phase_turns),
                           weight * SinTurns(phase_turns)};
}

/// One oscillator's state.
template <class Real>
struct CpgState {
  Real phase_turns;              ///< theta, -1/2..1/2.
  Real amplitude_m_per_s;        ///< r.
  Real amplitude_rate_m_per_s2;  ///< dr/dt.
};

template <class Real>
constexpr CpgState<Real> StartCpg() noexcept {
  return CpgState<Real>{Literal<Real>(0.0f), Literal<Real>(0.0f), Literal<Real>(0.0f)};
}

/// V = r cos theta [m/s] (paper eq. 6, docs/theory/gaits.md eq. G.5).
template <class Real>
constexpr Real CpgVelocity(const CpgState<Real>& state) noexcept {
  return state.amplitude_m_per_s * CosTurns(state.phase_turns);
}

/// What a step needs and forgets, one an oscillator.
template <class Real>
struct CpgWork {
  CpgState<Real> stage, sum;
  // Of the phase; the same times the amplitude, as neighbours see it; S and C of eq. G.6, in turns.
  // Were S and C side by side, g++ 12 would sum them twice: as a pair and one by one.
  Real sine, scaled_sine, pull_sine;
  Real cosine, scaled_cosine, pull_cosine;
};

/// A network: `count` oscillators, and couplings in any order (the order of the sums).
template <class Real>
struct CpgNetwork {
  const CpgLaw<Real>* laws;  ///< Per oscillator.
  size_t count;
  const CpgCoupling<Real>* couplings;
  size_t coupling_count;
};

namespace internal {

/// What an oscillator shows its neighbours: one sine and one cosine for each oscillator, and none
/// for a coupling, for the sine of a difference is taken apart (G.6).
template <class Real, class Work>
constexpr void SetWave(Real turns, Real amplitude, Work& w) noexcept {
  w.sine = SinTurns(turns);
  w.cosine = CosTurns(turns);
  w.scaled_sine = amplitude * w.sine;
  w.scaled_cosine = amplitude * w.cosine;
}

/// Adds to S and C (G.6). Couplings that pull at one oscillator are cheapest one after the other:
/// their sums stay in registers.
template <class Real, class Work>
constexpr void AddPulls(const CpgCoupling<Real>* link, size_t coupling_count, Work* work) noexcept {
  const CpgCoupling<Real>* const end = link + coupling_count;
  while (link != end) {
    Work& to = work[link->to];
    const uint16_t target = link->to;
    Real sine = to.pull_sine, cosine = to.pull_cosine;
    do {
      const Work& from = work[link->from];
      sine = sine + (link->along * from.scaled_sine - link->across * from.scaled_cosine);
      cosine = cosine + (link->along * from.scaled_cosine + link->across * from.scaled_sine);
      ++link;
    } while (link != end && link->to == target);
    to.pull_sine = sine;
    to.pull_cosine = cosine;
  }
}

/// sum_j w_ij r_j sin(theta_j - theta_i - phi_ij) in turns, from the sums.
template <class Real, class Work>
constexpr Real PullOf(const Work& w) noexcept {
  return w.pull_sine * w.cosine - w.pull_cosine * w.sine;
}

template <class Real>
constexpr void CpgWaves(const CpgNetwork<Real>& network, CpgWork<Real>* work) noexcept {
  for (size_t i = 0; i < network.count; ++i) {
    CpgWork<Real>& w = work[i];
    SetWave(WrapTurns(w.stage.phase_turns), w.stage.amplitude_m_per_s, w);
  }
}

template <class Real>
constexpr void CpgPulls(const CpgNetwork<Real>& network, const Real* feedback,
                        CpgWork<Real>* work) noexcept {
  for (size_t i = 0; i < network.count; ++i) {
    work[i].pull_sine =
        feedback ? feedback[i] * control::FromScalar<Real>(kTurnsPerRad) : Literal<Real>(0.0f);
    work[i].pull_cosine = Literal<Real>(0.0f);
  }
  AddPulls(network.couplings, network.coupling_count, work);
}

/// The rate of an oscillator's state:
///   theta_i' = 2 pi v_i + sum_j w_ij r_j sin(theta_j - theta_i - phi_ij) + s_i cos theta_i  (G.3)
///   r_i''    = a_i (a_i / 4 (R_i - r_i) - r_i')                                             (G.4)
template <class Real>
constexpr CpgState<Real> CpgRate(const CpgLaw<Real>& law, const CpgWork<Real>& w) noexcept {
  const Real a = law.convergence_per_s;
  return CpgState<Real>{
      law.frequency_hz + PullOf<Real>(w), w.stage.amplitude_rate_m_per_s2,
      a * (Literal<Real>(0.25f) * a * (law.amplitude_m_per_s - w.stage.amplitude_m_per_s) -
           w.stage.amplitude_rate_m_per_s2)};
}

template <class Real>
constexpr CpgState<Real> Advanced(const CpgState<Real>& state, const CpgState<Real>& rate,
                                  Real h) noexcept {
  return CpgState<Real>{state.phase_turns + h * rate.phase_turns,
                        state.amplitude_m_per_s + h * rate.amplitude_m_per_s,
                        state.amplitude_rate_m_per_s2 + h * rate.amplitude_rate_m_per_s2};
}

}  // namespace internal

/// Advances all oscillators by `step_count` steps of `step_s` with the classical Runge-Kutta method
/// of fourth order (eq. G.7); choose step_s so that step_s times the sum of an oscillator's |w| R
/// is well below 2.7, where the method's stability ends.
///
/// `feedback` [rad/s] is null or has one s_i an oscillator, held during the call: a sensor reading
/// times a gain. It slows or hastens an oscillator by s_i cos theta_i. `states` and `work` have
/// `network.count` entries.
template <class Real>
constexpr void StepCpg(const CpgNetwork<Real>& network, const Real* feedback, Real step_s,
                       uint16_t step_count, CpgState<Real>* states, CpgWork<Real>* work) noexcept {
  const Real h = step_s, half = Literal<Real>(0.5f) * h;
  const Real third = h / Literal<Real>(3.0f), sixth = h / Literal<Real>(6.0f);
  const Real to_next[] = {half, half, h, h}, weight[] = {sixth, third, third, sixth};
  for (uint16_t step = 0; step < step_count; ++step) {
    for (size_t i = 0; i < network.count; ++i) work[i].stage = work[i].sum = states[i];
    for (int stage = 0; stage < 4; ++stage) {
      internal::CpgWaves(network, work);
      internal::CpgPulls(network, feedback, work);
      for (size_t i = 0; i < network.count; ++i) {
        CpgWork<Real>& w = work[i];
        const CpgState<Real> rate = internal::CpgRate(network.laws[i], w);
        w.sum = internal::Advanced(w.sum, rate, weight[stage]);
        w.stage = internal::Advanced(states[i], rate, to_next[stage]);
      }
    }
    for (size_t i = 0; i < network.count; ++i) {
      states[i] = work[i].sum;
      states[i].phase_turns = WrapTurns(states[i].phase_turns);
    }
  }
}

}  // namespace control
}  // namespace taut
