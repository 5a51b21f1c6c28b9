/// Welds: groups of nodes and rods that form one rigid body.
#pragma once

#include <vector>

#include "description/model/build.h"

namespace taut::description {

/// Nodes and solids of one rigid body. Rods and beams are welded to their nodes; `fixed_to` welds
/// nodes to each other.
struct Weld {
  std::vector<int> nodes, pairs;  ///< `pairs`: rods and beams of the body.
  bool anchored = false;
  bool has_solid = false;  ///< Whether it contains a solid, or lumped mass of a bar or cable.
  bool ends_bar = false;
};

/// Rod connected by a ball joint to a node of another body.
struct Pin {
  int pair, node;
};

struct Welds {
  std::vector<Weld> welds;
  std::vector<Pin> pins;
};

/// Returns whether a builder of pairs makes a rod or a beam (not a cable, bar or joint).
bool IsSolid(const BuilderText& builder);

Welds FindWelds(const ModelText& model, const Assembly& assembly, const Assignment& assignment);

}  // namespace taut::description
