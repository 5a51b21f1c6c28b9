/// SIMD kernels of controllers and measures, one compilation per instruction set like the step
/// (lane_*.cpp). Rows contain cable (or driven cable) i of lane j at [i * lanes + j].
#pragma once

#include <stddef.h>

#include "taut/cable_readings.h"
#include "taut/control/impedance_tick.h"

namespace taut::plant {

/// Driven cables of one controller.
struct ImpedanceRows {
  int count = 0;
  const int* cable = nullptr;  ///< Index of each driven cable.
  const double *tension_offset_n = nullptr, *length_offset_m = nullptr,
               *position_gain_n_per_m = nullptr, *velocity_gain_n_s_per_m = nullptr,
               *velocity_offset_m_per_s = nullptr;
  double *error_before = nullptr, *integral = nullptr, *length_before_m = nullptr;  ///< Memory.
};

/// Commands of the plant that a tick of impedance control reads and writes, per cable.
struct ImpedanceOut {
  const double* signal = nullptr;  ///< Added to the velocity offset by a gait.
  double *velocity_input_m_per_s = nullptr, *rest_length_m = nullptr, *set_point_n = nullptr;
};

/// Measures accumulated during a run, one number per lane.
struct MeasureRows {
  double* rest_before_m = nullptr;  ///< Per cable: at the end of the previous step (updated).
  double* wound_j = nullptr;        ///< Work done by winding in (accumulated).
  double* max_tension_n = nullptr;  ///< Of any cable.
  double* error_n2_s = nullptr;     ///< Integral of the mean squared tension error (accumulated).
};

/// Sine waves, one per output.
struct SineRows {
  int count = 0;
  const double *frequency_hz = nullptr, *amplitude_m_per_s = nullptr, *phase_turns = nullptr,
               *offset_m_per_s = nullptr;
};

/// Parameters of a network of oscillators, one per output; `cpg_start` converts them to the form
/// that `cpg_tick` uses.
struct CpgRows {
  int count = 0, coupling_count = 0;
  const double *frequency_hz = nullptr, *amplitude_m_per_s = nullptr,
               *convergence_per_s = nullptr;                     ///< Per oscillator.
  const unsigned short *to = nullptr, *from = nullptr;           ///< Per coupling; all lanes.
  const double *weight_per_m = nullptr, *phase_turns = nullptr;  ///< Per coupling.
};

/// Feed-forward network: one row per weight, in the order of `control::EvaluateNetwork`.
struct NetworkRows {
  int inputs = 0, hidden = 0, outputs = 0;
  const double* weights = nullptr;
};
/// Maximum number of hidden neurons of a network.
constexpr int kMostHidden = 32;

/// Parameters of oscillators with feedback, one per output.
struct FeedbackCpgRows {
  int count = 0, coupling_count = 0;
  const double *frequency_hz = nullptr, *phase_at_start_turns = nullptr, *amplitude = nullptr,
               *convergence_per_s = nullptr, *frequency_gain_hz_per_s = nullptr,
               *amplitude_gain = nullptr,
               *phase_gain_turns_per_s = nullptr;                   ///< Per oscillator.
  const unsigned short *to = nullptr, *from = nullptr;              ///< Per coupling; all lanes.
  const double *weight_per_m = nullptr, *coupling_turns = nullptr;  ///< Per coupling.
};

/// Bodies of a group in the layout of the step (src/sim/data/state_rows.h).
struct BodyRows {
  int count = 0;
  /// Rows per body: 3, 4 (principal frame in W), 3, 3 (angular momentum in W), 3.
  const double *position_m = nullptr, *turn = nullptr, *velocity_m_per_s = nullptr, *spin = nullptr,
               *inverse_inertia = nullptr;
  const double* start_turn = nullptr;  ///< Four numbers per body: `turn` as described; all lanes.
};

struct LaneKernel {
  int lanes;
  /// Computes a tick of impedance control.
  void (*impedance)(const control::ImpedanceLaw&, const ImpedanceRows&, const ReadingRows&,
                    const ImpedanceOut&);
  /// Accumulates the measures after a step of `step_s[lane]`. `motor[c]`: 1 if the cable has a
  /// motor, else 0. `driven`: cables with set points.
  void (*measure)(const ReadingRows&, int cables, const double* motor, const double* set_point_n,
                  const int* driven, int driven_count, const double* step_s, const MeasureRows&);
  void (*sine)(const SineRows&, const double* time_s, double* velocity_m_per_s);
  /// Returns the memory for a network of oscillators [bytes], aligned to 64.
  size_t (*cpg_bytes)(int count, int coupling_count);
  void (*cpg_start)(const CpgRows&, void* memory);
  /// Returns the oscillators' states: three rows each.
  double* (*cpg_states)(int count, int coupling_count, void* memory);
  /// Integrates `steps` steps of `step_s`, then writes the velocities times `sign` (per oscillator,
  /// all lanes). `feedback` [rad/s] may be null.
  void (*cpg_tick)(int count, int coupling_count, void* memory, const double* feedback,
                   double step_s, int steps, const double* sign, double* velocity_m_per_s);
  /// Evaluates a feed-forward network; one row per input and output.
  void (*network)(const NetworkRows&, const double* inputs, double* outputs);
  /// As the functions `cpg_...`. `feedback`: three rows per oscillator, to frequency, amplitude and
  /// phase.
  size_t (*feedback_cpg_bytes)(int count, int coupling_count);
  void (*feedback_cpg_start)(const FeedbackCpgRows&, void* memory);
  double* (*feedback_cpg_states)(int count, int coupling_count, void* memory);
  void (*feedback_cpg_tick)(int count, int coupling_count, void* memory, const double* feedback,
                            double step_s, int steps, const double* offset, double* signal);
  /// Writes 13 rows per body, in the order of `BodyChannels`.
  void (*bodies)(const BodyRows&, double* out);
  /// Copies rows one after the other and replaces values that are not finite by 0. Returns whether
  /// all are within the range of float.
  bool (*collect)(const double* const* rows, int count, double* to);
};

extern const LaneKernel kLanesScalar;
extern const LaneKernel kLanesNeon;
extern const LaneKernel kLanesSimd128;
extern const LaneKernel kLanesSse2;
extern const LaneKernel kLanesAvx2;
extern const LaneKernel kLanesAvx512;

/// Returns the kernels for batches with this many lanes.
const LaneKernel& LaneKernelOf(int lanes);

}  // namespace taut::plant
