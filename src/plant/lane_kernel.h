/// The part of controllers and measures that runs over lanes: compiled once an instruction set, as
/// the step is (lane_*.cpp). Rows hold cable (or driven cable) i of lane j at [i * lanes + j].
#pragma once

#include <stddef.h>

#include "taut/cable_readings.h"
#include "taut/control/impedance_tick.h"

namespace taut::plant {

/// One controller's cables.
struct ImpedanceRows {
  int count = 0;
  const int* cable = nullptr;  ///< Per driven cable: its index.
  const double *tension_offset_n = nullptr, *length_offset_m = nullptr,
               *position_gain_n_per_m = nullptr, *velocity_gain_n_s_per_m = nullptr,
               *velocity_offset_m_per_s = nullptr;
  double *error_before = nullptr, *integral = nullptr, *length_before_m = nullptr;  ///< Memory.
};

/// What a tick of them reads and writes of the plant's commands, per cable.
struct ImpedanceOut {
  const double* signal = nullptr;  ///< What a gait adds to the velocity offset.
  double *velocity_input_m_per_s = nullptr, *rest_length_m = nullptr, *set_point_n = nullptr;
};

/// What is measured along the way, a number a lane.
struct MeasureRows {
  double* rest_before_m = nullptr;  ///< Per cable: at the end of the step before (becomes this).
  double* wound_j = nullptr;        ///< Work done by winding in (adds).
  double* max_tension_n = nullptr;  ///< Of any cable.
  double* error_n2_s = nullptr;     ///< Integral of the mean squared tension error (adds).
};

/// Sine waves: one an output.
struct SineRows {
  int count = 0;
  const double *frequency_hz = nullptr, *amplitude_m_per_s = nullptr, *phase_turns = nullptr,
               *offset_m_per_s = nullptr;
};

/// A network of oscillators, one an output, as numbers; `cpg_start` makes of it what `cpg_tick`
/// works on.
struct CpgRows {
  int count = 0, coupling_count = 0;
  const double *frequency_hz = nullptr, *amplitude_m_per_s = nullptr,
               *convergence_per_s = nullptr;                     ///< Per oscillator.
  const unsigned short *to = nullptr, *from = nullptr;           ///< Per coupling; all lanes.
  const double *weight_per_m = nullptr, *phase_turns = nullptr;  ///< Per coupling.
};

/// A feed-forward network: a row a weight, in the order of `control::EvaluateNetwork`.
struct NetworkRows {
  int inputs = 0, hidden = 0, outputs = 0;
  const double* weights = nullptr;
};
/// Hidden neurons that a network may have.
constexpr int kMostHidden = 32;

/// Oscillators with feedback, one an output, as numbers.
struct FeedbackCpgRows {
  int count = 0, coupling_count = 0;
  const double *frequency_hz = nullptr, *phase_at_start_turns = nullptr, *amplitude = nullptr,
               *convergence_per_s = nullptr, *frequency_gain_hz_per_s = nullptr,
               *amplitude_gain = nullptr,
               *phase_gain_turns_per_s = nullptr;                   ///< Per oscillator.
  const unsigned short *to = nullptr, *from = nullptr;              ///< Per coupling; all lanes.
  const double *weight_per_m = nullptr, *coupling_turns = nullptr;  ///< Per coupling.
};

/// Bodies of a group as the step has them (src/sim/data/state_rows.h).
struct BodyRows {
  int count = 0;
  /// Rows of a body: 3, 4 (principal frame in W), 3, 3 (angular momentum in W), 3.
  const double *position_m = nullptr, *turn = nullptr, *velocity_m_per_s = nullptr, *spin = nullptr,
               *inverse_inertia = nullptr;
  const double* start_turn = nullptr;  ///< Four numbers a body: `turn` as described; all lanes.
};

struct LaneKernel {
  int lanes;
  /// A tick of impedance control.
  void (*impedance)(const control::ImpedanceLaw&, const ImpedanceRows&, const ReadingRows&,
                    const ImpedanceOut&);
  /// After a step, of `step_s[lane]`. `motor[c]`: 1 if the cable has one. `driven`: cables with set
  /// points.
  void (*measure)(const ReadingRows&, int cables, const double* motor, const double* set_point_n,
                  const int* driven, int driven_count, const double* step_s, const MeasureRows&);
  void (*sine)(const SineRows&, const double* time_s, double* velocity_m_per_s);
  /// Memory for a network [bytes], aligned to 64.
  size_t (*cpg_bytes)(int count, int coupling_count);
  void (*cpg_start)(const CpgRows&, void* memory);
  /// Where the oscillators' states are: three rows each.
  double* (*cpg_states)(int count, int coupling_count, void* memory);
  /// `steps` of `step_s`, then the velocities times `sign` (per oscillator, all lanes). `feedback`
  /// (rad/s) may be null.
  void (*cpg_tick)(int count, int coupling_count, void* memory, const double* feedback,
                   double step_s, int steps, const double* sign, double* velocity_m_per_s);
  /// What a network says to some inputs, a row each.
  void (*network)(const NetworkRows&, const double* inputs, double* outputs);
  /// As those of `cpg_...`. `feedback`: three rows an oscillator, to frequency, amplitude and
  /// phase.
  size_t (*feedback_cpg_bytes)(int count, int coupling_count);
  void (*feedback_cpg_start)(const FeedbackCpgRows&, void* memory);
  double* (*feedback_cpg_states)(int count, int coupling_count, void* memory);
  void (*feedback_cpg_tick)(int count, int coupling_count, void* memory, const double* feedback,
                            double step_s, int steps, const double* offset, double* signal);
  /// Thirteen rows a body, in the order of `BodyChannels`.
  void (*bodies)(const BodyRows&, double* out);
  /// Puts rows one behind the other; what is not finite becomes 0. Whether all is within what a
  /// float can be.
  bool (*collect)(const double* const* rows, int count, double* to);
};

extern const LaneKernel kLanesScalar;
extern const LaneKernel kLanesNeon;
extern const LaneKernel kLanesSimd128;
extern const LaneKernel kLanesSse2;
extern const LaneKernel kLanesAvx2;
extern const LaneKernel kLanesAvx512;

/// The one for batches with this many lanes.
const LaneKernel& LaneKernelOf(int lanes);

}  // namespace taut::plant
