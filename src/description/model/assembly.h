/// Assembly of a model: places all nodes and pairs in W, with full names and all tags. Bodies and
/// cables are built later.
#pragma once

#include <string>
#include <vector>

#include "description/model/model_text.h"

namespace taut::description {

/// Copy of a part. Instance 0 contains the nodes and pairs at the top level of the file.
struct Instance {
  std::string name;  ///< Empty for the top level of the file.
  SourceRef at;
  Quat q_WPart;
  Vec3 velocity_m_per_s, angular_velocity_rad_per_s;
};

struct PlacedNode {
  std::string name;  ///< Full name, such as "segment_0.tip".
  SourceRef at;
  int instance = 0;
  Vec3 position_m;
  Tags tags;
  int fixed_to = -1;
};

struct PlacedPair {
  std::string name;  ///< Full name, such as "outer_top_1" or "segment_0.right-left".
  SourceRef at;
  int instance = -1;  ///< -1: the nodes are in several instances.
  std::vector<int> nodes;
  Tags tags;
  std::vector<RouteText> route = {};  ///< Empty, or one element per node.
};

/// Tags of one node or pair in the file, to check selectors. `copied`: its copies also have a
/// number and the tag first, middle or last.
struct TagsInFile {
  Tags tags;
  bool copied = false;
};

struct Assembly {
  std::vector<Instance> instances;
  std::vector<PlacedNode> nodes;
  std::vector<PlacedPair> pairs;
  std::vector<TagsInFile> node_tags, pair_tags;
  bool complete = true;  ///< False: some nodes or pairs of the file are missing.
};

/// Places all parts. Reports unknown names, duplicate names and models that are too large.
Assembly Assemble(const ModelText& model, Diagnostics& out);

}  // namespace taut::description
