/// Pin-jointed structure of a robot: nodes, bars and strings, as in the literature and the tools of
/// tensegrity statics (docs/export.md, section 1).
///
/// SI units, W frame. Threads: all functions are pure; any number may run at once.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "taut/matrix.h"
#include "taut/model_def.h"

namespace taut {

/// Node, where members end: point of a body at which a force acts, end of a rod, or points that a
/// joint joins into one.
struct PinNode {
  std::string name;
  Vec3 position_m;
  std::array<bool, 3> pinned{};  ///< In x, y, z: on anchored bodies, supports and kinematic bodies.
  bool on_ground = false;        ///< Touches a plane of the terrain, which can push on it.
  /// Share of the bodies to which it belongs: nodes have the mass and center of mass of a body, not
  /// its inertia.
  double mass_kg = 0;
  Vec3 load_n;  ///< Weight.
  /// Force required for equilibrium in addition to loads and members: at pinned nodes and on the
  /// ground the reaction, at other nodes the imbalance.
  Vec3 left_n;
};

struct PinMember {
  enum class Kind {
    kRod,     ///< Of a body.
    kBrace,   ///< Of a body: keeps the distance between two of its points that are not connected by
              ///< a rod.
    kBar,     ///< Joint of kind distance, elastic or not.
    kString,  ///< Cable between two of its attachments.
  };
  Kind kind = Kind::kRod;
  std::string name;
  int from = 0, to = 0;  ///< Node indices.
  int cluster = 0;
  double length_m = 0;
  double force_n = 0;  ///< Tension > 0.
  double force_density_n_per_m = 0;
  double stiffness_n_per_m = 0;  ///< 0: rigid.
  double rest_length_m = 0;      ///< Of a rigid member: its length.
  MemberDef section;             ///< As in the model; 0 where it has no value.
};

/// Cluster: members with one force, such as a cable from end to end or between attachments with
/// friction.
struct PinCluster {
  std::string name;
  double length_m = 0, rest_length_m = 0, force_n = 0;
  double stiffness_n_per_m = 0;  ///< 0: rigid.
};

struct PinJointed {
  std::vector<PinNode> nodes;
  std::vector<PinMember> members;  ///< Strings last.
  int bars = 0;                    ///< Number of members that are not strings.
  std::vector<PinCluster> clusters;
  /// Texts on parts of the model that this structure cannot represent, and on imbalances.
  std::vector<std::string> notes;
};

/// Returns the pin-jointed structure of a robot in its described pose. Forces of strings and
/// elastic bars follow from their rest lengths. The forces of other bars balance the nodes that are
/// neither pinned nor on the ground, in least squares; of several solutions, the one with the
/// smallest forces. A body that is more than one rod becomes an equally rigid truss with braces
/// and, if its points are on a line or in a plane, additional nodes. `weight`: whether weights are
/// loads. Without pinned nodes and nodes on the ground there are no loads either, since the weight
/// of a falling robot does not act on its members.
PinJointed PinJointedOf(const ModelDef& def, bool weight = true);

// Matrices of a structure: N (3 x nodes); C (members x nodes: -1 at a member's start, 1 at its end)
// for members `from` to `to`; S (clusters x members).
/// Returns N: node positions [m], one per column.
Matrix NodeMatrix(const PinJointed& structure);
/// Returns rows `from` (inclusive) to `to` (exclusive) of C.
Matrix Connectivity(const PinJointed& structure, std::size_t from, std::size_t to);
/// Returns S: 1 for the members of a cluster, else 0.
Matrix Clustering(const PinJointed& structure);

}  // namespace taut
