/// Gaits: signals for many cables, as velocity inputs V0 of impedance control (Mirletz et al. 2015,
/// eq. 3) or as changes of rest lengths. Kinds: sine waves, central pattern generators, tables, and
/// goal-directed laws. Each gait is a separate file (docs/formats/gait.md). The experiment defines
/// the controller that plays it and the clock of the gait.
///
/// All numbers of a gait are doubles; `GaitValues` lists them by name for tuning. A gait selects
/// cables by name, and `ResolveGait` finds them in a robot. Therefore one gait works on spines with
/// any number of segments.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/types.h"

namespace taut {

struct RobotSpec;

/// Selector of cables, as in an experiment. The selector matches a cable that has all tags of at
/// least one of these sets. The name of a cable is one of its tags.
using CableMatch = std::vector<std::vector<std::string>>;

/// Driven quantity. This quantity determines the unit of amplitudes, offsets and tables.
enum class GaitDrives {
  kVelocity,    ///< V0 of impedance control [m/s].
  kRestLength,  ///< Change of rest lengths [m].
};

/// Sine wave for some cables: offset + amplitude cos(2 pi f t + phase) (docs/theory/gaits.md, eq.
/// G.1).
struct SineWave {
  std::string name;
  CableMatch cables;
  double amplitude = 0.0;  ///< Amplitude [m/s], or [m] for rest lengths. May be negative.
  double phase_rad = 0.0;
  double offset = 0.0;  ///< Mean value [m/s], or [m] for rest lengths.
  /// Phase added per segment toward the rear, for a traveling wave. Cables between segments i - 1
  /// and i, with names that end in _i, get (i - 1) times this phase.
  double phase_per_segment_rad = 0.0;
  std::optional<double> frequency_hz;  ///< Absent: the gait's frequency.
  SourceRef at;
};

struct SineGait {
  double frequency_hz = 1.0;
  std::vector<SineWave> waves;
};

/// Symmetry of a CPG: defines which couplings share a weight and a phase (docs/theory/gaits.md,
/// section Couplings).
enum class CpgSymmetry {
  /// Couplings share values if the roles of both cables (names without _i) and the relative
  /// position agree: neighbor in front, at the same joint, or behind (eq. G.9). Segments, and both
  /// directions within a joint, do not matter. 57 groups for six roles.
  kSegments,
  /// Rule of NTRT: positions in `order` (eq. G.10). 57 groups for six roles.
  kIndex,
  kNone,  ///< One group per coupling.
};

/// Group of couplings with common weight and phase.
struct CouplingGroup {
  std::string name;  ///< For example "behind.outer_top.inner_left"; see `FindCouplings`.
  /// Weight w [1/m], or [1/(m s)] for rest lengths. Weight times amplitude of the neighbor is a
  /// rate in rad/s.
  double weight = 0.0;
  double phase_rad = 0.0;  ///< Phase phi: target of theta_j - theta_i.
  SourceRef at;
};

/// Feedback from the tension T of a cable to its oscillator: theta' += gain (T - reference) cos
/// theta.
struct CpgFeedback {
  double gain_rad_per_n_s = 0.0;
  double reference_n = 0.0;
};

/// Central pattern generator: one phase oscillator with amplitude dynamics per cable (Mirletz et
/// al. 2015, eq. 4-6).
struct CpgGait {
  double frequency_hz = 1.0;        ///< Frequency v of all oscillators.
  double amplitude = 0.05;          ///< Amplitude R of all oscillators [m/s], or [m]; >= 0.
  double convergence_per_s = 20.0;  ///< Convergence rate a of all oscillators, > 0.
  /// Largest step of the fourth-order Runge-Kutta integrator, > 0.
  double integrator_step_s = 0.001;
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  /// Cable names; empty: all cables with an actuator, in model order.
  std::vector<std::string> order;
  CableMatch inverted;  ///< Cables whose signal is the negative output of their oscillator.
  std::optional<CpgFeedback> feedback;
  std::vector<CouplingGroup> groups;  ///< All groups of the robot, in the order of `FindCouplings`.
  SourceRef at;
};

/// Gait from a table of velocities or rest length changes.
struct TableGait {
  std::vector<std::string> cables;        ///< Names, one per column.
  std::vector<double> time_s;             ///< Increasing; the first is 0.
  std::vector<std::vector<double>> rows;  ///< One row per time, one value per cable: [m/s], or [m].
  bool linear = false;  ///< Linear interpolation; false: constant until the next row.
  /// Time from which the table repeats after its last row; absent: the last row remains.
  std::optional<double> repeat_from_s;
  SourceRef at;
};

/// Neuron: one weight per neuron of the previous layer and a bias.
struct Neuron {
  std::string name;
  std::vector<double> weights;
  double bias = 0.0;
  SourceRef at;
};

/// Feed-forward neural network with one hidden layer and outputs within -1..1
/// (docs/theory/gaits.md, eq. G.19). Unlisted outputs are 0.
struct NetworkSpec {
  static constexpr std::size_t kMostHidden = 32;
  std::vector<Neuron> hidden;   ///< Weights in order of the inputs.
  std::vector<Neuron> outputs;  ///< Weights in order of the hidden neurons.
  SourceRef at;
};

/// Oscillator with sensor feedback, for each selected cable.
struct FeedbackOscillator {
  std::string name;
  CableMatch cables;
  double amplitude = 0.0;  ///< Amplitude R without feedback [m/s], or [m]; >= 0.
  double phase_rad = 0.0;  ///< Initial phase.
  double offset = 0.0;     ///< Added to the signal [m/s], or [m].
  SourceRef at;
};

/// CPG with feedback from two neural networks (docs/theory/gaits.md, eq. G.15 to G.21). One network
/// is shared by all cables; its inputs are length and tension of a cable. The other network is
/// shared by all joints; its input is the direction of the goal.
struct FeedbackCpgGait {
  double frequency_hz = 1.0;  ///< Initial frequency v of all oscillators.
  double convergence_per_s = 5.0;
  double frequency_gain_hz_per_s = 0.0;
  double amplitude_gain = 0.0;
  double phase_gain_rad_per_s = 0.0;
  double integrator_step_s = 0.01;
  std::vector<FeedbackOscillator> oscillators;  ///< A cable matches at most one of them.
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  std::vector<CouplingGroup> groups;  ///< Unlisted groups have weight 0.
  /// Inputs: "stretch" and "tension"; outputs: "frequency", "amplitude" and "phase".
  std::optional<NetworkSpec> cable_network;
  /// Inputs: "goal_x", "goal_y" and optionally "place"; outputs: "OSCILLATOR_frequency", ..., for
  /// each name in `oscillators`.
  std::optional<NetworkSpec> goal_network;
  SourceRef at;
};

/// Rolling toward a goal. The signal of a cable is a polynomial in its position relative to the
/// center of the robot, in radii of the robot: `ahead` (toward the goal) and `up`
/// (docs/theory/gaits.md, eq. G.24). Coefficients are in [m/s], or [m]; `ahead2_up` belongs to
/// ahead^2 up.
struct TowardGoalGait {
  CableMatch cables;
  double offset = 0.0;
  double ahead = 0.0, up = 0.0;
  double ahead2 = 0.0, ahead_up = 0.0, up2 = 0.0;
  double ahead3 = 0.0, ahead2_up = 0.0, ahead_up2 = 0.0, up3 = 0.0;
  double beat = 0.0;     ///< Modulation depth of all terms except the offset (eq. G.25).
  double beat_hz = 0.5;  ///< Frequency of the modulation, >= 0.
  SourceRef at;
};

/// Contents of a gait file. Exactly one of the five gaits is present.
struct GaitSpec {
  std::string name;
  std::string description;
  GaitDrives drives = GaitDrives::kVelocity;
  std::optional<SineGait> sine;
  std::optional<CpgGait> cpg;
  std::optional<TableGait> table;
  std::optional<FeedbackCpgGait> feedback_cpg;
  std::optional<TowardGoalGait> toward_goal;
  std::vector<std::string> files;  ///< All files read; the gait file is first.
};

/// Reads a gait file. On an error, returns nothing and adds diagnostics.
std::optional<GaitSpec> LoadGait(const std::string& path, Diagnostics& out);

/// Returns the gait as YAML text. `LoadGait` reads exactly the same numbers from it.
std::string GaitYaml(const GaitSpec& gait);

/// Writes `GaitYaml` to a file. Returns false and adds an error on failure.
bool SaveGait(const GaitSpec& gait, const std::string& path, Diagnostics& out);

/// Order of the spine's cables in NTRT's CPG. Learned parameters are valid for one order only.
enum class NtrtCableOrder {
  kPaper2015,  ///< One builder after another, as for the learned gait of Mirletz et al. 2015.
  kSince2016,  ///< One pair of nodes after another.
};

/// Imports a gait of NTRT's spines. `path` is one of: a folder with bestParameters-9_node-0.nnw and
/// ..._edge-0.nnw to 56; controlVars.json of the hand-tuned sines; the .json of a controller with
/// feedback, which contains the paths of its networks. On an error, returns nothing and adds
/// diagnostics.
std::optional<GaitSpec> ImportNtrtGait(const std::string& path, NtrtCableOrder order,
                                       Diagnostics& out);

/// Creates a CPG for a robot, with all coupling groups; their weights and phases are 0. On an
/// error, returns nothing and adds diagnostics.
std::optional<GaitSpec> NewCpgGait(const RobotSpec& robot, CpgSymmetry symmetry, Diagnostics& out,
                                   GaitDrives drives = GaitDrives::kVelocity);

/// Returns a table as text: a header "time_s,outer_top_1_m_per_s,..." ("outer_top_1_m" for rest
/// lengths), then one line per row. `table: {file: ...}` in a gait file reads exactly the same
/// numbers from it.
std::string GaitTableText(const TableGait& table, GaitDrives drives = GaitDrives::kVelocity);

/// Tunable number of a gait. Examples of names: "sine.<wave>.amplitude_m_per_s",
/// "cpg.frequency_hz", "cpg.<group>.weight_per_m", "cpg.<group>.phase_rad",
/// "feedback_cpg.goal_network.<neuron>.weights_1", ..._2; for rest lengths
/// "sine.<wave>.amplitude_m", "cpg.<group>.weight_per_m_s".
struct GaitValue {
  std::string name;
  std::string unit;       ///< "m/s", "m", "rad", "Hz", "1/m", "1/(m s)", "1/s", "N", "rad/(N s)".
  double* value;          ///< Pointer into the gait; valid until the gait is moved or resized.
  double min, max;        ///< Range of useful values that give different gaits; may be infinite.
  bool at_start = false;  ///< True for an initial value: changes after the start have no effect.
};

/// Returns all numbers of the gait that affect the motion; none for a table.
std::vector<GaitValue> GaitValues(GaitSpec& gait);

/// Coupling graph of a CPG. Oscillator i drives the cable `cables[i]`.
struct CouplingGraph {
  struct Coupling {
    int to = 0, from = 0;  ///< Oscillator indices: the phase of `from` affects `to`.
    int group = 0;         ///< Index in `CouplingGraph::groups`.
  };
  std::vector<int> cables;          ///< Index of the cable in the robot, per oscillator.
  std::vector<Coupling> couplings;  ///< Sorted by `to`, then by `from`.
  std::vector<std::string> groups;  ///< Names of the coupling groups.
};

/// Computes the coupling graph. There is one oscillator per cable of `order` (empty: per cable with
/// an actuator). Each oscillator is coupled to every oscillator whose cable has an attachment on a
/// common body (docs/theory/gaits.md, eq. G.8). On an error, returns nothing and adds diagnostics
/// at `at`.
std::optional<CouplingGraph> FindCouplings(const RobotSpec& robot, CpgSymmetry symmetry,
                                           const std::vector<std::string>& order,
                                           const SourceRef& at, Diagnostics& out);

/// Gait with cable indices of a robot, ready for a controller.
struct ResolvedGait {
  struct Wave {
    int wave = 0;            ///< Index in `SineGait::waves`.
    int segments_ahead = 0;  ///< Factor of `phase_per_segment_rad`.
  };
  std::vector<int> cables;   ///< Indices of the driven cables.
  std::vector<Wave> waves;   ///< For sine gaits: one per driven cable.
  CouplingGraph graph;       ///< For CPG gaits; its cables equal `cables`.
  std::vector<double> sign;  ///< For CPG gaits, per oscillator: 1 or -1.
  // For CPG gaits with feedback, per oscillator:
  std::vector<int> role;  ///< Index in `FeedbackCpgGait::oscillators`.
  /// Joint index: cables with the same number at the end of their names share a joint.
  std::vector<int> joint;
  std::vector<double> place;           ///< Position per joint: 1 at the front, -1 at the rear.
  std::vector<double> most_tension_n;  ///< Largest actuator tension.
  // For gaits toward a goal, in W and in the described pose:
  struct Strut {
    int body = 0;
    Vec3 along;  ///< Unit vector.
  };
  std::vector<Strut> struts;  ///< Struts with measured directions, which span all three dimensions.
  /// Per cable: vector from the center of the robot to the middle of the cable, in radii of the
  /// robot.
  std::vector<Vec3> from_center;
};

/// Finds the cables of a gait in a robot and checks that the coupling groups match the robot. On an
/// error, returns nothing and adds diagnostics.
std::optional<ResolvedGait> ResolveGait(const GaitSpec& gait, const RobotSpec& robot,
                                        Diagnostics& out);

}  // namespace taut
