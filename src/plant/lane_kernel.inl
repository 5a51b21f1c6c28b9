/// Included once an instruction set, by lane_*.cpp, with the width of its registers. As in the
/// step, nothing here uses the standard library, and every function is a template of W.

#include "plant/lane_kernel.h"
#include "plant/reading_rows.h"
#include "simd/wide.h"

namespace taut::plant {

template <class W>
TAUT_INLINE W Load(const double* row, int i) noexcept {
  W x;
  __builtin_memcpy(&x, row + i * W::kLanes, sizeof(double) * W::kLanes);
  return x;
}
template <class W>
TAUT_INLINE void Store(double* row, int i, W x) noexcept {
  __builtin_memcpy(row + i * W::kLanes, &x, sizeof(double) * W::kLanes);
}

/// What does not differ between cables is known to the compiler: `by_pid`, `differenced`.
template <class W, bool kByPid, bool kDifferenced>
void ActCables(ImpedanceLaw law, const ImpedanceRows rows, const ReadingRows sensed,
               double* target_m, double* set_point_n) noexcept {
  law.by_pid = kByPid;
  law.differenced_rate = kDifferenced;
  for (int i = 0; i < rows.count; ++i) {
    const int c = rows.cable[i];
    const control::Impedance<W> gains{
        Load<W>(rows.tension_offset_n, i), Load<W>(rows.length_offset_m, i),
        Load<W>(rows.position_gain_n_per_m, i), Load<W>(rows.velocity_gain_n_s_per_m, i)};
    const CableSenses<W> s{Load<W>(sensed.rest_length_m, c), Load<W>(sensed.length_m, c),
                           Load<W>(sensed.rate_m_per_s, c),  Load<W>(sensed.tension_n, c),
                           Load<W>(sensed.elastic_n, c),     Load<W>(sensed.stiffness_n_per_m, c)};
    ImpedanceMemory<W> memory;
    if (kByPid) memory.pid = {Load<W>(rows.error_before, i), Load<W>(rows.integral, i)};
    if (kDifferenced) memory.difference = {Load<W>(rows.length_before_m, i)};
    const ImpedanceCommand<W> command =
        StepImpedance(law, gains, Load<W>(rows.velocity_offset_m_per_s, i), s, memory);
    if (kByPid) {
      Store(rows.error_before, i, memory.pid.error_before);
      Store(rows.integral, i, memory.pid.integral);
    }
    if (kDifferenced) Store(rows.length_before_m, i, memory.difference.length_before_m);
    Store(target_m, c, command.target_m);
    Store(set_point_n, c, command.set_point_n);
  }
}

template <class W>
void ActImpedance(const ImpedanceLaw& law, const ImpedanceRows& rows, const ReadingRows& sensed,
                  double* target_m, double* set_point_n) {
  if (law.by_pid && law.differenced_rate) {
    ActCables<W, true, true>(law, rows, sensed, target_m, set_point_n);
  } else if (law.by_pid) {
    ActCables<W, true, false>(law, rows, sensed, target_m, set_point_n);
  } else if (law.differenced_rate) {
    ActCables<W, false, true>(law, rows, sensed, target_m, set_point_n);
  } else {
    ActCables<W, false, false>(law, rows, sensed, target_m, set_point_n);
  }
}

template <class W>
void Measure(const ReadingRows& now, int cables, const double* motor, const double* set_point_n,
             const int* driven, int driven_count, double step_s, const MeasureRows& out) {
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
  Store(
      out.error_n2_s, 0,
      Load<W>(out.error_n2_s, 0) + W::Splat(step_s / static_cast<double>(driven_count)) * squares);
}

template <class W>
constexpr LaneKernel MakeLaneKernel() {
  return {W::kLanes, ActImpedance<W>, Measure<W>};
}

}  // namespace taut::plant
