/// Gaits (sine waves, central pattern generators, tables, goal-directed laws): signals for many
/// cables, as velocity inputs V0 of impedance control (paper eq. 3) or as changes of rest lengths.
/// A gait is a separate file (docs/formats/gait.md); the experiment sets the controller that plays
/// it and the gait's clock.
///
/// All numbers of a gait are plain doubles; `GaitValues` lists them by name for tuning. A gait
/// names cables, and `ResolveGait` finds them in a robot, so one gait plays on a spine of any
/// number of segments.
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

/// Selector of cables, as in an experiment: matches cables that have all tags of any of these sets.
/// A cable's name is one of its tags.
using CableMatch = std::vector<std::vector<std::string>>;

/// Driven quantity, which sets the unit of a gait's amplitudes, offsets and tables.
enum class GaitDrives {
  kVelocity,    ///< V0 of impedance control [m/s].
  kRestLength,  ///< Change of rest lengths [m].
};

/// offset + amplitude cos(2 pi f t + phase) for some cables (docs/theory/gaits.md, eq. G.1).
struct SineWave {
  std::string name;
  CableMatch cables;
  double amplitude = 0.0;  ///< [m/s], or [m] for driven rest lengths. May be negative.
  double phase_rad = 0.0;
  double offset = 0.0;  ///< [m/s], or [m].
  /// Phase added per segment toward the rear: a traveling wave. Cables between segments i - 1 and
  /// i, whose names end in _i, get (i - 1) times this.
  double phase_per_segment_rad = 0.0;
  std::optional<double> frequency_hz;  ///< Absent: the gait's frequency.
  SourceRef at;
};

struct SineGait {
  double frequency_hz = 1.0;
  std::vector<SineWave> waves;
};

/// Grouping of couplings with common weight and phase (docs/theory/gaits.md, section Couplings).
enum class CpgSymmetry {
  /// By the roles of both cables (the name without _i) and the position of the neighbor: in front,
  /// at
  /// the same joint, or behind (eq. G.9). The same for all segments, and for both directions within
  /// a
  /// joint. 57 groups for six roles.
  kSegments,
  /// NTRT's rule, by positions in `order` (eq. G.10). 57 groups for six roles.
  kIndex,
  kNone,  ///< One group per coupling.
};

/// Group of couplings, with their weight and phase.
struct CouplingGroup {
  std::string name;  ///< As in `FindCouplings`: "behind.outer_top.inner_left".
  /// w [1/m], or [1/(m s)] for driven rest lengths. Multiplied by the neighbor's amplitude it is a
  /// rate in rad/s.
  double weight = 0.0;
  double phase_rad = 0.0;  ///< phi: target of theta_j - theta_i.
  SourceRef at;
};

/// Feedback of a cable's tension on its oscillator: theta' += gain (T - reference) cos theta.
struct CpgFeedback {
  double gain_rad_per_n_s = 0.0;
  double reference_n = 0.0;
};

/// Central pattern generator: phase oscillators with amplitude dynamics, one per cable (paper eq.
/// 4-6).
struct CpgGait {
  double frequency_hz = 1.0;         ///< Frequency v of all oscillators.
  double amplitude = 0.05;           ///< Amplitude R of all oscillators [m/s], or [m]; >= 0.
  double convergence_per_s = 20.0;   ///< Convergence rate a of all oscillators, > 0.
  double integrator_step_s = 0.001;  ///< Longest step of the Runge-Kutta integrator (order 4), > 0.
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  std::vector<std::string> order;  ///< Names of cables; empty: all with an actuator, in order.
  CableMatch inverted;             ///< Cables whose signal is the negative of their oscillator's.
  std::optional<CpgFeedback> feedback;
  std::vector<CouplingGroup> groups;  ///< All groups of the robot, in their order.
  SourceRef at;
};

/// Gait from a table of velocities or of changes of rest lengths.
struct TableGait {
  std::vector<std::string> cables;        ///< Names, one per column.
  std::vector<double> time_s;             ///< Increasing, the first 0.
  std::vector<std::vector<double>> rows;  ///< Per time, for each cable: [m/s], or [m].
  bool linear = false;                    ///< Linear interpolation; false: each row holds.
  std::optional<double> repeat_from_s;    ///< Return to this time after the last row; absent: hold.
  SourceRef at;
};

/// Neuron: one weight per neuron of the previous layer, and a bias.
struct Neuron {
  std::string name;
  std::vector<double> weights;
  double bias = 0.0;
  SourceRef at;
};

/// Feed-forward neural network with one hidden layer; outputs lie within -1..1
/// (docs/theory/gaits.md, eq. G.19). Outputs that are not listed are 0.
struct NetworkSpec {
  static constexpr std::size_t kMostHidden = 32;
  std::vector<Neuron> hidden;   ///< Weights in the order of the inputs.
  std::vector<Neuron> outputs;  ///< Weights in the order of the hidden neurons.
  SourceRef at;
};

/// Oscillators with sensory feedback, one per selected cable.
struct FeedbackOscillator {
  std::string name;
  CableMatch cables;
  double amplitude = 0.0;  ///< Amplitude R without feedback [m/s], or [m]; >= 0.
  double phase_rad = 0.0;  ///< Initial phase.
  double offset = 0.0;     ///< Added to the signal [m/s], or [m].
  SourceRef at;
};

/// Phase oscillators with feedback from two networks: one shared by all cables, with each cable's
/// length and tension as inputs; one shared by all joints, with the direction of the goal
/// (docs/theory/gaits.md, eq. G.15 to G.21).
struct FeedbackCpgGait {
  double frequency_hz = 1.0;  ///< Initial frequency v of all oscillators.
  double convergence_per_s = 5.0;
  double frequency_gain_hz_per_s = 0.0;
  double amplitude_gain = 0.0;
  double phase_gain_rad_per_s = 0.0;
  double integrator_step_s = 0.01;
  std::vector<FeedbackOscillator> oscillators;  ///< At most one per cable.
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  std::vector<CouplingGroup> groups;  ///< Unlisted groups have no coupling.
  /// Inputs: "stretch" and "tension"; outputs: "frequency", "amplitude" and "phase".
  std::optional<NetworkSpec> cable_network;
  /// Inputs: "goal_x", "goal_y" and, with three inputs, "place"; outputs: "OSCILLATOR_frequency",
  /// ..., for each name of `oscillators`.
  std::optional<NetworkSpec> goal_network;
  SourceRef at;
};

/// Rolling toward a goal: a cable's signal is a polynomial in its position `ahead` (toward the
/// goal) and `up`, relative to the robot's center and in radii of the robot (docs/theory/gaits.md,
/// eq. G.24). All coefficients are in [m/s], or [m]; `ahead2_up` is the coefficient of ahead^2 up.
struct TowardGoalGait {
  CableMatch cables;
  double offset = 0.0;
  double ahead = 0.0, up = 0.0;
  double ahead2 = 0.0, ahead_up = 0.0, up2 = 0.0;
  double ahead3 = 0.0, ahead2_up = 0.0, ahead_up2 = 0.0, up3 = 0.0;
  double beat = 0.0;     ///< Modulation depth of all terms but the offset (eq. G.25).
  double beat_hz = 0.5;  ///< Frequency of the modulation, >= 0.
  SourceRef at;
};

/// Contents of a gait file. Exactly one of the five kinds is present.
struct GaitSpec {
  std::string name;
  std::string description;
  GaitDrives drives = GaitDrives::kVelocity;
  std::optional<SineGait> sine;
  std::optional<CpgGait> cpg;
  std::optional<TableGait> table;
  std::optional<FeedbackCpgGait> feedback_cpg;
  std::optional<TowardGoalGait> toward_goal;
  std::vector<std::string> files;  ///< All files read, the gait first.
};

/// Reads a gait file. Returns nothing, and adds diagnostics, on any error.
std::optional<GaitSpec> LoadGait(const std::string& path, Diagnostics& out);

/// Returns the gait as YAML. `LoadGait` reads it back to the same bits.
std::string GaitYaml(const GaitSpec& gait);

/// Writes `GaitYaml` to a file. Returns false and adds an error on failure.
bool SaveGait(const GaitSpec& gait, const std::string& path, Diagnostics& out);

/// Order of the spine's cables in NTRT's CPG; learned parameters belong to one order.
enum class NtrtCableOrder {
  kPaper2015,  ///< Builder by builder, as when the paper's gait was learned.
  kSince2016,  ///< Pair by pair.
};

/// Imports a gait of NTRT's spines. `path`: a folder with bestParameters-9_node-0.nnw,
/// ..._edge-0.nnw to 56; controlVars.json of the hand-tuned sines; or the .json of a controller
/// with feedback, with its networks at the paths in it. Returns nothing, and adds diagnostics, on
/// any error.
std::optional<GaitSpec> ImportNtrtGait(const std::string& path, NtrtCableOrder order,
                                       Diagnostics& out);

/// Creates a CPG for a robot, with all groups of couplings and weights and phases of 0. Returns
/// nothing, and adds diagnostics, on any error.
std::optional<GaitSpec> NewCpgGait(const RobotSpec& robot, CpgSymmetry symmetry, Diagnostics& out,
                                   GaitDrives drives = GaitDrives::kVelocity);

/// Returns a table as text: the line "time_s,outer_top_1_m_per_s,..." ("outer_top_1_m" for driven
/// rest lengths), then one line per row. `table: {file: ...}` in a gait file reads it back to the
/// same bits.
std::string GaitTableText(const TableGait& table, GaitDrives drives = GaitDrives::kVelocity);

/// Tunable number of a gait, with a name such as "sine.<wave>.amplitude_m_per_s",
/// "cpg.frequency_hz", "cpg.<group>.weight_per_m", "cpg.<group>.phase_rad",
/// "feedback_cpg.goal_network.<neuron>.weights_1", ..._2; for driven rest lengths
/// "sine.<wave>.amplitude_m", "cpg.<group>.weight_per_m_s".
struct GaitValue {
  std::string name;
  std::string unit;       ///< "m/s", "m", "rad", "Hz", "1/m", "1/(m s)", "1/s", "N", "rad/(N s)".
  double* value;          ///< In the gait; valid until the gait is moved or resized.
  double min, max;        ///< Range of meaningful, distinct gaits; may be infinite.
  bool at_start = false;  ///< Initial value: later changes have no effect.
};

/// Returns all numbers of the gait that shape the motion; none for a table.
std::vector<GaitValue> GaitValues(GaitSpec& gait);

/// Coupling graph of a CPG. Oscillator i drives cables[i].
struct CouplingGraph {
  struct Coupling {
    int to = 0, from = 0;  ///< Oscillators: the equation of `to` contains the phase of `from`.
    int group = 0;         ///< Index in `groups`.
  };
  std::vector<int> cables;          ///< Per oscillator: index of the cable in the robot.
  std::vector<Coupling> couplings;  ///< By `to`, then `from`.
  std::vector<std::string> groups;  ///< Names.
};

/// Computes the coupling graph: one oscillator per cable of `order` (empty: all cables with an
/// actuator), coupled to every other oscillator whose cable has an attachment on the same body
/// (docs/theory/gaits.md, eq. G.8). Returns nothing, and adds diagnostics at `at`, on any error.
std::optional<CouplingGraph> FindCouplings(const RobotSpec& robot, CpgSymmetry symmetry,
                                           const std::vector<std::string>& order,
                                           const SourceRef& at, Diagnostics& out);

/// Gait with its cables resolved in a robot, ready for a controller.
struct ResolvedGait {
  struct Wave {
    int wave = 0;            ///< Index in `SineGait::waves`.
    int segments_ahead = 0;  ///< Multiple of `phase_per_segment_rad`.
  };
  std::vector<int> cables;   ///< Indices of the driven cables.
  std::vector<Wave> waves;   ///< Sine: in the order of `cables`.
  CouplingGraph graph;       ///< CPG; its cables are `cables`.
  std::vector<double> sign;  ///< CPG, per oscillator: 1 or -1.
  // CPG with feedback, per oscillator:
  std::vector<int> role;               ///< Index in `FeedbackCpgGait::oscillators`.
  std::vector<int> joint;              ///< Cables whose names end in the same number share a joint.
  std::vector<double> place;           ///< Per joint: 1 at the front, -1 at the rear.
  std::vector<double> most_tension_n;  ///< Largest tension of the actuator.
  // Toward a goal, in W in the described pose:
  struct Strut {
    int body = 0;
    Vec3 along;  ///< Unit vector.
  };
  std::vector<Strut> struts;      ///< Struts with sensed directions; they span all directions.
  std::vector<Vec3> from_center;  ///< Per cable: its middle relative to the center, in radii.
};

/// Finds the gait's cables in a robot and checks that its coupling groups match the robot. Returns
/// nothing, and adds diagnostics, on any error.
std::optional<ResolvedGait> ResolveGait(const GaitSpec& gait, const RobotSpec& robot,
                                        Diagnostics& out);

}  // namespace taut
