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
  std::string line;       ///< Of `pairs:`, set when its name is known.
  std::string placement;  ///< Placement of the pair; empty: none.
  bool turns = false;     ///< Rod of `class_k` that is pinned to a node of another body.
};
/// Builder text and the indices of its nodes or pairs.
struct WrittenBuilder {
  std::string text;
  std::vector<int> on;
};

/// Robot decomposed into the elements of a model file.
struct WrittenModel {
  std::vector<WrittenNode> nodes;  ///< Nodes of the robot first, in its order.
  std::vector<WrittenPair> pairs;  ///< Solids first.
  std::size_t solid_pairs = 0;
  std::vector<int> cables;                      ///< Robot's cables: the pairs after the solids.
  std::set<int> pins;                           ///< Joints that rods of `class_k` imply.
  std::vector<std::vector<std::string>> apart;  ///< Names of bodies.
  std::vector<WrittenBuilder> on_pairs, on_nodes;
  std::map<std::string, Quat> turns;  ///< Orientation of each placement with boxes.
};

/// Returns whether the body is a terrain box that an experiment moves, not a part of the robot.
bool IsTerrain(const ModelDef& def, int body);
/// Returns whether the body is anchored by the model, as opposed to moved by an experiment.
bool IsAnchored(const ModelDef& def, int body);

/// Returns the node of the body, or of the world, at exactly this point; -1: none.
int NodeAt(const WrittenModel& model, int body, const Vec3& p);
/// Adds an element to the builder with this text.
void Build(std::vector<WrittenBuilder>& list, const std::string& text, int on);

/// Name of a pair in the file: `given` is its `name:`, empty if the name follows from the nodes.
struct PairName {
  std::string placement, given;
};
PairName NameOf(const WrittenModel& model, const WrittenPair& pair);

/// Returns the keys of a member that differ from the default, each after ", ".
std::string MemberText(const MemberDef& member);
/// Returns the share of the body's mass that comes from bars and cables at its nodes [kg].
double LumpedOn(const ModelDef& def, int body);

/// Adds joints, bars, supports and `apart` as the last pairs and builders, without the joints that
/// rods of `class_k` imply.
void TakeJoints(const RobotSpec& robot, WrittenModel& model, Diagnostics& out);

/// Decomposes a robot. Reports features that a model file cannot express; the result is complete if
/// there are none.
WrittenModel TakeApart(const RobotSpec& robot, Diagnostics& out);
std::string TextOf(const RobotSpec& robot, WrittenModel model, Diagnostics& out);

/// Reports the first difference, beyond rounding, between a robot and its copy after reading back,
/// and returns false. `read` may have more nodes.
bool CheckReadBack(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out);

/// Reports an error with the common beginning of all these messages.
void RefuseModel(Diagnostics& out, const std::string& what, const std::string& hint = {});

/// Returns the text before the last dot: the placement of a node; empty for none.
inline std::string PlacementOf(const std::string& full_name) {
  const std::size_t dot = full_name.rfind('.');
  return dot == full_name.npos ? "" : full_name.substr(0, dot);
}
inline std::string ShortName(const std::string& full_name) {
  return full_name.substr(full_name.rfind('.') + 1);
}

}  // namespace taut::description
