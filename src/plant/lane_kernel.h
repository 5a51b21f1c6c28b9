/// SIMD kernels of controllers and measures. The kernels are compiled once per instruction set,
/// like the step (lane_*.cpp). In rows, cable (or driven cable) i of lane j is at [i * lanes + j].
#pragma once

#include <stddef.h>

#include "taut/cable_readings.h"
#include "taut/control/impedance_tick.h"

namespace taut::plant {

/// Cables driven by one controller.
struct ImpedanceRows {
  int count = 0;
  const int* cable = nullptr;  ///< Index of each driven cable.
  const double *tension_offset_n = nullptr, *length_offset_m = nullptr,
               *position_gain_n_per_m = nullptr, *velocity_gain_n_s_per_m = nullptr,
               *velocity_offset_m_per_s = nullptr;
  /// State between ticks.
  double *error_before = nullptr, *integral = nullptr, *length_before_m = nullptr;
};

/// Commands that a tick of impedance control reads and writes, per cable.
struct ImpedanceOut {
  const double* signal = nullptr;  ///< Added to the velocity offset; output of a gait.
  double *velocity_input_m_per_s = nullptr, *rest_length_m = nullptr, *set_point_n = nullptr;
};

/// Measures accumulated during a run, one value per lane.
struct MeasureRows {
  double* rest_before_m = nullptr;  ///< Per cable: rest length after the previous step (updated).
  double* wound_j = nullptr;        ///< Work of winding in (accumulated).
  double* max_tension_n = nullptr;  ///< Largest tension of any cable.
  /// Time integral of the mean squared tension error (accumulated).
  double* error_n2_s = nullptr;
};

/// Parameters of sine waves, one wave per output.
struct SineRows {
  int count = 0;
  const double *frequency_hz = nullptr, *amplitude_m_per_s = nullptr, *phase_turns = nullptr,
               *offset_m_per_s = nullptr;
};

/// Parameters of a network of oscillators, one oscillator per output. `cpg_start` converts them for
/// `cpg_tick`.
struct CpgRows {
  int count = 0, coupling_count = 0;
  const double *frequency_hz = nullptr, *amplitude_m_per_s = nullptr,
               *convergence_per_s = nullptr;  ///< Per oscillator.
  /// Per coupling; the same in all lanes.
  const unsigned short *to = nullptr, *from = nullptr;
  const double *weight_per_m = nullptr, *phase_turns = nullptr;  ///< Per coupling.
};

/// Weights of a feed-forward network: one row per weight, in the order of
/// `control::EvaluateNetwork`.
struct NetworkRows {
  int inputs = 0, hidden = 0, outputs = 0;
  const double* weights = nullptr;
};
/// Maximum number of hidden neurons of a network.
constexpr int kMostHidden = 32;

/// Parameters of oscillators with feedback, one oscillator per output.
struct FeedbackCpgRows {
  int count = 0, coupling_count = 0;
  const double *frequency_hz = nullptr, *phase_at_start_turns = nullptr, *amplitude = nullptr,
               *convergence_per_s = nullptr, *frequency_gain_hz_per_s = nullptr,
               *amplitude_gain = nullptr,
               *phase_gain_turns_per_s = nullptr;  ///< Per oscillator.
  /// Per coupling; the same in all lanes.
  const unsigned short *to = nullptr, *from = nullptr;
  const double *weight_per_m = nullptr, *coupling_turns = nullptr;  ///< Per coupling.
};

/// Bodies of a group, with the row layout of the step (src/sim/data/state_rows.h).
struct BodyRows {
  int count = 0;
  /// Rows per body: 3, 4 (rotation of the principal frame to W), 3, 3 (angular momentum in W), 3.
  const double *position_m = nullptr, *turn = nullptr, *velocity_m_per_s = nullptr, *spin = nullptr,
               *inverse_inertia = nullptr;
  /// Described value of `turn`: four numbers per body, the same in all lanes.
  const double* start_turn = nullptr;
};

struct LaneKernel {
  int lanes;
  /// Computes a tick of impedance control.
  void (*impedance)(const control::ImpedanceLaw&, const ImpedanceRows&, const ReadingRows&,
                    const ImpedanceOut&);
  /// Accumulates measures after a step of length `step_s[lane]`. `motor[c]`: 1 if cable c has a
  /// motor, otherwise 0. `driven`: cables with set points.
  void (*measure)(const ReadingRows&, int cables, const double* motor, const double* set_point_n,
                  const int* driven, int driven_count, const double* step_s, const MeasureRows&);
  void (*sine)(const SineRows&, const double* time_s, double* velocity_m_per_s);
  /// Returns the size of the memory for a network of oscillators [bytes], to be aligned to 64.
  size_t (*cpg_bytes)(int count, int coupling_count);
  void (*cpg_start)(const CpgRows&, void* memory);
  /// Returns the state of the oscillators, three rows each.
  double* (*cpg_states)(int count, int coupling_count, void* memory);
  /// Integrates `steps` steps of length `step_s`. Then writes the velocities times `sign` (per
  /// oscillator, the same in all lanes). `feedback` [rad/s]: may be null.
  void (*cpg_tick)(int count, int coupling_count, void* memory, const double* feedback,
                   double step_s, int steps, const double* sign, double* velocity_m_per_s);
  /// Evaluates a feed-forward network, with one row per input and output.
  void (*network)(const NetworkRows&, const double* inputs, double* outputs);
  /// Like the functions `cpg_...`. `feedback`: three rows per oscillator, for frequency, amplitude
  /// and phase.
  size_t (*feedback_cpg_bytes)(int count, int coupling_count);
  void (*feedback_cpg_start)(const FeedbackCpgRows&, void* memory);
  double* (*feedback_cpg_states)(int count, int coupling_count, void* memory);
  void (*feedback_cpg_tick)(int count, int coupling_count, void* memory, const double* feedback,
                            double step_s, int steps, const double* offset, double* signal);
  /// Writes 13 rows per body, in the order of `BodyChannels`.
  void (*bodies)(const BodyRows&, double* out);
  /// Copies rows into consecutive memory and replaces values that are not finite by 0. Returns
  /// whether all values are in the range of float.
  bool (*collect)(const double* const* rows, int count, double* to);
};

extern const LaneKernel kLanesScalar;
extern const LaneKernel kLanesNeon;
extern const LaneKernel kLanesSimd128;
extern const LaneKernel kLanesSse2;
extern const LaneKernel kLanesAvx2;
extern const LaneKernel kLanesAvx512;

/// Returns the kernels for batches with this number of lanes.
const LaneKernel& LaneKernelOf(int lanes);

}  // namespace taut::plant
