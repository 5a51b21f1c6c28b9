/// Robot and experiment specifications: contents of model and experiment files, readers and
/// writers. Readers neither throw nor print: all problems of a file are reported in `Diagnostics`.
///
/// Threads: any number may call these functions at once, each with separate diagnostics. A spec is
/// plain data.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/environment.h"
#include "taut/gait.h"
#include "taut/model_def.h"
#include "taut/variation.h"

namespace taut {

/// Returns whether a text is a valid user-defined name: letters, digits, `_` and `-`. Names become
/// parts of channel names, file names and pages.
bool IsName(std::string_view text);

/// Parameter overrides, as from `--set name=value`: values that replace parameters of a file. A
/// value may be an expression such as `2 * edge_m`.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Tags of a part of the model, which selectors of controllers and events match.
using Tags = std::vector<std::string>;

/// Mass of a rod, sphere or box, as given by its builder.
struct SolidMass {
  enum class Per { kWhole, kVolume, kLength };  ///< [kg], [kg/m^3], [kg/m]
  Per per = Per::kWhole;
  double value = 0.0;
};

/// Parts of which rigid bodies consist. `ModelDef` contains only the resulting mass properties of
/// the whole body.
struct SolidsSpec {
  struct PointMass {
    int node = 0;
    double mass_kg = 0.0, radius_m = 0.0;
    std::optional<Inertia> inertia_kg_m2 = {};  ///< About the node, in axes of W.
  };
  std::vector<SolidMass> spheres, capsules, boxes;  ///< Per shape of `def`.
  std::vector<PointMass> point_masses;
  bool bounding_box_inertia = false;  ///< `inertia: bounding_box`.
};

/// Resolved model file: numbers in `def`, and data that only files contain (tags, source
/// positions).
struct RobotSpec {
  ModelDef def;
  std::vector<Tags> cable_tags;  ///< Per cable of `def`; includes the cable's name.
  std::vector<Tags> node_tags;   ///< Per node of `def`; includes the node's name.
  std::vector<Tags> joint_tags;  ///< Per joint of `def`: tags of its pair or node, including names.
  std::vector<SourceRef> cable_sources;                       ///< Per cable: source of its pair.
  std::vector<SourceRef> body_sources;                        ///< Per body.
  std::vector<SourceRef> node_sources;                        ///< Per node.
  std::vector<SourceRef> plane_sources, terrain_box_sources;  ///< Per part of the terrain.
  std::vector<SourceRef> height_field_sources, mesh_sources;  ///< Likewise.
  std::optional<SolidsSpec> solids;                           ///< Unknown in a resolved experiment.
  std::map<std::string, double> parameters;                   ///< Resolved, with overrides.
  std::vector<std::string> files;  ///< Every file that was read, the model first.
};

/// Reads a model file. Returns nothing, with diagnostics, if there was any error.
std::optional<RobotSpec> LoadRobot(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out);

/// Returns the kind that a file declares: "model", "experiment" or "gait". Returns nothing, with an
/// error, for other contents.
std::optional<std::string> FileKind(const std::string& path, Diagnostics& out);

/// Kind, name and description that a file declares; the rest of the file may be invalid.
struct FileHead {
  std::string kind, name, description;  ///< Empty if missing.
};

/// Reads the head of a file of any kind. Returns nothing, with an error, if it is not valid YAML.
std::optional<FileHead> ReadFileHead(const std::string& path, Diagnostics& out);

/// Clock of a controller: runs at phase_s, phase_s + period_s, ... [s], independent of the step.
struct ClockSpec {
  double period_s = 0.001;
  double phase_s = 0.0;
};

/// Gains of one cable under impedance control (paper eq. 3); lengthening is positive.
struct ImpedanceGains {
  int cable = 0;
  double tension_offset_n = 0.0;         ///< T0 >= 0.
  double length_offset_m = 0.0;          ///< L0 >= 0.
  double position_gain_n_per_m = 0.0;    ///< K >= 0.
  double velocity_gain_n_s_per_m = 0.0;  ///< B >= 0.
  double velocity_offset_m_per_s = 0.0;  ///< V0.
};

/// Conversion of a tension set point to a rest length command.
enum class TensionConversion {
  kStiffness,  ///< L = L_now - (T_set - T_now) / k: NTRT's tgTensionController.
  kPid,  ///< A PID controller of the tension commands the rate of the rest length: the paper's
         ///< boards.
};

struct PidGains {
  double proportional_m_per_s_n = 0.0;  ///< Rate of winding in per newton of error.
  double integral_m_per_s2_n = 0.0;
  double derivative_m_per_n = 0.0;
};

struct ImpedanceSpec {
  TensionConversion conversion = TensionConversion::kStiffness;
  PidGains pid;
  /// False: dl/dt is exact. True: difference of the lengths of successive ticks, as on a board or
  /// in NTRT. For the first tick, the previous length is the rest length, as in NTRT, if
  /// `start_from_rest_length`.
  bool differenced_rate = false;
  bool start_from_rest_length = false;
  std::vector<ImpedanceGains> cables;
};

/// Rest length against time, piecewise linear, constant before the first and after the last point.
/// One point is a constant command, two are a ramp.
struct PositionProgram {
  int cable = 0;
  /// (time_s, rest_length_m), times increase.
  std::vector<std::pair<double, double>> rest_length_m;
};

/// Change to another gait at a given time.
struct GaitChange {
  double at_s = 0.0;
  int gait = 0;  ///< 0: `gait`; i: `others[i - 1]`.
};

/// Gait as input of a controller, with a separate clock: its output is held from tick to tick.
struct GaitInputSpec {
  ClockSpec clock{0.01, 0.0};
  GaitSpec gait;                    ///< Initial gait.
  std::vector<GaitSpec> others;     ///< Further gaits, for the same cables and the same quantity.
  std::vector<GaitChange> changes;  ///< Times increase.
  /// Blending time of changes between gaits whose oscillators do not correspond: the previous
  /// gait's weight decreases smoothly from 1 to 0 in this time.
  double blend_s = 0.5;
};

/// Returns a gait of an input by its number, as in `GaitChange::gait`.
inline const GaitSpec& GaitOf(const GaitInputSpec& input, std::size_t number) {
  return number == 0 ? input.gait : input.others[number - 1];
}

/// Controller: impedance control or position control of cables, with an optional gait.
struct ControllerSpec {
  std::string name;
  ClockSpec clock;
  std::optional<ImpedanceSpec> impedance;  ///< Excludes `position` and `rest_length_input`.
  std::vector<PositionProgram> position;
  /// With `impedance` only: added to each cable's velocity offset V0.
  std::optional<GaitInputSpec> velocity_input;
  /// Added to the cables' programs, or to the initial rest length of cables without a program.
  std::optional<GaitInputSpec> rest_length_input;
};

/// Returns the only gait input of a controller, or null.
inline GaitInputSpec* GaitInputOf(ControllerSpec& controller) noexcept {
  if (controller.velocity_input) return &*controller.velocity_input;
  return controller.rest_length_input ? &*controller.rest_length_input : nullptr;
}
inline const GaitInputSpec* GaitInputOf(const ControllerSpec& controller) noexcept {
  if (controller.velocity_input) return &*controller.velocity_input;
  return controller.rest_length_input ? &*controller.rest_length_input : nullptr;
}

/// Push: force on a node against time, piecewise linear, zero before the first and after the last
/// point.
struct PushSpec {
  std::string name;
  int node = 0;
  Vec3 direction{1.0, 0.0, 0.0};                   ///< Unit vector in W.
  double scale = 1.0;                              ///< Factor on force_n.
  std::vector<std::pair<double, double>> force_n;  ///< (time_s, force_n), times increase.
};

/// Drag: a spring and damper, like a hand-held scale, pulls a node toward a point that starts at
/// the node's position at `from_s` and moves at constant velocity.
struct DragSpec {
  std::string name;
  int node = 0;
  Vec3 velocity_m_per_s;  ///< Of the moving point, in W.
  double stiffness_n_per_m = 0.0;
  double damping_n_s_per_m = 0.0;
  double from_s = 0.0, to_s = 0.0;
};

/// Named time span, for the summary table.
struct PhaseSpec {
  std::string name;
  double from_s = 0.0, to_s = 0.0;
};

enum class StartKind {
  kAsDescribed,
  kSettled,          ///< Static equilibrium under gravity and contact, rest lengths fixed.
  kSettledFloating,  ///< Static equilibrium under cable forces only: no gravity, no ground.
};

/// Frame of the sensed direction to the goal.
enum class GoalFrame {
  kOfBody,   ///< x along `GoalSpec::ahead`, y to its left: a camera that sees a beacon.
  kOfWorld,  ///< x and y of W: with a compass, as in NTRT.
};

/// Goal of a robot, and the sensor of its direction.
struct GoalSpec {
  Vec3 at_m;                  ///< In W; its height is ignored.
  int body = 0;               ///< Watched body: its center of mass shall approach the goal.
  Vec3 ahead{1.0, 0.0, 0.0};  ///< Its forward direction in the initial pose, unit vector in W.
  GoalFrame frame = GoalFrame::kOfBody;
  double period_s = 0.01;  ///< Between two readings.
};

/// Digitization of a load cell on a board: integer counts from 0, clipped where the amplifier or
/// the converter saturates; force = gain count + offset. The defaults are Tetraspine3's (paper eq.
/// 7).
struct LoadCellCounts {
  double gain_n_per_count = 0.1567;  ///< > 0.
  double offset_n = -4.9363;         ///< Force at count 0.
  int bits = 10;                     ///< Of the converter, 1..32.
  int saturation_count = 741;        ///< Largest count of the amplifier, >= 1.
  double noise_counts = 0.0;         ///< Standard deviation of each sample before quantization.
};

/// Load cell: T' = (1 + gain) T + bias + drift t + noise, limited to a range, quantized in steps or
/// counts, and delayed.
struct LoadCellSpec {
  double noise_n = 0.0;  ///< Standard deviation of each sample, white.
  double bias_n = 0.0;   ///< Standard deviation of each cell's error, constant during a run.
  double min_n = 0.0;    ///< Of the range.
  double max_n = std::numeric_limits<double>::infinity();
  double quantum_n = 0.0;  ///< Step of the converter, from min_n on; 0: none.
  double delay_s = 0.0;    ///< Whole sensor periods.
  // Standard deviations over the cells, drawn once per run: errors of a calibration.
  double gain_error = 0.0;                              ///< Of the gain, relative [1].
  double drift_n_per_s = 0.0;                           ///< Of the drift rate of the zero.
  std::optional<LoadCellCounts> counts = std::nullopt;  ///< Replaces range and quantum.
};

/// Encoder of a motor: rest length in counts.
struct EncoderSpec {
  double quantum_m = 0.0;  ///< Rest length per count; 0: exact.
  double delay_s = 0.0;    ///< Whole sensor periods.
  // Standard deviations over the cables, drawn once per run.
  double zero_error_m = 0.0;  ///< Of the initial rest length.
  double gain_error = 0.0;    ///< Of the rest length per count, relative [1].
  /// Distance between index marks; the first mark corrects the zero error up to a multiple of this.
  /// 0: none.
  double index_m = 0.0;
};

/// Sensors between the robot and its controllers. Without them, controllers get exact values.
struct SensorSpec {
  double period_s = 0.001;  ///< Between samples; the first is at t = 0.
  std::optional<LoadCellSpec> load_cell;
  std::optional<EncoderSpec> encoder;
  /// True: a cable's length is estimated from rest length and tension, L + T / k, as on a board,
  /// and its rate from successive samples. False: both are exact.
  bool length_from_tension = false;
};

/// Load case: static loads, for `taut/analysis.h`.
struct LoadCaseSpec {
  struct NodeForce {
    int node = 0;
    Vec3 force_n;  ///< In W.
  };
  struct Settlement {
    int joint = 0;  ///< A support, whose point in the world moves.
    Vec3 by_m;      ///< In W.
  };
  struct Lengthening {
    int index = 0;  ///< Of a cable or, in `bars`, of a joint that is a bar.
    double by_m = 0.0;
  };
  std::string name;
  bool weight = true;  ///< Whether gravity acts.
  std::vector<NodeForce> forces;
  std::vector<Settlement> settlements;
  /// Increase of rest lengths, including thermal expansion.
  std::vector<Lengthening> cables, bars;
};

struct RecordSpec {
  double rate_hz = 100.0;  ///< Rows per second; 0: every step.
  /// Name patterns with `*`; empty: all that are not recorded on request only.
  std::vector<std::string> channels;
  std::vector<SourceRef> channel_sources;  ///< Source of each pattern; may be empty.
  int contacts = 0;                        ///< Contact slots per row.
};

/// Reference values, such as of a robot or another simulator, for comparison in the summary.
struct ReferenceSpec {
  enum class Quantity {
    kTension,  ///< Spring and damper, as measured by a load cell.
    kElastic,  ///< k (l - L) only.
  };
  enum class Statistic { kMax, kMean, kMin };
  struct Value {
    int cable = 0;
    double force_n = 0;
  };
  std::string source;  ///< Source of the values.
  Quantity quantity = Quantity::kTension;
  Statistic statistic = Statistic::kMax;
  std::string phase;  ///< Of the timeline; empty: the whole run, with kMax only.
  std::vector<Value> values;
};

/// Resolved experiment file.
struct ExperimentSpec {
  std::string name;
  std::string description;
  RobotSpec robot;  ///< Including the experiment's terrain and overrides in `robot.def`.
  double step_s = 0.001;
  double duration_s = 0.0;
  StartKind start = StartKind::kAsDescribed;
  std::uint64_t seed = 0;
  std::vector<ScaleSpec> scales;
  StartNoise start_noise;
  std::optional<GoalSpec> goal;
  std::optional<SensorSpec> sensors;
  std::vector<ControllerSpec> controllers;
  std::vector<PushSpec> pushes;
  std::vector<DragSpec> drags;
  std::vector<PhaseSpec> phases;
  RecordSpec record;
  std::vector<LoadCaseSpec> load_cases;
  std::optional<std::string> compare_with;  ///< Trace for comparison with the result.
  std::vector<ReferenceSpec> references;
  /// For reinforcement learning (taut/env.h); ignored by runs.
  std::optional<EnvironmentSpec> environment;
  std::map<std::string, double> parameters;  ///< Of the experiment, resolved.
  std::vector<std::string> files;            ///< Every file that was read, the experiment first.
  std::uint64_t input_hash = 0;  ///< FNV-1a of the bytes of `files` and of the overrides.
};

/// Variant of an experiment: numbers of its controllers (except clocks and driven cables), factors
/// on the model, start and seed.
struct RolloutWorld {
  std::vector<ControllerSpec> controllers;
  std::vector<ScaleSpec> scales;
  StartNoise start_noise;
  std::uint64_t seed = 0;
  /// For custom controllers (taut/plant.h), which define their meaning.
  std::vector<double> numbers;
};

/// Returns the parts of an experiment that act on its model in a run ("controllers, pushes"), for
/// `ModelDef::experiment_parts`. `LoadExperiment` sets `experiment_parts`; set it again if you
/// change such a part and then compile the model for a `WorldBatch`.
std::string ActingParts(const ExperimentSpec& experiment);

/// Returns the variant that equals the experiment.
RolloutWorld WorldOf(const ExperimentSpec& experiment);
/// Returns the experiment that runs only this variant.
ExperimentSpec ExperimentOf(const ExperimentSpec& base, const RolloutWorld& world);

/// Reads an experiment file and its model, or the text from `ResolvedYaml`. Returns nothing, with
/// diagnostics, if there was any error.
std::optional<ExperimentSpec> LoadExperiment(const std::string& path, const Overrides& overrides,
                                             Diagnostics& out);

/// Serializes an experiment and its robot in numbers, without parameters, models or bases, as one
/// YAML text. `LoadExperiment` restores bit-identical values, so the text reproduces the run
/// without other files.
std::string ResolvedYaml(const ExperimentSpec& experiment);

/// Writes a robot as a model file in numbers, for further editing: nodes at the positions in
/// `robot.def`, pairs, builders. Velocities and terrain are omitted. `LoadRobot` restores the same
/// robot up to rounding. Returns nothing, with an error, if a model file cannot represent the
/// robot. `heading`: comment at the top, one or more lines.
std::optional<std::string> ModelYaml(const RobotSpec& robot, const std::string& heading,
                                     Diagnostics& out);

}  // namespace taut
