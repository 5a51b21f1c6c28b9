/// Robots and experiments as files describe them. Reading never throws and never prints: all
/// that is wrong with a file ends up in `Diagnostics`.
///
/// Threads: any number may call these functions at once, each with diagnostics of its own. A spec
/// is plain data.
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

/// Whether a text may be what a user calls something: letters, digits, `_` and `-`. Names become
/// parts of channel names, of file names and of pages.
bool IsName(std::string_view text);

/// As model files spell it.
std::string JointKindName(JointKind kind);

/// `--set name=value` pairs: named parameters whose value replaces the file's. The value may be
/// an expression such as `2 * edge_m`.
using Overrides = std::vector<std::pair<std::string, std::string>>;

/// Tags that a file gave to a part of the model, for controllers and events to match.
using Tags = std::vector<std::string>;

/// What a rod, sphere or box weighs, as its builder says.
struct SolidMass {
  enum class Per { kWhole, kVolume, kLength };  ///< [kg], [kg/m^3], [kg/m]
  Per per = Per::kWhole;
  double value = 0.0;
};

/// What bodies are welded from. A `ModelDef` has only what follows from it for the whole body.
struct SolidsSpec {
  struct PointMass {
    int node = 0;
    double mass_kg = 0.0, radius_m = 0.0;
    std::optional<Inertia> inertia_kg_m2 = {};  ///< Its own, about the node, in axes of W.
  };
  std::vector<SolidMass> spheres, capsules, boxes;  ///< Per shape of `def`.
  std::vector<PointMass> point_masses;
  bool bounding_box_inertia = false;  ///< `inertia: bounding_box`.
};

/// A model file, resolved: numbers in `def`, plus what only files know (tags, places).
struct RobotSpec {
  ModelDef def;
  std::vector<Tags> cable_tags;          ///< Per cable of `def`; includes the cable's name.
  std::vector<Tags> node_tags;           ///< Per node of `def`; includes the node's name.
  std::vector<Tags> joint_tags;          ///< Per joint of `def`: its pair's or node's, with names.
  std::vector<SourceRef> cable_sources;  ///< Per cable: the pair that it came from.
  std::vector<SourceRef> body_sources;   ///< Per body.
  std::vector<SourceRef> node_sources;   ///< Per node.
  std::vector<SourceRef> plane_sources, terrain_box_sources;  ///< Per part of the terrain.
  std::vector<SourceRef> height_field_sources, mesh_sources;  ///< The same.
  std::optional<SolidsSpec> solids;          ///< Not known of a resolved experiment.
  std::map<std::string, double> parameters;  ///< As resolved, overrides applied.
  std::vector<std::string> files;            ///< Every file that was read, the model first.
};

/// Reads a model file. Returns nothing if there was any error.
std::optional<RobotSpec> LoadRobot(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out);

/// What a file says it is: "model", "experiment" or "gait". Nothing, and a complaint, if it says
/// none of these.
std::optional<std::string> FileKind(const std::string& path, Diagnostics& out);

/// What a file says of itself, without whether the rest of it is right.
struct FileHead {
  std::string kind, name, description;  ///< Empty: it does not say.
};

/// The top of a file of any kind. Nothing, and a complaint, if it cannot be read as YAML.
std::optional<FileHead> ReadFileHead(const std::string& path, Diagnostics& out);

/// When a controller runs: at phase_s, phase_s + period_s, ... [s]. Owned by the controller, not
/// by the step.
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

/// How a tension set point becomes a rest-length command.
enum class TensionConversion {
  kStiffness,  ///< L = L_now - (T_set - T_now) / k: NTRT's tgTensionController.
  kPid,        ///< A PID on the tension error commands the rest length's rate: the paper's boards.
};

struct PidGains {
  double proportional_m_per_s_n = 0.0;  ///< Rate of winding in per newton of error.
  double integral_m_per_s2_n = 0.0;
  double derivative_m_per_n = 0.0;
};

struct ImpedanceSpec {
  TensionConversion conversion = TensionConversion::kStiffness;
  PidGains pid;
  /// From where dl/dt comes: the exact rate, or the change of length since the last tick (as a
  /// board or NTRT has it; the first tick then sees `length - rest_length` as NTRT does if
  /// `start_from_rest_length`).
  bool differenced_rate = false;
  bool start_from_rest_length = false;
  std::vector<ImpedanceGains> cables;
};

/// A rest length against time, piecewise linear, held before the first and after the last point.
/// One point is a constant command, two are a ramp.
struct PositionProgram {
  int cable = 0;
  std::vector<std::pair<double, double>> rest_length_m;  ///< (time_s, rest_length_m), times rising.
};

/// From a time on another gait plays.
struct GaitChange {
  double at_s = 0.0;
  int gait = 0;  ///< 0: `gait`; i: `others[i - 1]`.
};

/// A gait as a controller's input, on a clock of its own: what it says holds from tick to tick.
struct GaitInputSpec {
  ClockSpec clock{0.01, 0.0};
  GaitSpec gait;                    ///< The one that plays first.
  std::vector<GaitSpec> others;     ///< That may follow: for the same cables, the same quantity.
  std::vector<GaitChange> changes;  ///< Times rising.
  /// How long a change takes where the gaits have no oscillators in common that lead from one to
  /// the other: in that time the old gait's share falls smoothly from 1 to 0.
  double blend_s = 0.5;
};

/// A gait of an input, as `GaitChange::gait` counts them.
inline const GaitSpec& GaitOf(const GaitInputSpec& input, std::size_t number) {
  return number == 0 ? input.gait : input.others[number - 1];
}

struct ControllerSpec {
  std::string name;
  ClockSpec clock;
  std::optional<ImpedanceSpec> impedance;  ///< This, or what drives rest lengths.
  std::vector<PositionProgram> position;
  /// With `impedance` only: added to each cable's velocity offset.
  std::optional<GaitInputSpec> velocity_input;
  /// Added to the cables' programs; to a cable's rest length at the start where it has none.
  std::optional<GaitInputSpec> rest_length_input;
};

/// The gait input that a controller has; a controller has one at most. Null: none.
inline GaitInputSpec* GaitInputOf(ControllerSpec& controller) noexcept {
  if (controller.velocity_input) return &*controller.velocity_input;
  return controller.rest_length_input ? &*controller.rest_length_input : nullptr;
}
inline const GaitInputSpec* GaitInputOf(const ControllerSpec& controller) noexcept {
  if (controller.velocity_input) return &*controller.velocity_input;
  return controller.rest_length_input ? &*controller.rest_length_input : nullptr;
}

/// A force on a node against time, piecewise linear, zero before the first and after the last
/// point.
struct PushSpec {
  std::string name;
  int node = 0;
  Vec3 direction{1.0, 0.0, 0.0};                   ///< Unit vector in W.
  double scale = 1.0;                              ///< Factor on force_n.
  std::vector<std::pair<double, double>> force_n;  ///< (time_s, force_n), times rising.
};

/// A spring and damper pulls a node towards a point that starts at the node's place at
/// `from_s` and moves at a steady velocity: a hand-held scale that drags the robot.
struct DragSpec {
  std::string name;
  int node = 0;
  Vec3 velocity_m_per_s;  ///< Of the moving point, in W.
  double stiffness_n_per_m = 0.0;
  double damping_n_s_per_m = 0.0;
  double from_s = 0.0, to_s = 0.0;
};

/// A named span of the timeline, for the summary table.
struct PhaseSpec {
  std::string name;
  double from_s = 0.0, to_s = 0.0;
};

enum class StartKind {
  kAsDescribed,
  kSettled,          ///< Static equilibrium under gravity and contact, rest lengths fixed.
  kSettledFloating,  ///< Static equilibrium of cables alone: no gravity, no ground.
};

/// In which frame the way to the goal is sensed.
enum class GoalFrame {
  kOfBody,   ///< x where the watched body looks, y to its left: a camera on a beacon.
  kOfWorld,  ///< x and y of W: with a compass. NTRT's.
};

/// Where the robot is to go, and how it senses in which direction that is.
struct GoalSpec {
  Vec3 at_m;                  ///< In W; its height does not count.
  int body = 0;               ///< Watched: its centre of mass is to come near.
  Vec3 ahead{1.0, 0.0, 0.0};  ///< Where that body looks, in W as it is placed. Unit vector.
  GoalFrame frame = GoalFrame::kOfBody;
  double period_s = 0.01;  ///< Between two readings.
};

/// What a board makes of a load cell: whole counts, from 0 on, cut off where the amplifier or the
/// converter ends; force = gain count + offset. The defaults are Tetraspine3's (paper eq. 7).
struct LoadCellCounts {
  double gain_n_per_count = 0.1567;  ///< > 0.
  double offset_n = -4.9363;         ///< The force of count 0.
  int bits = 10;                     ///< Of the converter, 1..32.
  int saturation_count = 741;        ///< Where the amplifier ends, >= 1.
  double noise_counts = 0.0;         ///< Standard deviation of each sample before it is counted.
};

/// A tension through a load cell: T' = (1 + gain) T + bias + drift t + noise, limited to a range,
/// in quanta or counts, late.
struct LoadCellSpec {
  double noise_n = 0.0;  ///< Standard deviation of each sample, white.
  double bias_n = 0.0;   ///< Standard deviation of each cell's error for the whole run.
  double min_n = 0.0;    ///< Of the range.
  double max_n = std::numeric_limits<double>::infinity();
  double quantum_n = 0.0;  ///< Step of the converter, from min_n on; 0: none.
  double delay_s = 0.0;    ///< Whole sensor periods.
  // Standard deviations over the cells, each drawn once a run: what a calibration got wrong.
  double gain_error = 0.0;                              ///< Of the gain, relative. [1]
  double drift_n_per_s = 0.0;                           ///< Of the rate at which the zero moves.
  std::optional<LoadCellCounts> counts = std::nullopt;  ///< In place of range and quantum.
};

/// A rest length through counts of a motor's encoder.
struct EncoderSpec {
  double quantum_m = 0.0;  ///< Rest length of a count; 0: exact.
  double delay_s = 0.0;    ///< Whole sensor periods.
  // Standard deviations over the cables, each drawn once a run.
  double zero_error_m = 0.0;  ///< Of the rest length that counts begin with.
  double gain_error = 0.0;    ///< Of the rest length per count, relative. [1]
  double index_m = 0.0;  ///< Between two marks that tell what is wrong by less than that; 0: none.
};

/// What stands between the robot and its controllers. Without it they see exact values.
struct SensorSpec {
  double period_s = 0.001;  ///< Between samples; the first is at t = 0.
  std::optional<LoadCellSpec> load_cell;
  std::optional<EncoderSpec> encoder;
  /// A cable's length from rest length and tension, L + T / k, as a board must have it, and its
  /// rate from successive samples; else both exact.
  bool length_from_tension = false;
};

/// Loads that stand still, for `taut/analysis.h`.
struct LoadCaseSpec {
  struct NodeForce {
    int node = 0;
    Vec3 force_n;  ///< In W.
  };
  struct Settlement {
    int joint = 0;  ///< A support: its point in the world moves.
    Vec3 by_m;      ///< In W.
  };
  struct Lengthening {
    int index = 0;  ///< A cable, or of `bars` a joint that is one.
    double by_m = 0.0;
  };
  std::string name;
  bool weight = true;  ///< Whether gravity acts.
  std::vector<NodeForce> forces;
  std::vector<Settlement> settlements;
  std::vector<Lengthening> cables, bars;  ///< What rest lengths gain; by warmth, too.
};

struct RecordSpec {
  double rate_hz = 100.0;                  ///< Rows a second; 0: every step.
  std::vector<std::string> channels;       ///< Name patterns with `*`; empty: all that are not
                                           ///< recorded on request only.
  std::vector<SourceRef> channel_sources;  ///< Where a file has them; may be empty.
  int contacts = 0;                        ///< Slots for touching points in a row.
};

/// Numbers of somebody else (a robot's, another simulator's) to show ours beside.
struct ReferenceSpec {
  enum class Quantity {
    kTension,  ///< What a load cell feels.
    kElastic,  ///< k (l - L) alone.
  };
  enum class Statistic { kMax, kMean, kMin };
  struct Value {
    int cable = 0;
    double force_n = 0;
  };
  std::string source;  ///< Who says so.
  Quantity quantity = Quantity::kTension;
  Statistic statistic = Statistic::kMax;
  std::string phase;  ///< Of the timeline; empty: the whole run, for which there is only kMax.
  std::vector<Value> values;
};

/// An experiment file, resolved.
struct ExperimentSpec {
  std::string name;
  std::string description;
  RobotSpec robot;  ///< With the experiment's terrain and overrides already in `robot.def`.
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
  std::optional<std::string> compare_with;  ///< A trace to set the result beside.
  std::vector<ReferenceSpec> references;
  std::optional<EnvironmentSpec> environment;  ///< For learners (taut/env.h); a run ignores it.
  std::map<std::string, double> parameters;    ///< The experiment's own, as resolved.
  std::vector<std::string> files;              ///< Every file that was read, the experiment first.
  std::uint64_t input_hash = 0;  ///< FNV-1a of the bytes of `files` and of the overrides.
};

/// What may differ between worlds of one experiment: numbers of its controllers (not their clocks,
/// nor which cables they drive), factors on the model, the start, the seed.
struct RolloutWorld {
  std::vector<ControllerSpec> controllers;
  std::vector<ScaleSpec> scales;
  StartNoise start_noise;
  std::uint64_t seed = 0;
  /// For controllers that a program brings (taut/plant.h): what they make of it is theirs.
  std::vector<double> numbers;
};

RolloutWorld WorldOf(const ExperimentSpec& experiment);
/// The experiment that runs this world alone.
ExperimentSpec ExperimentOf(const ExperimentSpec& base, const RolloutWorld& world);

/// Reads an experiment file and the model it names, or what `ResolvedYaml` wrote. Returns nothing
/// if there was any error.
std::optional<ExperimentSpec> LoadExperiment(const std::string& path, const Overrides& overrides,
                                             Diagnostics& out);

/// The experiment and its robot in numbers, without parameters, models or bases, as one YAML text.
/// `LoadExperiment` reads it back to the same bits, so it reproduces the run on its own.
std::string ResolvedYaml(const ExperimentSpec& experiment);

/// The robot as a model file in numbers, for people to go on with: nodes where `robot.def` has
/// them, pairs, builders. Velocities and terrain are left out. `LoadRobot` reads it back to the
/// same robot, up to rounding; what a model file cannot say is a complaint, and then there is
/// nothing. `heading`: a comment at its top, a line or several.
std::optional<std::string> ModelYaml(const RobotSpec& robot, const std::string& heading,
                                     Diagnostics& out);

}  // namespace taut
