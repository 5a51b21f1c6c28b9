/// Which nodes and rods are one rigid body.
#pragma once

#include <vector>

#include "description/model/build.h"

namespace taut::description {

/// What is welded into one body. Rods and beams weld their nodes to themselves, `fixed_to` welds
/// nodes to each other.
struct Weld {
  std::vector<int> nodes, pairs;  ///< `pairs`: its rods and beams.
  bool anchored = false;
  bool has_solid = false;  ///< Or a bar or a cable with mass ends there.
  bool ends_bar = false;
};

/// A rod that turns in a node which goes with another body.
struct Pin {
  int pair, node;
};

struct Welds {
  std::vector<Weld> welds;
  std::vector<Pin> pins;
};

/// A rod or a beam, not a cable, a bar or a joint.
bool IsSolid(const BuilderText& builder);

Welds FindWelds(const ModelText& model, const Assembly& assembly, const Assignment& assignment);

}  // namespace taut::description
