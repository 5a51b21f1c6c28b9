/// Robot and experiment specifications: contents of model and experiment files, with readers and
/// writers. Functions neither throw nor print; `Diagnostics` contain all problems of a file.
///
/// Threads: any number may call these functions concurrently, each with separate diagnostics. A
/// spec is plain data.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "taut/boards.h"
#include "taut/diagnostics.h"
#include "taut/environment.h"
#include "taut/gait.h"
#include "taut/load_case.h"
#include "taut/model_def.h"
#include "taut/variation.h"

namespace taut {

/// Returns whether a text is a valid name: letters, digits, `_` and `-`. Names become parts of
/// channel names, file names and pages.
bool IsName(std::string_view text);

/// Parameter overrides, for example from `--set name=value`: new values for parameters of a file. A
/// value may be an expression, such as `2 * edge_m`.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Tags of a model element, matched by selectors of controllers and events.
using Tags = std::vector<std::string>;

/// Mass of a rod, sphere or box, as defined by its builder.
struct SolidMass {
  enum class Per { kWhole, kVolume, kLength };  ///< `value` in kg, kg/m^3, kg/m.
  Per per = Per::kWhole;
  double value = 0.0;
};

/// Solids that make up the rigid bodies. `ModelDef` contains only the mass properties of whole
/// bodies.
struct SolidsSpec {
  struct PointMass {
    int node = 0;
    double mass_kg = 0.0, radius_m = 0.0;
    std::optional<Inertia> inertia_kg_m2 = {};  ///< About the node, in axes parallel to W.
  };
  std::vector<SolidMass> spheres, capsules, boxes;  ///< One per shape of `def`.
  std::vector<PointMass> point_masses;
  bool bounding_box_inertia = false;  ///< `inertia: bounding_box`.
};

/// Resolved model file: all numbers in `def`, and data that only files contain (tags, source
/// positions).
struct RobotSpec {
  ModelDef def;
  std::vector<Tags> cable_tags;  ///< Per cable of `def`; includes its name.
  std::vector<Tags> node_tags;   ///< Per node of `def`; includes its name.
  std::vector<Tags> joint_tags;  ///< Per joint of `def`: tags of its pair or node, including names.
  std::vector<SourceRef> cable_sources;                       ///< Per cable: source of its pair.
  std::vector<SourceRef> body_sources;                        ///< Per body.
  std::vector<SourceRef> node_sources;                        ///< Per node.
  std::vector<SourceRef> plane_sources, terrain_box_sources;  ///< Per part of the terrain.
  std::vector<SourceRef> height_field_sources, mesh_sources;  ///< Per part of the terrain.
  std::optional<SolidsSpec> solids;                           ///< Absent in a resolved experiment.
  std::map<std::string, double> parameters;  ///< Resolved values, including overrides.
  std::vector<std::string> files;            ///< All files read; the model file is first.
};

/// Reads a model file. On an error, returns nothing and adds diagnostics.
std::optional<RobotSpec> LoadRobot(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out);

/// Returns the kind that a file declares: "model", "experiment" or "gait". For other contents,
/// returns nothing and adds an error.
std::optional<std::string> FileKind(const std::string& path, Diagnostics& out);

/// Declared kind, name and description of a file. The rest of the file may be invalid.
struct FileHead {
  std::string kind, name, description;  ///< Empty if missing.
};

/// Reads the head of a file of any kind. If the file is not valid YAML, returns nothing and adds an
/// error.
std::optional<FileHead> ReadFileHead(const std::string& path, Diagnostics& out);

/// Clock of a controller: ticks at phase_s, phase_s + period_s, ... [s], independent of the step.
struct ClockSpec {
  double period_s = 0.001;
  double phase_s = 0.0;
};

/// Gains of a cable under impedance control (Mirletz et al. 2015, eq. 3). Rates are positive while
/// the cable lengthens.
struct ImpedanceGains {
  int cable = 0;
  double tension_offset_n = 0.0;         ///< Tension offset T0 >= 0.
  double length_offset_m = 0.0;          ///< Length offset L0 >= 0.
  double position_gain_n_per_m = 0.0;    ///< Position gain K >= 0.
  double velocity_gain_n_s_per_m = 0.0;  ///< Velocity gain B >= 0.
  double velocity_offset_m_per_s = 0.0;  ///< Velocity offset V0.
};

/// Conversion of a tension set point to a rest length command.
enum class TensionConversion {
  kStiffness,  ///< L = L_now - (T_set - T_now) / k, as in NTRT's tgTensionController.
  /// A PID controller of the tension commands the rate of the rest length, as on the boards of
  /// Mirletz et al. 2015.
  kPid,
};

struct PidGains {
  double proportional_m_per_s_n = 0.0;  ///< Winding-in rate per newton of tension error.
  double integral_m_per_s2_n = 0.0;
  double derivative_m_per_n = 0.0;
};

struct ImpedanceSpec {
  TensionConversion conversion = TensionConversion::kStiffness;
  PidGains pid;
  /// False: dl/dt is exact. True: difference quotient of the lengths at successive ticks, as on a
  /// board or in NTRT. `start_from_rest_length`: the first tick uses the rest length as the
  /// previous length, as in NTRT.
  bool differenced_rate = false;
  bool start_from_rest_length = false;
  std::vector<ImpedanceGains> cables;
};

/// Rest length against time: linear between points, constant before the first and after the last.
/// One point is a constant command; two points are a ramp.
struct PositionProgram {
  int cable = 0;
  /// (time_s, rest_length_m); times increase.
  std::vector<std::pair<double, double>> rest_length_m;
};

/// Switch to another gait at a given time.
struct GaitChange {
  double at_s = 0.0;
  int gait = 0;  ///< Gait number. 0: `gait`; i: `others[i - 1]`.
};

/// Gait as input of a controller, with a separate clock. The output of the gait is constant between
/// ticks.
struct GaitInputSpec {
  ClockSpec clock{0.01, 0.0};
  GaitSpec gait;                    ///< Initial gait.
  std::vector<GaitSpec> others;     ///< Further gaits for the same cables and the same quantity.
  std::vector<GaitChange> changes;  ///< In order of increasing time.
  /// Duration of a transition between gaits without corresponding oscillators. During the
  /// transition, the weight of the previous gait decreases smoothly from 1 to 0.
  double blend_s = 0.5;
};

/// Returns the gait with a number as in `GaitChange::gait`.
inline const GaitSpec& GaitOf(const GaitInputSpec& input, std::size_t number) {
  return number == 0 ? input.gait : input.others[number - 1];
}

/// Controller: impedance control or position control of cables, optionally with a gait.
/// Alternatively, the motor boards, which run the control law of the other controllers.
struct ControllerSpec {
  std::string name;
  ClockSpec clock;
  std::optional<ImpedanceSpec> impedance;  ///< Not together with `position` or `rest_length_input`.
  std::vector<PositionProgram> position;
  /// Only with `impedance`; added to the velocity offset V0 of each cable.
  std::optional<GaitInputSpec> velocity_input;
  /// Added to the programs of the cables, or to the initial rest lengths of cables without a
  /// program.
  std::optional<GaitInputSpec> rest_length_input;
  /// If present, all other members except `name` are empty, and this controller is the last in the
  /// list.
  std::optional<BoardsSpec> boards;
};

/// Returns the motor boards among the controllers, or null if there are none.
const BoardsSpec* BoardsOf(const std::vector<ControllerSpec>& controllers) noexcept;

/// Returns the gait input of a controller, or null; there is at most one.
inline GaitInputSpec* GaitInputOf(ControllerSpec& controller) noexcept {
  if (controller.velocity_input) return &*controller.velocity_input;
  return controller.rest_length_input ? &*controller.rest_length_input : nullptr;
}
inline const GaitInputSpec* GaitInputOf(const ControllerSpec& controller) noexcept {
  if (controller.velocity_input) return &*controller.velocity_input;
  return controller.rest_length_input ? &*controller.rest_length_input : nullptr;
}

/// Push: force on a node against time. The force is linear between points, and zero before the
/// first and after the last point.
struct PushSpec {
  std::string name;
  int node = 0;
  Vec3 direction{1.0, 0.0, 0.0};                   ///< Unit vector in W.
  double scale = 1.0;                              ///< Factor on `force_n`.
  std::vector<std::pair<double, double>> force_n;  ///< (time_s, force_n); times increase.
};

/// Drag: a spring and damper, like a hand-held scale, pulls a node toward a moving point. The point
/// starts at the position of the node at `from_s` and has a constant velocity.
struct DragSpec {
  std::string name;
  int node = 0;
  Vec3 velocity_m_per_s;  ///< Velocity of the moving point, in W.
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
  kSettled,          ///< Static equilibrium under gravity and contact, with fixed rest lengths.
  kSettledFloating,  ///< Static equilibrium under cable forces only, without gravity and ground.
};

/// Frame of the measured goal direction.
enum class GoalFrame {
  kOfBody,   ///< x along `GoalSpec::ahead`, y to the left: a camera on the body sees a beacon.
  kOfWorld,  ///< x and y of W: a compass, as in NTRT.
};

/// Goal of a robot, and the sensor for its direction.
struct GoalSpec {
  Vec3 at_m;     ///< Position in W; the height is ignored.
  int body = 0;  ///< Body whose center of mass approaches the goal.
  /// Forward direction of this body in the initial pose; unit vector in W.
  Vec3 ahead{1.0, 0.0, 0.0};
  GoalFrame frame = GoalFrame::kOfBody;
  double period_s = 0.01;  ///< Time between readings.
};

/// Digitization of a load cell on a board: force = gain * count + offset. Counts are integers from
/// 0, clipped at the saturation of the amplifier and of the converter. Defaults: Tetraspine3
/// (Mirletz et al. 2015, eq. 7).
struct LoadCellCounts {
  double gain_n_per_count = 0.1567;  ///< Force per count, > 0.
  double offset_n = -4.9363;         ///< Force at count 0.
  int bits = 10;                     ///< Bits of the converter, 1..32.
  int saturation_count = 741;        ///< Largest count that the amplifier reaches, >= 1.
  double noise_counts = 0.0;         ///< Standard deviation of each sample before quantization.
};

/// Load cell: T' = (1 + gain) T + bias + drift t + noise. The result is limited to a range,
/// quantized in steps or counts, and delayed.
struct LoadCellSpec {
  double noise_n = 0.0;  ///< Standard deviation of the white noise of each sample.
  double bias_n = 0.0;   ///< Standard deviation of the bias of each cell, constant during a run.
  double min_n = 0.0;    ///< Lower end of the range.
  double max_n = std::numeric_limits<double>::infinity();
  double quantum_n = 0.0;  ///< Step of the converter, starting at `min_n`; 0: none.
  double delay_s = 0.0;    ///< A whole number of sensor periods.
  // Standard deviations of calibration errors over the cells, drawn once per run.
  double gain_error = 0.0;                              ///< Relative error of the gain [1].
  double drift_n_per_s = 0.0;                           ///< Drift rate of the zero.
  std::optional<LoadCellCounts> counts = std::nullopt;  ///< Replaces range and quantum.
};

/// Encoder of a motor, which measures the rest length in counts.
struct EncoderSpec {
  double quantum_m = 0.0;  ///< Change of the rest length per count; 0: no quantization.
  double delay_s = 0.0;    ///< A whole number of sensor periods.
  // Standard deviations of errors over the cables, drawn once per run.
  double zero_error_m = 0.0;  ///< Error of the initial rest length.
  double gain_error = 0.0;    ///< Relative error of the rest length per count [1].
  /// Distance between index marks; 0: none. The first mark corrects the zero error up to a multiple
  /// of this distance.
  double index_m = 0.0;
};

/// Sensors between the robot and its controllers. Without sensors, controllers receive exact
/// values.
struct SensorSpec {
  double period_s = 0.001;  ///< Time between samples; the first sample is at t = 0.
  std::optional<LoadCellSpec> load_cell;
  std::optional<EncoderSpec> encoder;
  /// True: the length of a cable is estimated as L + T / k and its rate from successive samples, as
  /// on a board. False: both are exact.
  bool length_from_tension = false;
};

struct RecordSpec {
  double rate_hz = 100.0;  ///< Rows per second; 0: every step.
  /// Name patterns with `*`; empty: all default channels.
  std::vector<std::string> channels;
  std::vector<SourceRef> channel_sources;  ///< Position of each pattern in the file; may be empty.
  int contacts = 0;                        ///< Contact slots per row.
};

/// Reference values, for example from a robot or another simulator, for comparison in the summary.
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
  std::string source;  ///< Origin of the values.
  Quantity quantity = Quantity::kTension;
  Statistic statistic = Statistic::kMax;
  std::string phase;  ///< Phase of the timeline; empty: the whole run, with kMax only.
  std::vector<Value> values;
};

/// Resolved experiment file.
struct ExperimentSpec {
  std::string name;
  std::string description;
  RobotSpec robot;  ///< Terrain and overrides of the experiment are in `robot.def`.
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
  std::optional<std::string> compare_with;  ///< Trace to compare the result with.
  std::vector<ReferenceSpec> references;
  /// Only for reinforcement learning (taut/env.h).
  std::optional<EnvironmentSpec> environment;
  std::map<std::string, double> parameters;  ///< Resolved parameters of the experiment.
  std::vector<std::string> files;            ///< All files read; the experiment file is first.
  std::uint64_t input_hash = 0;  ///< FNV-1a hash of the bytes of `files` and of the overrides.
};

/// Variant of an experiment: controller parameters (except clocks and driven cables), factors on
/// the model, start and seed.
struct RolloutWorld {
  std::vector<ControllerSpec> controllers;
  std::vector<ScaleSpec> scales;
  StartNoise start_noise;
  std::uint64_t seed = 0;
  /// Numbers for custom controllers (taut/plant.h), which define their meaning.
  std::vector<double> numbers;
};

/// Returns a list of the parts of an experiment that act on its model in a run, such as
/// "controllers, pushes". `LoadExperiment` stores it in `ModelDef::experiment_parts`. Set it again
/// if you change such a part and then compile the model for a `WorldBatch`.
std::string ActingParts(const ExperimentSpec& experiment);

/// Returns the variant that equals the experiment itself.
RolloutWorld WorldOf(const ExperimentSpec& experiment);
/// Returns the experiment with the values of this variant.
ExperimentSpec ExperimentOf(const ExperimentSpec& base, const RolloutWorld& world);

/// Reads an experiment file and its model, or the text from `ResolvedYaml`. On an error, returns
/// nothing and adds diagnostics.
std::optional<ExperimentSpec> LoadExperiment(const std::string& path, const Overrides& overrides,
                                             Diagnostics& out);

/// Returns an experiment and its robot as one YAML text of plain numbers, without parameters,
/// models or bases. `LoadExperiment` restores bit-identical values, so the text reproduces the run
/// without other files.
std::string ResolvedYaml(const ExperimentSpec& experiment);

/// Returns a robot as the text of a model file, for further editing: nodes at the positions in
/// `robot.def`, pairs, builders. Velocities and terrain are omitted. `LoadRobot` restores the same
/// robot up to rounding. If a model file cannot represent the robot, returns nothing and adds an
/// error. `heading`: comment of one or more lines at the top.
std::optional<std::string> ModelYaml(const RobotSpec& robot, const std::string& heading,
                                     Diagnostics& out);

}  // namespace taut
