/// Gaits: what makes, for many cables at once, the velocity input V0 of impedance control (paper
/// eq. 3) or a part of their rest lengths. A gait is a file of its own (docs/formats/gait.md); the
/// experiment says which controller plays it and how often.
///
/// All numbers of a gait are plain doubles, and `GaitValues` lists them by name for whoever changes
/// them. A gait names cables; `ResolveGait` finds them in a robot, so that one gait plays on a
/// spine of any number of segments.
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

/// Which cables, as in an experiment: those that have all tags of any of these sets. A cable's
/// name is one of its tags.
using CableMatch = std::vector<std::vector<std::string>>;

/// What a gait's signals are, and with that the unit of its amplitudes, offsets and tables.
enum class GaitDrives {
  kVelocity,    ///< V0 of impedance control [m/s].
  kRestLength,  ///< What is added to rest lengths [m].
};

/// offset + amplitude cos(2 pi f t + phase) for some cables (docs/theory/gaits.md, eq. G.1).
struct SineWave {
  std::string name;
  CableMatch cables;
  double amplitude = 0.0;  ///< [m/s], or [m] where rest lengths are driven. May be negative.
  double phase_rad = 0.0;
  double offset = 0.0;  ///< [m/s], or [m].
  /// Added to the phase once for every segment further back: a travelling wave. The cables between
  /// segments i - 1 and i, whose names end in _i, get (i - 1) times this.
  double phase_per_segment_rad = 0.0;
  std::optional<double> frequency_hz;  ///< Its own; the gait's if absent.
  SourceRef at;
};

struct SineGait {
  double frequency_hz = 1.0;
  std::vector<SineWave> waves;
};

/// Which couplings share their weight and phase.
enum class CpgSymmetry {
  /// By the two cables' roles (the name without _i) and which of them is further in front: the
  /// same for all segments, and for the two directions within one joint. 57 groups for six roles.
  kSegments,
  /// NTRT's rule, by positions in `order` (docs/theory/gaits.md, eq. G.9). 57 groups for six roles.
  kIndex,
  kNone,  ///< None do: a group for each coupling.
};

/// Weight and phase of all couplings of one group.
struct CouplingGroup {
  std::string name;  ///< As `FindCouplings` names it: "behind.outer_top.inner_left".
  /// w [1/m], or [1/(m s)] where rest lengths are driven: times the neighbour's amplitude it is a
  /// rate in rad/s.
  double weight = 0.0;
  double phase_rad = 0.0;  ///< phi: theta_j - theta_i that the coupling pulls towards.
  SourceRef at;
};

/// How a cable's tension acts on its oscillator: theta' += gain (T - reference) cos theta.
struct CpgFeedback {
  double gain_rad_per_n_s = 0.0;
  double reference_n = 0.0;
};

/// Phase oscillators with amplitude dynamics, one a cable (paper eq. 4-6).
struct CpgGait {
  double frequency_hz = 1.0;         ///< v of all oscillators.
  double amplitude = 0.05;           ///< R of all oscillators [m/s], or [m]; >= 0.
  double convergence_per_s = 20.0;   ///< a of all oscillators, > 0.
  double integrator_step_s = 0.001;  ///< Longest step of the fourth-order integrator, > 0.
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  std::vector<std::string> order;  ///< Cables by name; empty: all with an actuator, in order.
  CableMatch inverted;             ///< Cables whose signal is the negative of their oscillator's.
  std::optional<CpgFeedback> feedback;
  std::vector<CouplingGroup> groups;  ///< All groups of the robot, in their order.
  SourceRef at;
};

/// Velocities, or what is added to rest lengths, from a table.
struct TableGait {
  std::vector<std::string> cables;        ///< By name; a column each.
  std::vector<double> time_s;             ///< Rising, the first 0.
  std::vector<std::vector<double>> rows;  ///< Per time, for each cable: [m/s], or [m].
  bool linear = false;                    ///< Straight between rows; else each row holds.
  std::optional<double> repeat_from_s;    ///< After the last row go on here; else it holds.
  SourceRef at;
};

/// A neuron: a weight for each of the layer before it, and a constant.
struct Neuron {
  std::string name;
  std::vector<double> weights;
  double bias = 0.0;
  SourceRef at;
};

/// A feed-forward network with one hidden layer; outputs lie within -1..1
/// (docs/theory/gaits.md, eq. G.19). An output that is not listed is 0.
struct NetworkSpec {
  static constexpr std::size_t kMostHidden = 32;
  std::vector<Neuron> hidden;   ///< Weights in the order of the inputs.
  std::vector<Neuron> outputs;  ///< Weights in the order of the hidden neurons.
  SourceRef at;
};

/// The oscillators of some cables, with sensory feedback.
struct FeedbackOscillator {
  std::string name;
  CableMatch cables;
  double amplitude = 0.0;  ///< R [m/s], or [m]; >= 0.
  double phase_rad = 0.0;  ///< At the start.
  double offset = 0.0;     ///< Added to the signal [m/s], or [m].
  SourceRef at;
};

/// Phase oscillators that two networks act on: one, shared by all cables, that hears each cable's
/// length and tension; one, shared by all joints, that hears where the goal is.
struct FeedbackCpgGait {
  double frequency_hz = 1.0;  ///< v of all oscillators at the start.
  double convergence_per_s = 5.0;
  double frequency_gain_hz_per_s = 0.0;
  double amplitude_gain = 0.0;
  double phase_gain_rad_per_s = 0.0;
  double integrator_step_s = 0.01;
  std::vector<FeedbackOscillator> oscillators;  ///< A cable has one at most.
  CpgSymmetry symmetry = CpgSymmetry::kSegments;
  std::vector<CouplingGroup> groups;  ///< Those that are not listed couple nothing.
  /// Hears "stretch" and "tension"; says "frequency", "amplitude" and "phase".
  std::optional<NetworkSpec> cable_network;
  /// Hears "goal_x", "goal_y" and, where it has three inputs, "place"; says
  /// "OSCILLATOR_frequency", ..., for each name of `oscillators`.
  std::optional<NetworkSpec> goal_network;
  SourceRef at;
};

/// Cables whose signals follow from where they are on the way to the goal: a polynomial in `ahead`
/// and `up`, places from the centre of the robot in its radii (docs/theory/gaits.md, eq. G.24). All
/// coefficients are [m/s], or [m]; `ahead2_up` is that of ahead^2 up.
struct TowardGoalGait {
  CableMatch cables;
  double offset = 0.0;
  double ahead = 0.0, up = 0.0;
  double ahead2 = 0.0, ahead_up = 0.0, up2 = 0.0;
  double ahead3 = 0.0, ahead2_up = 0.0, ahead_up2 = 0.0, up3 = 0.0;
  double beat = 0.0;     ///< All but the offset grows and shrinks by this share, in turn,
  double beat_hz = 0.5;  ///< so often; >= 0.
  SourceRef at;
};

/// A gait. Exactly one of the five is present.
struct GaitSpec {
  std::string name;
  std::string description;
  GaitDrives drives = GaitDrives::kVelocity;
  std::optional<SineGait> sine;
  std::optional<CpgGait> cpg;
  std::optional<TableGait> table;
  std::optional<FeedbackCpgGait> feedback_cpg;
  std::optional<TowardGoalGait> toward_goal;
  std::vector<std::string> files;  ///< That were read, the gait first.
};

/// Reads a gait file. Returns nothing if there was any error.
std::optional<GaitSpec> LoadGait(const std::string& path, Diagnostics& out);

/// The gait as YAML. `LoadGait` reads it back to the same bits.
std::string GaitYaml(const GaitSpec& gait);

/// Writes `GaitYaml` to a file. False and a complaint if that fails.
bool SaveGait(const GaitSpec& gait, const std::string& path, Diagnostics& out);

/// In which order NTRT's nodes had the spine's cables: the parameters it learned belong to one.
enum class NtrtCableOrder {
  kPaper2015,  ///< Builder by builder, as when the paper's gait was learned.
  kSince2016,  ///< Pair by pair.
};

/// A gait of NTRT's spines. `path`: a folder with bestParameters-9_node-0.nnw, ..._edge-0.nnw to
/// 56; controlVars.json of the hand-tuned sines; or the .json of a controller with feedback, with
/// the networks that it names where it says. Nothing if there was any error.
std::optional<GaitSpec> ImportNtrtGait(const std::string& path, NtrtCableOrder order,
                                       Diagnostics& out);

/// A CPG for a robot: every group of couplings there, all weights and phases 0. Nothing if there
/// was any error.
std::optional<GaitSpec> NewCpgGait(const RobotSpec& robot, CpgSymmetry symmetry, Diagnostics& out,
                                   GaitDrives drives = GaitDrives::kVelocity);

/// A table as plain text: "time_s,outer_top_1_m_per_s,...", a row a line; "outer_top_1_m" where
/// rest lengths are driven. A gait file's `table: {file: ...}` reads it back to the same bits.
std::string GaitTableText(const TableGait& table, GaitDrives drives = GaitDrives::kVelocity);

/// One number of a gait: "sine.<wave>.amplitude_m_per_s", "cpg.frequency_hz",
/// "cpg.<group>.weight_per_m", "cpg.<group>.phase_rad",
/// "feedback_cpg.goal_network.<neuron>.weights_1", ..._2; "sine.<wave>.amplitude_m",
/// "cpg.<group>.weight_per_m_s" where rest lengths are driven.
struct GaitValue {
  std::string name;
  std::string unit;  ///< "m/s", "m", "rad", "Hz", "1/m", "1/(m s)", "1/s", "N", "rad/(N s)".
  double* value;     ///< Into the gait, as long as that is neither moved nor resized.
  double min, max;   ///< Beyond these the gait makes no sense or repeats itself; may be infinite.
  bool at_start = false;  ///< It says where the gait begins: a change later changes nothing.
};

/// Every number of the gait that shapes the motion; none of a table.
std::vector<GaitValue> GaitValues(GaitSpec& gait);

/// Who is coupled to whom. Oscillator i drives cables[i].
struct CouplingGraph {
  struct Coupling {
    int to = 0, from = 0;  ///< Oscillators: the equation of `to` sees the phase of `from`.
    int group = 0;         ///< Into `groups`.
  };
  std::vector<int> cables;          ///< Per oscillator: index of its cable in the robot.
  std::vector<Coupling> couplings;  ///< By `to`, then `from`.
  std::vector<std::string> groups;  ///< Names.
};

/// One oscillator for each cable of `order` (all cables with an actuator if that is empty), each
/// coupled to every other whose cable is attached to a body that its own is attached to. Nothing if
/// there was any error; `at` is for the messages.
std::optional<CouplingGraph> FindCouplings(const RobotSpec& robot, CpgSymmetry symmetry,
                                           const std::vector<std::string>& order,
                                           const SourceRef& at, Diagnostics& out);

/// A gait whose cables were found in a robot: what a controller plays.
struct ResolvedGait {
  struct Wave {
    int wave = 0;            ///< Into `SineGait::waves`.
    int segments_ahead = 0;  ///< How often it gets `phase_per_segment_rad`.
  };
  std::vector<int> cables;   ///< That it drives, by index.
  std::vector<Wave> waves;   ///< Of a sine: in the order of `cables`.
  CouplingGraph graph;       ///< Of a CPG; its cables are `cables`.
  std::vector<double> sign;  ///< Of a CPG, per oscillator: 1 or -1.
  // Of a CPG with feedback, per oscillator:
  std::vector<int> role;               ///< Into `FeedbackCpgGait::oscillators`.
  std::vector<int> joint;              ///< Cables whose names end in the same number share one.
  std::vector<double> place;           ///< Of each joint: 1 at the front, -1 at the rear.
  std::vector<double> most_tension_n;  ///< That its actuator can pull with.
  // Of one that goes toward a goal, in W as the robot is described:
  struct Strut {
    int body = 0;
    Vec3 along;  ///< Unit vector.
  };
  std::vector<Strut> struts;      ///< Whose directions are sensed; they span all directions.
  std::vector<Vec3> from_center;  ///< Per cable: of its middle, from the centre, in radii.
};

/// Finds the gait's cables in a robot and checks that its groups are the robot's. Nothing if there
/// was any error.
std::optional<ResolvedGait> ResolveGait(const GaitSpec& gait, const RobotSpec& robot,
                                        Diagnostics& out);

}  // namespace taut
