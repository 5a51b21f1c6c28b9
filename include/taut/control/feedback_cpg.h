/// Central pattern generator with sensor feedback to the frequency, amplitude and phase of its
/// oscillators.
///
/// Source: Mirletz, Bhandal, Adams, Agogino, Quinn, SunSpiral, "Goal-directed CPG-based control for
/// tensegrity spines with many degrees of freedom traversing irregular terrain", Soft Robotics
/// 2(4), 2015, and its source code (NTRTsim, src/util/CPGNodeFB.cpp). Difference: the amplitude is
/// relative to R, so the units of the gains do not depend on the unit of the gait's signal.
/// Equations: docs/theory/gaits.md.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/control/cpg.h"
#include "taut/control/real.h"
#include "taut/control/turns.h"

namespace taut {
namespace control {

/// Parameters of one oscillator and gains of its sensor feedback.
template <class Real>
struct FeedbackCpgLaw {
  Real amplitude;                ///< Amplitude R >= 0 without feedback [m/s] or [m].
  Real convergence_per_s;        ///< Rate a > 0 of convergence.
  Real frequency_gain_hz_per_s;  ///< Gain k_f of the frequency.
  Real amplitude_gain;           ///< Gain k_a of the amplitude.
  Real phase_gain_turns_per_s;   ///< Gain k_p of the phase.
};

/// Feedback from a neural network (network.h) to one oscillator; each value is -1..1.
template <class Real>
struct CpgFeedback {
  Real frequency, amplitude, phase;  ///< Outputs f_f, f_a, f_p of the network.
};

/// State of one oscillator.
template <class Real>
struct FeedbackCpgState {
  Real phase_turns;   ///< Phase theta, -1/2..1/2.
  Real relative;      ///< Relative amplitude rho = r / R; a value of 0 stays 0.
  Real frequency_hz;  ///< Frequency v.
};

/// Returns an initial state with the full amplitude; an amplitude of 0 could not grow.
template <class Real>
constexpr FeedbackCpgState<Real> StartFeedbackCpg(Real phase_turns, Real frequency_hz) noexcept {
  return FeedbackCpgState<Real>{phase_turns, Literal<Real>(1.0f), frequency_hz};
}

/// Returns the output R rho cos theta [m/s] or [m] (G.18).
template <class Real>
constexpr Real FeedbackCpgSignal(const FeedbackCpgLaw<Real>& law,
                                 const FeedbackCpgState<Real>& state) noexcept {
  return law.amplitude * state.relative * CosTurns(state.phase_turns);
}

/// Scratch memory of a step, one per oscillator.
template <class Real>
struct FeedbackCpgWork {
  FeedbackCpgState<Real> stage, sum;
  Real sine, scaled_sine, pull_sine;
  Real cosine, scaled_cosine, pull_cosine;
};

/// Network of `count` oscillators. The order of the couplings is the order of summation.
template <class Real>
struct FeedbackCpgNetwork {
  const FeedbackCpgLaw<Real>* laws;  ///< One per oscillator.
  size_t count;
  const CpgCoupling<Real>* couplings;
  size_t coupling_count;
};

namespace internal {

/// Returns the time derivative of an oscillator's state:
///   theta_i' = 2 pi v_i + k_p f_p + sum_j w_ij r_j sin(theta_j - theta_i - phi_ij)   (G.15)
///   v_i'     = k_f f_f sin theta_i                                                   (G.16)
///   rho_i'   = a (1 + k_a f_a - rho_i^2) rho_i                                       (G.17)
template <class Real>
constexpr FeedbackCpgState<Real> FeedbackCpgRate(const FeedbackCpgLaw<Real>& law,
                                                 const CpgFeedback<Real>& says,
                                                 const FeedbackCpgWork<Real>& w) noexcept {
  const Real rho = w.stage.relative;
  return FeedbackCpgState<Real>{
      w.stage.frequency_hz + law.phase_gain_turns_per_s * says.phase + PullOf<Real>(w),
      law.convergence_per_s *
          (Literal<Real>(1.0f) + law.amplitude_gain * says.amplitude - rho * rho) * rho,
      law.frequency_gain_hz_per_s * says.frequency * w.sine};
}

/// Returns state + h * rate.
template <class Real>
constexpr FeedbackCpgState<Real> Advanced(const FeedbackCpgState<Real>& state,
                                          const FeedbackCpgState<Real>& rate, Real h) noexcept {
  return FeedbackCpgState<Real>{state.phase_turns + h * rate.phase_turns,
                                state.relative + h * rate.relative,
                                state.frequency_hz + h * rate.frequency_hz};
}

}  // namespace internal

/// Advances all oscillators by `step_count` steps of `step_s` with the classical fourth-order
/// Runge-Kutta method (G.7). `feedback`: one per oscillator, constant during the call. `states` and
/// `work` have `network.count` entries.
template <class Real>
constexpr void StepFeedbackCpg(const FeedbackCpgNetwork<Real>& network,
                               const CpgFeedback<Real>* feedback, Real step_s, uint16_t step_count,
                               FeedbackCpgState<Real>* states,
                               FeedbackCpgWork<Real>* work) noexcept {
  const Real h = step_s, half = Literal<Real>(0.5f) * h;
  const Real third = h / Literal<Real>(3.0f), sixth = h / Literal<Real>(6.0f);
  const Real to_next[] = {half, half, h, h}, weight[] = {sixth, third, third, sixth};
  for (uint16_t step = 0; step < step_count; ++step) {
    for (size_t i = 0; i < network.count; ++i) work[i].stage = work[i].sum = states[i];
    for (int stage = 0; stage < 4; ++stage) {
      for (size_t i = 0; i < network.count; ++i) {
        FeedbackCpgWork<Real>& w = work[i];
        internal::SetWave(WrapTurns(w.stage.phase_turns),
                          network.laws[i].amplitude * w.stage.relative, w);
        w.pull_sine = w.pull_cosine = Literal<Real>(0.0f);
      }
      internal::AddPulls(network.couplings, network.coupling_count, work);
      for (size_t i = 0; i < network.count; ++i) {
        FeedbackCpgWork<Real>& w = work[i];
        const FeedbackCpgState<Real> rate =
            internal::FeedbackCpgRate(network.laws[i], feedback[i], w);
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
