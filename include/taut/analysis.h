/// Statics of tensegrity structures: equilibrium, stiffness, natural frequencies, states of
/// self-stress and infinitesimal mechanisms (docs/theory/statics.md).
///
/// SI units; vectors are in the world frame W. A motion vector has six entries per moving body, in
/// the order of the bodies: three translations of the center of mass [m], then three rotations
/// about the axes of W [rad]. All motions are infinitesimal. Masses enter statics only through
/// weights.
///
/// Errors: for an unsolvable input, functions return the reason in `why`; no assertion fails. The
/// model must be valid for `Model::Compile`. Threads: all functions are pure and thread safe.
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
  /// Allowed residual force on a body, relative to the largest force on any body (at least 1 N).
  double tolerance = 1e-9;
  int most_iterations = 500;  ///< Maximum number of linear solves.
  bool contact = true;        ///< Whether planes of the terrain support bodies.
  /// Initial guess, including rest lengths of cables; by default the described pose.
  std::optional<Pose> from;
};

/// Method that found an equilibrium.
enum class EquilibriumWay { kNewton, kLoadSteps, kRelaxation };

struct Equilibrium {
  bool found = false;
  std::string why;                    ///< Reason, if not found.
  std::vector<std::string> left_out;  ///< Descriptions of ignored parts of the model.
  Pose pose;                          ///< The last iterate if no equilibrium was found.
  /// One per cable; for a cable with friction along its path: the tension of its first span.
  std::vector<double> cable_tension_n;
  std::vector<double> bar_force_n;  ///< One per joint; tension > 0; 0 for joints that are not bars.
  std::vector<JointLoad> joint_loads;  ///< One per joint; for supports: the reactions.
  std::vector<ContactState> contacts;  ///< Loaded contacts; normal forces only.
  /// Largest residual on a body: force, or torque divided by the largest lever arm on the body.
  double residual_n = 0;
  int iterations = 0;
  EquilibriumWay way = EquilibriumWay::kNewton;
};

/// Finds the equilibrium near the described pose under the forces of cables, bars, joint springs,
/// weight, loads and frictionless planes. The equilibrium is stable, unless the search starts at an
/// unstable equilibrium. Newton's method with a trust region minimizes the potential energy. If
/// Newton's method fails, the loads are increased in steps; the last resort is dynamic relaxation.
Equilibrium FindEquilibrium(const ModelDef& def, const LoadCaseSpec& loads = {},
                            const EquilibriumOptions& options = {});

/// Returns `def` with `pose` as its described pose, at rest. `RobotAt` does the same for a
/// `RobotSpec`.
ModelDef ModelAt(const ModelDef& def, const Pose& pose);

/// Unresisted rigid motions of a structure in the described pose, and whether a load case excites
/// them.
struct SupportCheck {
  int free = 0;  ///< Number of rigid motions that no member resists.
  /// Descriptions, for example "the structure can still rotate about z through (0, 0, 1)". There is
  /// one description per part that no member connects to the other parts.
  std::vector<std::string> free_motions;
  /// Error message if the loads act along a free motion or tip over a supported part. Empty if
  /// there is no such load or if ground planes may support the part.
  std::string missing;
  std::string fix;  ///< Hint for `missing`.
};
/// Checks the supports of a structure in the described pose under a load case
/// (docs/theory/statics.md, section 4).
SupportCheck CheckSupports(const ModelDef& def, const LoadCaseSpec& loads);

/// Largest displacement of a node or a center of mass from the described pose to another one.
struct Move {
  /// Fraction of `size_m` above which `Warning` returns a text.
  static constexpr double kFar = 0.25;
  std::string name;  ///< `node "top"` or `body "strut"`; empty if nothing moves.
  double distance_m = 0;
  double size_m = 0;  ///< Diagonal of the bounding box of the described structure.
  /// Returns a warning if `distance_m` exceeds kFar * size_m; else an empty string.
  std::string Warning() const;
};
/// Computes the largest displacement from the described pose to `pose`. For structures without
/// supports, the best-fitting rigid motion is subtracted first; ground contact is not a support
/// here.
Move LargestMove(const ModelDef& def, const Pose& pose);

/// Tangent stiffness and mass matrices in the described pose, for the motion vectors of the moving
/// bodies (docs/theory/statics.md, section 3). Constraints are not eliminated.
struct Tangent {
  std::vector<int> bodies;  ///< Moving bodies; each has six entries in a motion vector.
  /// Negative derivative of the forces with respect to motions [N/m, N, N m/rad], symmetric.
  /// Contributions: taut cables, bars, joint springs, weight, loads, and the constraint forces of
  /// `held`.
  Matrix stiffness;
  Matrix geometric;  ///< Geometric stiffness: part of `stiffness` due to forces; 0 without stress.
  Matrix mass;       ///< Mass matrix [kg, kg m, kg m^2].
  /// Constraints of joints and loaded planes, one orthonormal row each: held * motion = 0.
  Matrix held;
  /// Basis of the motions that forces can resist, one orthonormal column each. The basis excludes
  /// rotations of bodies whose forces all act at the center of mass, and rotations of rods about
  /// their axis.
  Matrix effective;
  int free_turns = 0;                 ///< Number of rotations that `effective` excludes.
  std::vector<int> slack_cables;      ///< Slack cables; they contribute nothing.
  std::vector<std::string> left_out;  ///< Descriptions of ignored parts of the model.
};

/// Computes stiffness and mass in the described pose under `loads`. If the forces are not in
/// equilibrium, `stiffness` is the Hessian of the energy with respect to rotation vectors theta
/// (rotation exp(theta)). This Hessian is symmetric; the Jacobian of forces and moments differs
/// from it by the unbalanced moments in eq. 4 of docs/theory/statics.md.
Tangent FindTangent(const ModelDef& def, const LoadCaseSpec& loads = {});

/// Vibration mode, rigid motion or mechanism.
struct Mode {
  enum class Kind {
    kRigid,      ///< Rigid motion without resistance.
    kMechanism,  ///< Mechanism without stiffness from members or forces.
    kElastic,
    kUnstable,  ///< Negative stiffness; the motion grows.
  };
  Kind kind = Kind::kElastic;
  /// Elastic mode: natural frequency. Unstable mode: -(growth rate [1/s]) / (2 pi). Otherwise 0.
  double frequency_hz = 0;
  double eigenvalue_per_s2 = 0;  ///< (2 pi frequency_hz)^2; negative for unstable modes.
  /// Mode shape, one vector per body of the model; 0 for fixed bodies. The largest displacement of
  /// a body is 1 m, where a rotation counts as its angle times the largest lever arm on the body.
  std::vector<Vec3> translation_m, turn_rad;
};
/// Returns "rigid", "mechanism", "elastic" or "unstable".
const char* NameOf(Mode::Kind kind) noexcept;

struct Modes {
  std::string why;          ///< Reason for the lack of modes.
  std::vector<Mode> modes;  ///< Rigid motions first, then by ascending eigenvalue.
  int rigid = 0, mechanisms = 0, unstable = 0;
  /// Largest magnitude of the eigenvalues that count as zero, and smallest magnitude of the others
  /// [1/s^2]. Rigid motions are excluded. 0: there is no such eigenvalue.
  double largest_dropped = 0, smallest_kept = 0;
};

/// Computes the modes of small undamped vibrations about the described pose: K v = omega^2 M v, in
/// the subspace that joints and loaded planes leave free (docs/theory/statics.md, eq. 15). The
/// described pose should be an equilibrium: apply `ModelAt` to the pose from `FindEquilibrium`.
Modes FindModes(const ModelDef& def, const LoadCaseSpec& loads = {});

/// Member, with a column in the equilibrium matrix. A member is a cable (or a span between points
/// with friction), a bar, one constraint direction of a joint, or a contact point on a plane.
struct StaticMember {
  enum class Kind { kCable, kBar, kHeld, kContact };
  Kind kind = Kind::kCable;
  int index = 0;        ///< Index of the cable, joint or plane.
  int part = 0;         ///< Cable: span; joint: constraint direction; contact: body.
  double length_m = 0;  ///< Length of a cable or bar; otherwise 0.
  /// Force [N] or moment [N m] in the described pose; tension > 0; for contacts the normal force.
  double force_n = 0;
};
/// Returns "cable", "bar", "joint" or "ground".
const char* NameOf(StaticMember::Kind kind) noexcept;

/// State of self-stress: member forces in equilibrium without loads.
struct SelfStress {
  bool feasible = false;                    ///< All cables are in tension and no contact pulls.
  std::vector<double> force_n;              ///< One per member; tension > 0.
  std::vector<double> density_n_per_m;      ///< Force / length of cables and bars; otherwise 0.
  std::vector<double> rod_density_n_per_m;  ///< One per rod of `ClassicalCount`, if it exists.
};

/// Numerical rank of a matrix, with the singular values on both sides of the cutoff.
struct RankGap {
  int rank = 0;
  double smallest_kept = 0, largest_dropped = 0;
  /// Returns whether the two singular values differ by at least a factor of 1000.
  bool clear() const { return largest_dropped * 1e3 <= smallest_kept; }
};

/// Count of states and mechanisms for pin-jointed structures (Pellegrino and Calladine 1986). The
/// count exists only if every moving body is a point or a rod between two points. Rods count as
/// members; each point has three degrees of freedom.
struct ClassicalCount {
  int nodes = 0, members = 0;  ///< Only nodes of moving bodies count.
  RankGap rank;
  int self_stresses = 0, mechanisms = 0, rigid = 0;
  std::vector<int> rods;  ///< Indices of the bodies that count as members.
};

/// States of self-stress and infinitesimal mechanisms of a structure.
struct ForceAnalysis {
  std::vector<StaticMember> members;
  /// Equilibrium matrix: one row per motion of `Tangent::effective`, one column per member; matrix
  /// * member forces = loads. Its transpose maps motions to elongation rates of members. Units: [1]
  /// for translations, [m] for rotations.
  Matrix matrix;
  RankGap rank;
  int unknowns = 0;    ///< Number of rows of `matrix`.
  int free_turns = 0;  ///< Number of excluded rotations, which no force could resist.
  /// Number of rigid motions that no member resists: motions of parts that no member connects to
  /// other parts. These motions move no point at which a member ends in the world.
  int rigid = 0;
  /// Independent states. The first one is feasible if any feasible state exists. Scale: the largest
  /// force density of a cable is 1 N/m.
  std::vector<SelfStress> self_stress;
  std::vector<Mode> mechanisms;  ///< Rigid motions are excluded.
  /// Stiffness [N/m] of the mechanisms under the first feasible self-stress, scaled to a largest
  /// force density of 1 N/m (docs/theory/statics.md, eq. 8). The values are the ascending
  /// eigenvalues of the energy relative to the squared displacements of all points at which forces
  /// act. All values > 0: prestress stability. Empty: no feasible state exists.
  std::vector<double> mechanism_stiffness;
  std::optional<ClassicalCount> classical;
  std::vector<std::string> left_out;  ///< Descriptions of ignored parts of the model.
};

/// Analyzes self-stress and mechanisms in the described pose. With `contact`, contact points on
/// planes are members, too.
ForceAnalysis AnalyseForces(const ModelDef& def, bool contact = true);

/// Returns the least stiffness [N/m] about an equilibrium (`ModelAt` of the pose from
/// `FindEquilibrium`). It is the minimum of u^T K u / (sum of the squared displacements of all
/// points at which members, joints or loads act). The motion u ranges over all free motions except
/// unresisted rigid motions (docs/theory/statics.md, eq. 16). Negative: the equilibrium is
/// unstable. Returns nothing if no such motion exists.
std::optional<double> LeastStiffness(const ModelDef& def, const LoadCaseSpec& loads = {});

}  // namespace taut
