/// What holds a structure up: its static equilibrium, its stiffness there, its modes, and what its
/// members can carry by themselves (docs/theory/statics.md).
///
/// SI units, W frame. Motions are those of the bodies that move, six each, in their order: three
/// translations of the centre of mass [m], then three small turns about W's axes [rad]. Neither
/// masses nor a step matter to statics: masses are there as weights only.
///
/// Inputs that have no answer are answered with `why`, never asserted; models must be such that
/// `Model::Compile` takes them. Threads: all functions are pure; any number may run at once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/batch.h"
#include "taut/matrix.h"
#include "taut/model_def.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/statics.h"

namespace taut {

struct EquilibriumOptions {
  /// What a body may have left, as a share of the largest force on any (of 1 N, if that is less).
  double tolerance = 1e-9;
  int most_iterations = 500;  ///< Linear systems, all together.
  bool contact = true;        ///< Whether the terrain's planes bear what stands on them.
  /// Where to begin, and the cables' rest lengths there; nothing: as described.
  std::optional<Pose> from;
};

/// How an equilibrium was found.
enum class EquilibriumWay { kNewton, kLoadSteps, kRelaxation };

struct Equilibrium {
  bool found = false;
  std::string why;                      ///< If not.
  std::vector<std::string> left_out;    ///< What of the model takes no part, in words.
  Pose pose;                            ///< The last that was looked at, if it was not found.
  std::vector<double> cable_tension_n;  ///< Per cable; where friction parts it, of its first span.
  std::vector<double> bar_force_n;      ///< Per joint; tension > 0; 0 of joints that are no bars.
  std::vector<JointLoad> joint_loads;   ///< Per joint; of supports, what holds the robot there.
  std::vector<ContactState> contacts;   ///< That bear something; normal forces alone.
  double residual_n = 0;                ///< The largest force that is left on a body; torques by
                                        ///< the body's reach.
  int iterations = 0;
  EquilibriumWay way = EquilibriumWay::kNewton;
};

/// The pose near the one that is described in which all forces balance: cables, bars, springs of
/// joints, weight, loads, and planes that push and have no friction. Of several it is a stable one,
/// but for a start that is in equilibrium already. By Newton's method on the potential energy with
/// a trust region, loads in steps where that fails, and dynamic relaxation at last.
Equilibrium FindEquilibrium(const ModelDef& def, const LoadCaseSpec& loads = {},
                            const EquilibriumOptions& options = {});

/// `def` as it is described in a pose, at rest; `RobotAt` for the numbers alone.
ModelDef ModelAt(const ModelDef& def, const Pose& pose);

/// Free rigid motions of a structure as described, and whether a load case acts along them.
struct SupportCheck {
  int free = 0;  ///< Number of rigid motions that no member resists.
  /// Descriptions: "the structure can still rotate about z through (0, 0, 1)"; one per part that no
  /// member connects to the others.
  std::vector<std::string> free_motions;
  /// Error message if the loads act along a free motion or topple a held part; empty otherwise, and
  /// if ground planes may support the part.
  std::string missing;
  std::string fix;  ///< Hint for `missing`.
};
SupportCheck CheckSupports(const ModelDef& def, const LoadCaseSpec& loads);

/// Largest displacement of a node or a center of mass from the described pose to another one.
struct Move {
  static constexpr double kFar = 0.25;  ///< Warning threshold, as a share of `size_m`.
  std::string name;                     ///< `node "top"` or `body "strut"`; empty if none moves.
  double distance_m = 0;
  double size_m = 0;  ///< Diagonal of the bounding box of the described structure.
  /// Returns a warning if `distance_m` exceeds kFar * size_m; else an empty string.
  std::string Warning() const;
};
/// Structures without supports (ground contact does not count) are compared after subtraction of
/// the best-fitting rigid motion.
Move LargestMove(const ModelDef& def, const Pose& pose);

/// Stiffness and mass as described, in the motions of the bodies that move (docs/theory/statics.md,
/// section 3). What is held is not eliminated.
struct Tangent {
  std::vector<int> bodies;  ///< Six motions each.
  /// The negative derivative of the forces [N/m, N, N m/rad], symmetric: of cables that are taut,
  /// bars, springs of joints, weight, loads, and of what holds (`held`) under its forces.
  Matrix stiffness;
  Matrix geometric;  ///< The part of it that forces make: zero where nothing is under tension.
  Matrix mass;       ///< [kg, kg m, kg m^2]
  /// A row a direction that joints and bearing planes hold: held * motions = 0. Orthonormal.
  Matrix held;
  /// A column a motion that something can resist: orthonormal. Left out are turns of bodies that
  /// all hangs on the centre of mass of, and of rods about their axis.
  Matrix effective;
  int free_turns = 0;                 ///< How many motions `effective` leaves out.
  std::vector<int> slack_cables;      ///< Which contribute nothing.
  std::vector<std::string> left_out;  ///< What of the model takes no part, in words.
};

/// As described, under these loads. Where they do not balance it is the second derivative of the
/// energy with turns as exp(theta), which the forces' is but for half of what is left.
Tangent FindTangent(const ModelDef& def, const LoadCaseSpec& loads = {});

/// One way to vibrate, or to move without force.
struct Mode {
  enum class Kind {
    kRigid,      ///< As a whole: nothing resists it.
    kMechanism,  ///< Members let it be, and forces do not stiffen it.
    kElastic,
    kUnstable,  ///< It runs away.
  };
  Kind kind = Kind::kElastic;
  double frequency_hz = 0;  ///< Of elastic ones; of unstable ones how fast they grow, less than
                            ///< zero [1/s] / 2 pi; else 0.
  double eigenvalue_per_s2 = 0;  ///< (2 pi frequency)^2.
  /// Per body of the model, 0 of those that stand still. Scaled so that the largest translation of
  /// any is 1 m; a turn by its reach counts as one.
  std::vector<Vec3> translation_m, turn_rad;
};
/// "rigid", "mechanism", "elastic" or "unstable".
const char* NameOf(Mode::Kind kind) noexcept;

struct Modes {
  std::string why;          ///< If there are none: what is wrong.
  std::vector<Mode> modes;  ///< Rigid ones first, then by their eigenvalue, ascending.
  int rigid = 0, mechanisms = 0, unstable = 0;
  /// The largest eigenvalue that counts as zero and the least that does not, of those that are not
  /// rigid [1/s^2]; 0 if there are none.
  double largest_dropped = 0, smallest_kept = 0;
};

/// Small undamped vibrations about what is described, which should be an equilibrium (`ModelAt`
/// what `FindEquilibrium` gives): K v = omega^2 M v in what joints and bearing planes leave free.
Modes FindModes(const ModelDef& def, const LoadCaseSpec& loads = {});

/// What can carry a force: a span of a cable between places with friction (or all of it), a bar, a
/// direction that a joint holds, a point that touches a plane.
struct StaticMember {
  enum class Kind { kCable, kBar, kHeld, kContact };
  Kind kind = Kind::kCable;
  int index = 0;  ///< Of the cable; of the joint; of a contact the plane.
  int part = 0;   ///< Of a cable the span, of a joint which of its directions, of a contact the
                  ///< body.
  double length_m = 0;  ///< Of cables and bars.
  double force_n = 0;  ///< As described: tension > 0; of contacts, how hard it pushes. [N] or [N m]
};
/// "cable", "bar", "joint" or "ground".
const char* NameOf(StaticMember::Kind kind) noexcept;

/// Forces that members have among themselves, without loads.
struct SelfStress {
  bool feasible = false;                    ///< All cables in tension, no contact that pulls.
  std::vector<double> force_n;              ///< Per member; tension > 0.
  std::vector<double> density_n_per_m;      ///< Force by length, of cables and bars; else 0.
  std::vector<double> rod_density_n_per_m;  ///< Per rod of `ClassicalCount`, if there is one.
};

/// How surely a rank is known: singular values next to where it is cut.
struct RankGap {
  int rank = 0;
  double smallest_kept = 0, largest_dropped = 0;
  /// Whether they are a thousandfold apart.
  bool clear() const { return largest_dropped * 1e3 <= smallest_kept; }
};

/// The same in the words of the literature, where it has words for it: every moving body is a point
/// or a rod between two points, which counts as a member; three unknowns a point.
struct ClassicalCount {
  int nodes = 0, members = 0;  ///< Nodes of what moves.
  RankGap rank;
  int self_stresses = 0, mechanisms = 0, rigid = 0;
  std::vector<int> rods;  ///< Bodies that count as members.
};

/// What a structure carries by itself, and how it can move without any member changing its length.
struct ForceAnalysis {
  std::vector<StaticMember> members;
  /// A row a motion of `Tangent::effective`, a column a member: matrix * forces = loads; its
  /// transpose says how fast members get longer [1], [m].
  Matrix matrix;
  RankGap rank;
  int unknowns = 0;    ///< Motions that count,
  int free_turns = 0;  ///< and those that are left out because nothing could resist them.
  /// Number of rigid motions that no member resists: rigid-body motions of a part that no member
  /// connects to the others. They move no point of the world at which its members end.
  int rigid = 0;
  /// Independent; a feasible one first, if there is any: densities of a cable up to 1 N/m.
  std::vector<SelfStress> self_stress;
  std::vector<Mode> mechanisms;  ///< Without rigid motions.
  /// What the first feasible self-stress gives mechanisms to resist with, as an eigenvalue over the
  /// squared displacements of all points at which something acts [N/m], ascending: in units of the
  /// largest density of a cable. All positive: it is stable by prestress. Empty: no feasible state.
  std::vector<double> mechanism_stiffness;
  std::optional<ClassicalCount> classical;
  std::vector<std::string> left_out;  ///< What of the model takes no part, in words.
};

/// As described. Points that touch planes are members, too, if `contact`.
ForceAnalysis AnalyseForces(const ModelDef& def, bool contact = true);

/// Returns the least stiffness about an equilibrium (`ModelAt` the pose of `FindEquilibrium`): the
/// smallest u^T K u over the sum of the squared displacements of all points at which members,
/// joints or loads act [N/m]. u: all free motions except unresisted rigid motions
/// (docs/theory/statics.md, eq. 16). Negative: the equilibrium is unstable. Nothing without such a
/// motion.
std::optional<double> LeastStiffness(const ModelDef& def, const LoadCaseSpec& loads = {});

}  // namespace taut
