/// A robot in the words of the literature on tensegrity statics and of the tools that come from it:
/// points, and bars and strings between them (docs/export.md, section 1).
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

/// A point at which members end: where something acts on a body, the ends of its rods, the places
/// that joints hold together as one.
struct PinNode {
  std::string name;
  Vec3 position_m;
  std::array<bool, 3> pinned{};  ///< In x, y, z: anchored bodies, supports, bodies with motions.
  bool on_ground = false;        ///< What a plane of the terrain touches: that pushes on it.
  double mass_kg = 0;  ///< Of the bodies that it belongs to: their mass and centre of mass are
                       ///< kept, their inertia is not.
  Vec3 load_n;         ///< Weight.
  /// What has to act on it besides its load and its members, so that it is at rest: from what pins
  /// it and from the ground. Of other nodes it is what does not balance.
  Vec3 left_n;
};

struct PinMember {
  enum class Kind {
    kRod,     ///< Of a body.
    kBrace,   ///< Of a body, too: what keeps points at their distance that no rod joins.
    kBar,     ///< A joint of the kind distance, elastic or not.
    kString,  ///< A cable between two of its attachments.
  };
  Kind kind = Kind::kRod;
  std::string name;
  int from = 0, to = 0;  ///< Nodes.
  int cluster = 0;
  double length_m = 0;
  double force_n = 0;  ///< Tension > 0.
  double force_density_n_per_m = 0;
  double stiffness_n_per_m = 0;  ///< 0: rigid.
  double rest_length_m = 0;      ///< Of what is rigid its length.
  MemberDef section;             ///< What the model says of it; 0 where it says nothing.
};

/// Members with one force: a cable from end to end, or between places with friction.
struct PinCluster {
  std::string name;
  double length_m = 0, rest_length_m = 0, force_n = 0;
  double stiffness_n_per_m = 0;  ///< 0: rigid.
};

struct PinJointed {
  std::vector<PinNode> nodes;
  std::vector<PinMember> members;  ///< What is no string first.
  int bars = 0;                    ///< How many of them are no strings.
  std::vector<PinCluster> clusters;
  /// What of the model this cannot say, or what does not balance, in words.
  std::vector<std::string> notes;
};

/// The robot as it is described. Strings have the tensions that follow from their rest lengths,
/// elastic bars likewise; other bars those that balance the nodes that are neither pinned nor on
/// the ground best (in least squares; of several that do the smallest forces).
/// A body that is more than one rod becomes a truss that is as rigid as it is: braces, and where
/// its points are on a line or in a plane, further nodes beside that.
/// Without `weight`, or where no node is pinned or on the ground, there are no loads: what falls
/// has no weight for its members.
PinJointed PinJointedOf(const ModelDef& def, bool weight = true);

// As matrices: N (3 x nodes); C (members x nodes: -1 where a member begins, 1 where it ends), of
// members `from` to `to`; S (clusters x members).
Matrix NodeMatrix(const PinJointed& structure);
Matrix Connectivity(const PinJointed& structure, std::size_t from, std::size_t to);
Matrix Clustering(const PinJointed& structure);

}  // namespace taut
