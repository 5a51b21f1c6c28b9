/// From placed nodes and pairs to bodies, shapes and cables.
#pragma once

#include <vector>

#include "description/model/assembly.h"
#include "description/model/model_text.h"
#include "taut/spec.h"

namespace taut::description {

/// Which builder makes what. Indices into `ModelText::builders`.
struct Assignment {
  std::vector<int> of_pair;               ///< Per pair; -1: none.
  std::vector<std::vector<int>> of_node;  ///< Per node: at most one of each kind.
  std::vector<double>
      lump_kg;  ///< Per node: half of what the bars and cables that end there weigh.
};

/// Complains about builders that match nothing, about two for the same, about pairs without one.
Assignment AssignBuilders(const ModelText& model, const Assembly& assembly, Diagnostics& out);

/// Which body a node belongs to, per node: an index into `ModelDef::bodies`, or kWorld.
using BodyOfNode = std::vector<int>;

/// What shares nodes becomes one rigid body; fills bodies, shapes and nodes of `robot`.
BodyOfNode BuildBodies(const ModelText& model, const Assembly& assembly,
                       const Assignment& assignment, RobotSpec& robot, Diagnostics& out);

void BuildCables(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out);

/// Joints of pairs and supports of nodes, behind those of rods that turn in their nodes
/// (BuildBodies); and what is kept apart.
void BuildJoints(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out);

/// Complains about bodies that no chain of cables and joints joins to the others or to the world.
void CheckConnected(const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::description
