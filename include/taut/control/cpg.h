/// Central pattern generator (CPG): network of coupled phase oscillators with amplitude dynamics.
///
/// Sources: Mirletz, Park, Quinn, SunSpiral, "Towards bridging the reality gap between tensegrity
/// simulation and robotic hardware", IROS 2015, eq. 4-6; A. Crespi, A. J. Ijspeert, "AmphiBot II:
/// an amphibious snake robot that crawls and swims using a central pattern generator", CLAWAR 2006,
/// the origin of these equations. Derivations and differences: docs/theory/gaits.md.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// Law of one oscillator. Parameters may change at any time; phase and amplitude stay smooth.
template <class Real>
struct CpgLaw {
  Real frequency_hz;       ///< Frequency v of the uncoupled oscillator.
  Real amplitude_m_per_s;  ///< Target amplitude R >= 0.
  Real convergence_per_s;  ///< Rate a > 0 of convergence to R.
};

/// Coupling from oscillator `from` to oscillator `to`. Use `MakeCoupling` to create it.
template <class Real>
struct CpgCoupling {
  uint16_t to, from;
  Real along, across;  ///< w / (2 pi) times the cosine and sine of phi [turns/m].
};

/// Returns a coupling that pulls theta_from - theta_to toward phi. w: weight in rad/s per m/s of
/// amplitude of `from`; phi: phase in turns, -1/2..1/2.
template <class Real>
constexpr CpgCoupling<Real> MakeCoupling(uint16_t to, uint16_t from, Real weight_per_m,
                                         Real phase_turns) noexcept {
  const Real weight = weight_per_m * control::FromScalar<Real>(kTurnsPerRad);
  return CpgCoupling<Real>{to, from, weight * CosTurns(phase_turns),
                           weight * SinTurns(phase_turns)};
}

/// State of one oscillator.
template <class Real>
struct CpgState {
  Real phase_turns;              ///< Phase theta, -1/2..1/2.
  Real amplitude_m_per_s;        ///< Amplitude r.
  Real amplitude_rate_m_per_s2;  ///< Time derivative dr/dt.
};

/// Returns the initial state: all 0.
template <class Real>
constexpr CpgState<Real> StartCpg() noexcept {
  return CpgState<Real>{Literal<Real>(0.0f), Literal<Real>(0.0f), Literal<Real>(0.0f)};
}

/// Returns the output V = r cos theta [m/s] (paper eq. 6, docs/theory/gaits.md eq. G.5).
template <class Real>
constexpr Real CpgVelocity(const CpgState<Real>& state) noexcept {
  return state.amplitude_m_per_s * CosTurns(state.phase_turns);
}

/// Scratch memory of a step, one per oscillator.
template <class Real>
struct CpgWork {
  CpgState<Real> stage, sum;
  // Sine and cosine of the phase; both times the amplitude, as used by neighbors; S and C of eq.
  // G.6, in turns. Keep S and C apart: if they were adjacent, g++ 12 would sum them twice, as a
  // pair and individually.
  Real sine, scaled_sine, pull_sine;
  Real cosine, scaled_cosine, pull_cosine;
};

/// Network of `count` oscillators. The order of the couplings is the order of summation.
template <class Real>
struct CpgNetwork {
  const CpgLaw<Real>* laws;  ///< One per oscillator.
  size_t count;
  const CpgCoupling<Real>* couplings;
  size_t coupling_count;
};

namespace internal {

/// Computes sine and cosine of an oscillator's phase for its neighbors. Eq. G.6 expands the sine of
/// a phase difference, so each oscillator needs one sine and one cosine, and couplings need none.
template <class Real, class Work>
constexpr void SetWave(Real turns, Real amplitude, Work& w) noexcept {
  w.sine = SinTurns(turns);
  w.cosine = CosTurns(turns);
  w.scaled_sine = amplitude * w.sine;
  w.scaled_cosine = amplitude * w.cosine;
}

/// Adds the terms of the couplings to S and C (G.6). Consecutive couplings to the same oscillator
/// are fastest, since their sums stay in registers.
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

/// Returns sum_j w_ij r_j sin(theta_j - theta_i - phi_ij) [turns/s], computed from S and C.
template <class Real, class Work>
constexpr Real PullOf(const Work& w) noexcept {
  return w.pull_sine * w.cosine - w.pull_cosine * w.sine;
}

/// Computes sines and cosines of the phases of all oscillators.
template <class Real>
constexpr void CpgWaves(const CpgNetwork<Real>& network, CpgWork<Real>* work) noexcept {
  for (size_t i = 0; i < network.count; ++i) {
    CpgWork<Real>& w = work[i];
    SetWave(WrapTurns(w.stage.phase_turns), w.stage.amplitude_m_per_s, w);
  }
}

/// Computes S and C of all oscillators. `feedback` [rad/s]: see `StepCpg`.
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

/// Returns the time derivative of an oscillator's state:
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

/// Returns state + h * rate.
template <class Real>
constexpr CpgState<Real> Advanced(const CpgState<Real>& state, const CpgState<Real>& rate,
                                  Real h) noexcept {
  return CpgState<Real>{state.phase_turns + h * rate.phase_turns,
                        state.amplitude_m_per_s + h * rate.amplitude_m_per_s,
                        state.amplitude_rate_m_per_s2 + h * rate.amplitude_rate_m_per_s2};
}

}  // namespace internal

/// Advances all oscillators by `step_count` steps of `step_s` with the classical fourth-order
/// Runge-Kutta method (eq. G.7). Stable if step_s times the sum of |w| R over the couplings of each
/// oscillator is below 2.7. Choose a much smaller step.
///
/// `feedback` [rad/s]: null, or one s_i per oscillator, a sensor reading times a gain. The feedback
/// is constant during the call and adds s_i cos theta_i to the phase rate of an oscillator.
/// `states` and `work` have `network.count` entries.
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
