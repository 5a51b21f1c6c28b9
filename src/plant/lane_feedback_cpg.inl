/// SIMD kernels of neural networks and of central pattern generators (CPG) that these networks
/// modulate.
#pragma once

#include "plant/lane_kernel.h"
#include "plant/lane_rows.inl"
#include "taut/control/feedback_cpg.h"
#include "taut/control/network.h"

namespace taut::plant {

template <class W>
void SayNetwork(const NetworkRows& rows, const double* inputs, double* outputs) {
  W hidden[kMostHidden];
  control::EvaluateNetwork<W>(
      {rows.inputs, rows.hidden, rows.outputs}, [&rows](int n) { return Load<W>(rows.weights, n); },
      [inputs](int i) { return Load<W>(inputs, i); }, hidden,
      [outputs](int k, W y) { Store(outputs, k, y); });
}

/// Network of oscillators in memory owned by the caller.
template <class W>
struct LaneFeedbackCpg {
  control::FeedbackCpgLaw<W>* laws;
  control::CpgCoupling<W>* couplings;
  control::FeedbackCpgState<W>* states;
  control::FeedbackCpgWork<W>* work;
  control::CpgFeedback<W>* feedback;

  LaneFeedbackCpg(int count, int coupling_count, void* memory) noexcept {
    char* end = static_cast<char*>(memory);
    laws = Take<control::FeedbackCpgLaw<W>>(end, count);
    couplings = Take<control::CpgCoupling<W>>(end, coupling_count);
    states = Take<control::FeedbackCpgState<W>>(end, count);
    work = Take<control::FeedbackCpgWork<W>>(end, count);
    feedback = Take<control::CpgFeedback<W>>(end, count);
  }
};

template <class W>
size_t FeedbackCpgBytes(int count, int coupling_count) {
  return static_cast<size_t>(count) *
             (sizeof(control::FeedbackCpgLaw<W>) + sizeof(control::FeedbackCpgState<W>) +
              sizeof(control::FeedbackCpgWork<W>) + sizeof(control::CpgFeedback<W>)) +
         static_cast<size_t>(coupling_count) * sizeof(control::CpgCoupling<W>);
}

template <class W>
void StartFeedbackCpg(const FeedbackCpgRows& rows, void* memory) {
  const LaneFeedbackCpg<W> cpg(rows.count, rows.coupling_count, memory);
  for (int i = 0; i < rows.count; ++i) {
    cpg.laws[i] = {Load<W>(rows.amplitude, i), Load<W>(rows.convergence_per_s, i),
                   Load<W>(rows.frequency_gain_hz_per_s, i), Load<W>(rows.amplitude_gain, i),
                   Load<W>(rows.phase_gain_turns_per_s, i)};
    cpg.states[i] = control::StartFeedbackCpg(Load<W>(rows.phase_at_start_turns, i),
                                              Load<W>(rows.frequency_hz, i));
  }
  for (int k = 0; k < rows.coupling_count; ++k) {
    cpg.couplings[k] = control::MakeCoupling(
        rows.to[k], rows.from[k], Load<W>(rows.weight_per_m, k), Load<W>(rows.coupling_turns, k));
  }
}

template <class W>
double* FeedbackCpgStates(int count, int coupling_count, void* memory) {
  static_assert(sizeof(control::FeedbackCpgState<W>) == 3 * sizeof(W));
  return reinterpret_cast<double*>(LaneFeedbackCpg<W>(count, coupling_count, memory).states);
}

template <class W>
void TickFeedbackCpg(int count, int coupling_count, void* memory, const double* feedback,
                     double step_s, int steps, const double* offset, double* signal) {
  const LaneFeedbackCpg<W> cpg(count, coupling_count, memory);
  for (int i = 0; i < count; ++i) {
    cpg.feedback[i] = {Load<W>(feedback, 3 * i), Load<W>(feedback, 3 * i + 1),
                       Load<W>(feedback, 3 * i + 2)};
  }
  const control::FeedbackCpgNetwork<W> network{cpg.laws, static_cast<size_t>(count), cpg.couplings,
                                               static_cast<size_t>(coupling_count)};
  for (int left = steps; left > 0;) {
    const int now = left < 60000 ? left : 60000;
    control::StepFeedbackCpg(network, cpg.feedback, W::Splat(step_s),
                             static_cast<unsigned short>(now), cpg.states, cpg.work);
    left -= now;
  }
  for (int i = 0; i < count; ++i) {
    Store(signal, i, Load<W>(offset, i) + control::FeedbackCpgSignal(cpg.laws[i], cpg.states[i]));
  }
}

}  // namespace taut::plant
