/// Implementation of the lane kernels. lane_*.cpp include it once per instruction set, with the
/// register type W. As in the step, the code does not use the standard library, and all functions
/// are templates of W.
#pragma once

#include "plant/lane_feedback_cpg.inl"
#include "plant/lane_gather.inl"
#include "plant/lane_kernel.h"
#include "plant/lane_rows.inl"
#include "simd/wide.h"
#include "taut/control/cpg.h"
#include "taut/control/sine.h"

namespace taut::plant {

/// Options that are the same for all cables are template parameters: kByPid, kDifferenced.
template <class W, bool kByPid, bool kDifferenced>
void ActCables(control::ImpedanceLaw law, const ImpedanceRows rows, const ReadingRows sensed,
               const ImpedanceOut out) noexcept {
  law.by_pid = kByPid;
  law.differenced_rate = kDifferenced;
  for (int i = 0; i < rows.count; ++i) {
    const int c = rows.cable[i];
    const control::Impedance<W> gains{
        Load<W>(rows.tension_offset_n, i), Load<W>(rows.length_offset_m, i),
        Load<W>(rows.position_gain_n_per_m, i), Load<W>(rows.velocity_gain_n_s_per_m, i)};
    const auto s = MapReadings([c](const double* row) { return Load<W>(row, c); }, sensed);
    const W velocity_input = Load<W>(rows.velocity_offset_m_per_s, i) + Load<W>(out.signal, c);
    control::ImpedanceMemory<W> memory;
    if (kByPid) memory.pid = {Load<W>(rows.error_before, i), Load<W>(rows.integral, i)};
    if (kDifferenced) memory.difference = {Load<W>(rows.length_before_m, i)};
    const control::ImpedanceCommand<W> command =
        control::StepImpedance(law, gains, velocity_input, s, memory);
    if (kByPid) {
      Store(rows.error_before, i, memory.pid.error_before);
      Store(rows.integral, i, memory.pid.integral);
    }
    if (kDifferenced) Store(rows.length_before_m, i, memory.difference.length_before_m);
    Store(out.velocity_input_m_per_s, c, velocity_input);
    Store(out.rest_length_m, c, command.target_m);
    Store(out.set_point_n, c, command.set_point_n);
  }
}

template <class W>
void ActImpedance(const control::ImpedanceLaw& law, const ImpedanceRows& rows,
                  const ReadingRows& sensed, const ImpedanceOut& out) {
  if (law.by_pid && law.differenced_rate) {
    ActCables<W, true, true>(law, rows, sensed, out);
  } else if (law.by_pid) {
    ActCables<W, true, false>(law, rows, sensed, out);
  } else if (law.differenced_rate) {
    ActCables<W, false, true>(law, rows, sensed, out);
  } else {
    ActCables<W, false, false>(law, rows, sensed, out);
  }
}

template <class W>
void Measure(const ReadingRows& now, int cables, const double* motor, const double* set_point_n,
             const int* driven, int driven_count, const double* step_s, const MeasureRows& out) {
  const W zero = W::Splat(0.0);
  W work = zero, most = Load<W>(out.max_tension_n, 0);
  for (int c = 0; c < cables; ++c) {
    const W T = Load<W>(now.tension_n, c), rest = Load<W>(now.rest_length_m, c);
    work += W::Splat(motor[c]) * (T * Max(Load<W>(out.rest_before_m, c) - rest, zero));
    most = Max(most, T);
    Store(out.rest_before_m, c, rest);
  }
  Store(out.wound_j, 0, Load<W>(out.wound_j, 0) + work);
  Store(out.max_tension_n, 0, most);
  if (driven_count == 0) return;
  W squares = zero;
  for (int i = 0; i < driven_count; ++i) {
    const W error = Load<W>(now.tension_n, driven[i]) - Load<W>(set_point_n, driven[i]);
    squares += error * error;
  }
  const W share_s = Load<W>(step_s, 0) / W::Splat(static_cast<double>(driven_count));
  Store(out.error_n2_s, 0, Load<W>(out.error_n2_s, 0) + share_s * squares);
}

template <class W>
void TickSine(const SineRows& rows, const double* time_s, double* velocity_m_per_s) {
  const W t = Load<W>(time_s, 0);
  for (int i = 0; i < rows.count; ++i) {
    const control::Sine<W> wave{Load<W>(rows.amplitude_m_per_s, i), Load<W>(rows.phase_turns, i),
                                Load<W>(rows.offset_m_per_s, i)};
    const W turns = control::ClockTurns(Load<W>(rows.frequency_hz, i), t);
    Store(velocity_m_per_s, i, control::SineVelocity(wave, turns));
  }
}

/// Network of oscillators in memory owned by the caller.
template <class W>
struct LaneCpg {
  control::CpgLaw<W>* laws;
  control::CpgCoupling<W>* couplings;
  control::CpgState<W>* states;
  control::CpgWork<W>* work;
  W* feedback;

  LaneCpg(int count, int coupling_count, void* memory) noexcept {
    char* end = static_cast<char*>(memory);
    laws = Take<control::CpgLaw<W>>(end, count);
    couplings = Take<control::CpgCoupling<W>>(end, coupling_count);
    states = Take<control::CpgState<W>>(end, count);
    work = Take<control::CpgWork<W>>(end, count);
    feedback = Take<W>(end, count);
  }
};

template <class W>
size_t CpgBytes(int count, int coupling_count) {
  using control::CpgCoupling, control::CpgLaw, control::CpgState, control::CpgWork;
  return static_cast<size_t>(count) *
             (sizeof(CpgLaw<W>) + sizeof(CpgState<W>) + sizeof(CpgWork<W>) + sizeof(W)) +
         static_cast<size_t>(coupling_count) * sizeof(CpgCoupling<W>);
}

template <class W>
void StartCpg(const CpgRows& rows, void* memory) {
  const LaneCpg<W> cpg(rows.count, rows.coupling_count, memory);
  for (int i = 0; i < rows.count; ++i) {
    cpg.laws[i] = {Load<W>(rows.frequency_hz, i), Load<W>(rows.amplitude_m_per_s, i),
                   Load<W>(rows.convergence_per_s, i)};
    cpg.states[i] = control::StartCpg<W>();
  }
  for (int k = 0; k < rows.coupling_count; ++k) {
    cpg.couplings[k] = control::MakeCoupling(
        rows.to[k], rows.from[k], Load<W>(rows.weight_per_m, k), Load<W>(rows.phase_turns, k));
  }
}

template <class W>
double* CpgStates(int count, int coupling_count, void* memory) {
  static_assert(sizeof(control::CpgState<W>) == 3 * sizeof(W));
  return reinterpret_cast<double*>(LaneCpg<W>(count, coupling_count, memory).states);
}

template <class W>
void TickCpg(int count, int coupling_count, void* memory, const double* feedback, double step_s,
             int steps, const double* sign, double* velocity_m_per_s) {
  const LaneCpg<W> cpg(count, coupling_count, memory);
  const control::CpgNetwork<W> network{cpg.laws, static_cast<size_t>(count), cpg.couplings,
                                       static_cast<size_t>(coupling_count)};
  for (int i = 0; feedback != nullptr && i < count; ++i) cpg.feedback[i] = Load<W>(feedback, i);
  for (int left = steps; left > 0;) {
    const int now = left < 60000 ? left : 60000;
    control::StepCpg(network, feedback != nullptr ? cpg.feedback : nullptr, W::Splat(step_s),
                     static_cast<unsigned short>(now), cpg.states, cpg.work);
    left -= now;
  }
  for (int i = 0; i < count; ++i) {
    Store(velocity_m_per_s, i, W::Splat(sign[i]) * control::CpgVelocity(cpg.states[i]));
  }
}

template <class W>
constexpr LaneKernel MakeLaneKernel() {
  return {W::kLanes,          ActImpedance<W>,     Measure<W>,          TickSine<W>,
          CpgBytes<W>,        StartCpg<W>,         CpgStates<W>,        TickCpg<W>,
          SayNetwork<W>,      FeedbackCpgBytes<W>, StartFeedbackCpg<W>, FeedbackCpgStates<W>,
          TickFeedbackCpg<W>, SeeBodies<W>,        Collect<W>};
}

}  // namespace taut::plant
