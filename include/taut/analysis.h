/// Statics of tensegrity structures: equilibrium, stiffness, natural frequencies, states of
/// self-stress and infinitesimal mechanisms (docs/theory/statics.md).
///
/// SI units, W frame. Motions are small motions of the moving bodies, six each, in the bodies'
/// order: three translations of the center of mass [m], then three rotations about W's axes [rad].
/// Statics does not depend on a time step, and on masses only through weights.
///
/// Errors: unsolvable inputs return a reason in `why`, never an assertion; models must be valid for
/// `Model::Compile`. Threads: all functions are pure; any number may run concurrently.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/matrix.h"
#include "taut/model_def.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/statics.h"
#include "taut/world_batch.h"

namespace taut {

struct EquilibriumOptions {
  /// Largest residual force on a body, relative to the largest force on any body (at least 1 N).
  double tolerance = 1e-9;
  int most_iterations = 500;  ///< Limit of linear systems in total.
  bool contact = true;        ///< Whether the terrain's planes support bodies.
  /// Start of the search, with the cables' rest lengths; absent: the described pose.
  std::optional<Pose> from;
};

/// Method that found an equilibrium.
enum class EquilibriumWay { kNewton, kLoadSteps, kRelaxation };

struct Equilibrium {
  bool found = false;
  std::string why;                      ///< Reason, if not found.
  std::vector<std::string> left_out;    ///< Parts of the model that are ignored, in words.
  Pose pose;                            ///< If not found: the last pose of the search.
  std::vector<double> cable_tension_n;  ///< Per cable; if friction divides it, of its first span.
  std::vector<double> bar_force_n;      ///< Per joint; tension > 0; 0 for joints other than bars.
  std::vector<JointLoad> joint_loads;   ///< Per joint; for supports, the reactions.
  std::vector<ContactState> contacts;   ///< Contacts under load, with normal forces only.
  /// Largest residual on a body: force, or torque divided by the body's reach.
  double residual_n = 0;
  int iterations = 0;
  EquilibriumWay way = EquilibriumWay::kNewton;
};

/// Finds the equilibrium near the described pose, under forces of cables, bars, joint springs,
/// weight, loads and frictionless planes. The equilibrium is stable, unless the start already is an
/// unstable one. Method: Newton's method on the potential energy with a trust region; if that
/// fails, loads in steps; dynamic relaxation as the last resort.
Equilibrium FindEquilibrium(const ModelDef& def, const LoadCaseSpec& loads = {},
                            const EquilibriumOptions& options = {});

/// Returns `def` with `pose` as its described pose, at rest; `RobotAt` does the same for the
/// numbers only.
ModelDef ModelAt(const ModelDef& def, const Pose& pose);

/// Free rigid motions of a structure in the described pose, and whether a load case acts along
/// them.
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
/// Checks the supports of a structure in the described pose under a load case
/// (docs/theory/statics.md, section 4).
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
/// Computes the largest displacement from the described pose to `pose`. Structures without supports
/// (ground contact does not count) are compared after subtraction of
/// the best-fitting rigid motion.
Move LargestMove(const ModelDef& def, const Pose& pose);

/// Tangent stiffness and mass matrices in the described pose, over the motions of the moving bodies
/// (docs/theory/statics.md, section 3). Constraints are not eliminated.
struct Tangent {
  std::vector<int> bodies;  ///< Moving bodies, six motions each.
  /// Negative derivative of the forces [N/m, N, N m/rad], symmetric: taut cables, bars, joint
  /// springs, weight, loads, and constraints (`held`) under their forces.
  Matrix stiffness;
  Matrix
      geometric;  ///< Geometric part of `stiffness`, due to forces; 0 in an unstressed structure.
  Matrix mass;    ///< [kg, kg m, kg m^2]
  /// Constraints by joints and bearing planes, one per row: held * motions = 0. Orthonormal rows.
  Matrix held;
  /// Resistible motions, one per orthonormal column. Excluded are rotations of bodies whose forces
  /// all act at the center of mass, and of rods about their axis.
  Matrix effective;
  int free_turns = 0;                 ///< Number of motions that `effective` excludes.
  std::vector<int> slack_cables;      ///< Cables without a contribution.
  std::vector<std::string> left_out;  ///< Parts of the model that are ignored, in words.
};

/// Computes stiffness and mass in the described pose under these loads. If the loads are not in
/// equilibrium, `stiffness` is the Hessian of the energy in rotation vectors theta (rotation
/// exp(theta)). It is symmetric; the Jacobian of forces and moments differs from it by the
/// unbalanced moments in eq. 4 of docs/theory/statics.md.
Tangent FindTangent(const ModelDef& def, const LoadCaseSpec& loads = {});

/// Vibration mode, rigid motion or mechanism.
struct Mode {
  enum class Kind {
    kRigid,      ///< Rigid motion that nothing resists.
    kMechanism,  ///< Mechanism: neither members nor forces resist it.
    kElastic,
    kUnstable,  ///< Negative stiffness: the motion grows.
  };
  Kind kind = Kind::kElastic;
  /// Natural frequency of an elastic mode; of an unstable one minus the growth rate [1/s] / 2 pi;
  /// otherwise 0.
  double frequency_hz = 0;
  double eigenvalue_per_s2 = 0;  ///< (2 pi frequency)^2; negative for unstable modes.
  /// Mode shape, per body of the model; 0 for fixed bodies. The largest translation of any body is
  /// 1 m; rotations count as translations by angle times the body's reach.
  std::vector<Vec3> translation_m, turn_rad;
};
/// Returns "rigid", "mechanism", "elastic" or "unstable".
const char* NameOf(Mode::Kind kind) noexcept;

struct Modes {
  std::string why;          ///< Reason, if there are no modes.
  std::vector<Mode> modes;  ///< Rigid motions first, then by ascending eigenvalue.
  int rigid = 0, mechanisms = 0, unstable = 0;
  /// Largest magnitude of the eigenvalues that count as zero, and smallest magnitude of the others,
  /// both without those of rigid motions [1/s^2]. 0: there is no such eigenvalue.
  double largest_dropped = 0, smallest_kept = 0;
};

/// Computes the modes of small undamped vibrations about the described pose, which should be an
/// equilibrium (`ModelAt` of the pose of `FindEquilibrium`): K v = omega^2 M v in the subspace that
/// joints and bearing planes leave free (docs/theory/statics.md, eq. 15).
Modes FindModes(const ModelDef& def, const LoadCaseSpec& loads = {});

/// Member of the equilibrium matrix: a cable, or its span between places with friction; a bar; a
/// constraint direction of a joint; a contact point on a plane.
struct StaticMember {
  enum class Kind { kCable, kBar, kHeld, kContact };
  Kind kind = Kind::kCable;
  int index = 0;        ///< Index of the cable or joint; of a contact, of the plane.
  int part = 0;         ///< Of a cable: span; of a joint: direction; of a contact: body.
  double length_m = 0;  ///< For cables and bars.
  /// In the described pose: tension > 0; for contacts the normal force. [N] or [N m]
  double force_n = 0;
};
/// Returns "cable", "bar", "joint" or "ground".
const char* NameOf(StaticMember::Kind kind) noexcept;

/// State of self-stress: member forces in equilibrium without loads.
struct SelfStress {
  bool feasible = false;                    ///< All cables in tension, no contact pulls.
  std::vector<double> force_n;              ///< Per member; tension > 0.
  std::vector<double> density_n_per_m;      ///< Force / length for cables and bars; else 0.
  std::vector<double> rod_density_n_per_m;  ///< Per rod of `ClassicalCount`, if present.
};

/// Rank of a matrix, with the singular values next to the cutoff.
struct RankGap {
  int rank = 0;
  double smallest_kept = 0, largest_dropped = 0;
  /// Returns whether the gap is at least a factor of 1000.
  bool clear() const { return largest_dropped * 1e3 <= smallest_kept; }
};

/// Pin-jointed count of the literature (Pellegrino and Calladine 1986). It exists if every moving
/// body is a point or a rod between two points; rods are members, and points have three unknowns.
struct ClassicalCount {
  int nodes = 0, members = 0;  ///< Nodes of moving bodies only.
  RankGap rank;
  int self_stresses = 0, mechanisms = 0, rigid = 0;
  std::vector<int> rods;  ///< Bodies that are members.
};

/// States of self-stress and infinitesimal mechanisms of a structure.
struct ForceAnalysis {
  std::vector<StaticMember> members;
  /// Equilibrium matrix: rows are motions of `Tangent::effective`, columns are members; matrix *
  /// forces = loads. Its transpose maps motions to elongation rates of members [1], [m].
  Matrix matrix;
  RankGap rank;
  int unknowns = 0;    ///< Number of rows: resistible motions.
  int free_turns = 0;  ///< Number of motions that are excluded, because nothing could resist them.
  /// Number of rigid motions that no member resists: rigid-body motions of a part that no member
  /// connects to the others. They move no point of the world at which its members end.
  int rigid = 0;
  /// Independent states, a feasible one first if any exists. Scaled: the largest force density of a
  /// cable is 1 N/m.
  std::vector<SelfStress> self_stress;
  std::vector<Mode> mechanisms;  ///< Without rigid motions.
  /// Stiffness of the mechanisms under the first feasible self-stress (docs/theory/statics.md, eq.
  /// 8): eigenvalues over the squared displacements of all points at which forces act [N/m],
  /// ascending, for a largest force density of 1 N/m. All positive: prestress stability. Empty: no
  /// feasible state.
  std::vector<double> mechanism_stiffness;
  std::optional<ClassicalCount> classical;
  std::vector<std::string> left_out;  ///< Parts of the model that are ignored, in words.
};

/// Analyzes self-stress and mechanisms in the described pose. With `contact`, points that touch
/// planes are members, too.
ForceAnalysis AnalyseForces(const ModelDef& def, bool contact = true);

/// Returns the least stiffness about an equilibrium (`ModelAt` the pose of `FindEquilibrium`): the
/// smallest u^T K u over the sum of the squared displacements of all points at which members,
/// joints or loads act [N/m]. u: all free motions except unresisted rigid motions
/// (docs/theory/statics.md, eq. 16). Negative: the equilibrium is unstable. Returns nothing if
/// there is no such motion.
std::optional<double> LeastStiffness(const ModelDef& def, const LoadCaseSpec& loads = {});

}  // namespace taut
