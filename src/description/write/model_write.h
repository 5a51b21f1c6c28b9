/// Writing a robot as a model file: what its steps share.
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
  std::string name;  ///< Full.
  Tags tags;
  std::vector<int> nodes;
  std::string line;       ///< Of `pairs:`, once it is known how it is named.
  std::string placement;  ///< Whose pair it is; empty: none's.
  bool turns = false;     ///< A rod of `class_k` that turns in a node of another body.
};
/// What builders of one text go on: indices of nodes or pairs.
struct WrittenBuilder {
  std::string text;
  std::vector<int> on;
};

/// A robot taken apart into what a model file has.
struct WrittenModel {
  std::vector<WrittenNode> nodes;  ///< Those of the robot first, in its order.
  std::vector<WrittenPair> pairs;  ///< Solids first.
  std::size_t solid_pairs = 0;
  std::vector<int> cables;                      ///< Of the robot: the pairs after the solids.
  std::set<int> pins;                           ///< Joints that rods of `class_k` bring along.
  std::vector<std::vector<std::string>> apart;  ///< Bodies, by their names.
  std::vector<WrittenBuilder> on_pairs, on_nodes;
  std::map<std::string, Quat> turns;  ///< Per placement with boxes.
};

/// A box of the terrain that an experiment moves: no part of the robot.
bool IsTerrain(const ModelDef& def, int body);
/// Whether the robot says that the body stands still, and not an experiment that moves it.
bool IsAnchored(const ModelDef& def, int body);

/// The node of the body, or of the world, that is exactly there; -1: none.
int NodeAt(const WrittenModel& model, int body, const Vec3& p);
/// The builder of that text goes on one more.
void Build(std::vector<WrittenBuilder>& list, const std::string& text, int on);

/// How a pair is written: `given` is its `name:`, empty for that of its nodes.
struct PairName {
  std::string placement, given;
};
PairName NameOf(const WrittenModel& model, const WrittenPair& pair);

/// A member's keys, those that say something, with ", " before each.
std::string MemberText(const MemberDef& member);
/// What of the body is half of bars and cables that end on it [kg].
double LumpedOn(const ModelDef& def, int body);

/// Joints, bars, supports and what does not touch each other: the last pairs, and builders. What
/// rods of `class_k` bring along is left out.
void TakeJoints(const RobotSpec& robot, WrittenModel& model, Diagnostics& out);

/// Complains about what a model file cannot say; what comes back is whole if there was nothing.
WrittenModel TakeApart(const RobotSpec& robot, Diagnostics& out);
std::string TextOf(const RobotSpec& robot, WrittenModel model, Diagnostics& out);

/// Complains about the first thing that differs, beyond rounding, between a robot and what was read
/// back of it. `read` may have more nodes. False if there is such a thing.
bool CheckReadBack(const RobotSpec& robot, const RobotSpec& read, Diagnostics& out);

/// The one beginning of all these complaints.
void RefuseModel(Diagnostics& out, const std::string& what, const std::string& hint = {});

/// All that stands before the last dot: the placement that a node belongs to; empty for none.
inline std::string PlacementOf(const std::string& full_name) {
  const std::size_t dot = full_name.rfind('.');
  return dot == full_name.npos ? "" : full_name.substr(0, dot);
}
inline std::string ShortName(const std::string& full_name) {
  return full_name.substr(full_name.rfind('.') + 1);
}

}  // namespace taut::description
