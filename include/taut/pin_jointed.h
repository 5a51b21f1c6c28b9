/// Pin-jointed structure of a robot: nodes, bars and strings, as in the literature and tools of
/// tensegrity statics (docs/export.md, section 1).
///
/// SI units, world frame W. Threads: all functions are pure and thread safe.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "taut/matrix.h"
#include "taut/model_def.h"

namespace taut {

/// Node at which members end: an end of a rod, a point of a body at which a force acts, or several
/// points that a joint unites.
struct PinNode {
  std::string name;
  Vec3 position_m;
  /// Fixed in x, y, z: on anchored or kinematic bodies and at supports.
  std::array<bool, 3> pinned{};
  bool on_ground = false;  ///< Touches a plane of the terrain, which may push it.
  /// Share of the masses of its bodies. The nodes reproduce mass and center of mass of a body, but
  /// not its inertia.
  double mass_kg = 0;
  Vec3 load_n;  ///< Weight of `mass_kg`, in W.
  /// Force that balances loads and members: the reaction at pinned nodes and on the ground, the
  /// residual at other nodes.
  Vec3 left_n;
};

struct PinMember {
  enum class Kind {
    kRod,     ///< Rod of a body.
    kBrace,   ///< Fixed distance between two points of a body without a rod between them.
    kBar,     ///< Joint of kind distance, elastic or rigid.
    kString,  ///< Segment of a cable between two attachments.
  };
  Kind kind = Kind::kRod;
  std::string name;
  int from = 0, to = 0;  ///< Node indices.
  int cluster = 0;
  double length_m = 0;
  double force_n = 0;  ///< Axial force; tension > 0.
  double force_density_n_per_m = 0;
  double stiffness_n_per_m = 0;  ///< Axial stiffness; 0: rigid.
  double rest_length_m = 0;      ///< For a rigid member: its length.
  MemberDef section;             ///< Section in the model; unknown values are 0.
};

/// Cluster: members with equal force, such as all segments of a cable, or those between attachments
/// with friction.
struct PinCluster {
  std::string name;
  double length_m = 0, rest_length_m = 0, force_n = 0;
  double stiffness_n_per_m = 0;  ///< Axial stiffness; 0: rigid.
};

struct PinJointed {
  std::vector<PinNode> nodes;
  std::vector<PinMember> members;  ///< Strings are last.
  int bars = 0;                    ///< Number of members that are not strings.
  std::vector<PinCluster> clusters;
  /// Descriptions of parts of the model that this structure cannot represent, and of residuals.
  std::vector<std::string> notes;
};

/// Returns the pin-jointed structure of a robot in its described pose. Rest lengths determine the
/// forces of strings and elastic bars. The forces of other bars balance the nodes that are neither
/// pinned nor on the ground, in the least-squares sense; of several solutions, the one with the
/// smallest forces is taken. A body with more than one rod becomes an equally rigid truss with
/// braces. The truss has additional nodes if the points of the body are on a line or in a plane.
/// `weight`: whether weights are loads. Without pinned nodes and nodes on the ground, weights are
/// ignored, since the weight of a falling robot does not stress its members.
PinJointed PinJointedOf(const ModelDef& def, bool weight = true);

// Matrices of a structure: N (3 x nodes); C (members x nodes) with -1 at the start and 1 at the end
// of a member; S (clusters x members).
/// Returns N: node positions [m], one per column.
Matrix NodeMatrix(const PinJointed& structure);
/// Returns the rows of C from `from` (inclusive) to `to` (exclusive).
Matrix Connectivity(const PinJointed& structure, std::size_t from, std::size_t to);
/// Returns S, with 1 for the members of a cluster, otherwise 0.
Matrix Clustering(const PinJointed& structure);

}  // namespace taut
