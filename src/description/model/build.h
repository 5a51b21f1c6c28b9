/// Builders: construction of bodies, shapes, cables and joints from placed nodes and pairs.
#pragma once

#include <vector>

#include "description/model/assembly.h"
#include "description/model/model_text.h"
#include "taut/spec.h"

namespace taut::description {

/// Builders of each pair and node, as indices into `ModelText::builders`.
struct Assignment {
  std::vector<int> of_pair;               ///< Per pair; -1: no builder.
  std::vector<std::vector<int>> of_node;  ///< Per node: at most one of each kind.
  std::vector<double>
      lump_kg;  ///< Per node [kg]: half the mass of the bars and cables that end there.
};

/// Assigns builders by their selectors. Reports builders that match nothing, two builders for the
/// same pair or node, and pairs without a builder.
Assignment AssignBuilders(const ModelText& model, const Assembly& assembly, Diagnostics& out);

/// Body of each node: an index into `ModelDef::bodies`, or kWorld.
using BodyOfNode = std::vector<int>;

/// Builds the rigid bodies: solids that share nodes form one body. Fills bodies, shapes and nodes
/// of `robot`.
BodyOfNode BuildBodies(const ModelText& model, const Assembly& assembly,
                       const Assignment& assignment, RobotSpec& robot, Diagnostics& out);

void BuildCables(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out);

/// Adds the joints of pairs, the supports of nodes and the pairs of bodies that do not collide
/// (`apart`). Joints of class-k rods come first (`BuildBodies`).
void BuildJoints(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out);

/// Reports bodies that are not connected to the others or to the world by cables or joints.
void CheckConnected(const RobotSpec& robot, Diagnostics& out);

}  // namespace taut::description
