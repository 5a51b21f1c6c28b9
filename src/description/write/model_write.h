/// Serialization of a robot as a model file: types and functions shared by its steps.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::description {

struct WrittenNode {
  std::string name;
  int body = kWorld;
  Vec3 position_m;
  Tags tags;
  int fixed_to = -1;
};
struct WrittenPair {
  std::string name;  ///< Full name.
  Tags tags;
  std::vector<int> nodes;
  std::string line;       ///< Line in `pairs:`; set as soon as the name is known.
  std::string placement;  ///< Name of the placement; empty: none.
  bool turns = false;     ///< Whether it is a `class_k` rod that is pinned to a node of another
                          ///< body.
};
/// Text of a builder, and indices of its nodes or pairs.
struct WrittenBuilder {
  std::string text;
  std::vector<int> on;
};

/// Robot decomposed into the elements of a model file.
struct WrittenModel {
  std::vector<WrittenNode> nodes;  ///< First the nodes of the robot, in its order.
  std::vector<WrittenPair> pairs;  ///< First the solids.
  std::size_t solid_pairs = 0;
  std::vector<int> cables;                      ///< Index of the robot's cable, for each pair after
                                                ///< the solids.
  std::set<int> pins;                           ///< Joints that follow from `class_k` rods.
  std::vector<std::vector<std::string>> apart;  ///< Groups of bodies that do not collide with
                                                ///< each other, by name.
  std::vector<WrittenBuilder> on_pairs, on_nodes;
  std::map<std::string, Quat> turns;  ///< Orientation of each placement that contains boxes.
};

/// Returns whether the body is a terrain box that an experiment moves.
bool IsTerrain(const ModelDef& def, int body);
/// Returns whether the model anchors the body. Bodies that an experiment moves do not count.
bool IsAnchored(const ModelDef& def, int body);

/// Returns the node of the body (or world) at exactly this point; -1 if there is none.
int NodeAt(const WrittenModel& model, int body, const Vec3& p);
/// Adds an element to the builder with this text. Creates the builder if needed.
void Build(std::vector<WrittenBuilder>& list, const std::string& text, int on);

/// Name of a pair in the file. `given` is the key `name`; empty if the name follows from the nodes.
struct PairName {
  std::string placement, given;
};
PairName NameOf(const WrittenModel& model, const WrittenPair& pair);

/// Returns the keys of a member that differ from the default, each preceded by ", ".
std::string MemberText(const MemberDef& member);
/// Returns the mass [kg] that bars and cables at the body's nodes contribute to it.
double LumpedOn(const ModelDef& def, int body);

/// Adds joints, bars, supports and `apart` as the last pairs and builders. Excludes joints that
/// follow from `class_k` rods.
void TakeJoints(const RobotSpec& robot, WrittenModel& model, Diagnostics& out);

/// Decomposes a robot and reports features that a model file cannot express. The result is complete
/// if there are no such features.
WrittenModel TakeApart(const RobotSpec& robot, Diagnostics& out);
std::string TextOf(const RobotSpec& robot, WrittenModel model, Diagnostics& out);

/// Compares a robot with its copy after reading back. Reports the first difference beyond rounding
/// and returns false. `read` may have more nodes.
bool CheckReadBack(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out);

/// Reports an error of this writer. All its messages begin with the same words.
void RefuseModel(Diagnostics& out, const std::string& what, const std::string& hint = {});

/// Returns the text before the last dot, which is the placement of a node; empty if there is none.
inline std::string PlacementOf(const std::string& full_name) {
  const std::size_t dot = full_name.rfind('.');
  return dot == full_name.npos ? "" : full_name.substr(0, dot);
}
inline std::string ShortName(const std::string& full_name) {
  return full_name.substr(full_name.rfind('.') + 1);
}

}  // namespace taut::description
