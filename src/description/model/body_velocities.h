/// Initial velocities of bodies from the velocities of placements.
#pragma once

#include <vector>

#include "description/model/build.h"
#include "description/model/welds.h"

namespace taut::description {

/// Bodies of a model and the instances of parts that they belong to.
struct BodyInstances {
  const Assembly& assembly;
  const std::vector<const Weld*>& weld_of_body;
  const std::vector<int>& instance_of_body;    ///< -1: the body's nodes are in several instances.
  const std::vector<int>& bodies_in_instance;  ///< Number of bodies per instance.
};

/// Sets the initial velocities. Each copy moves as one rigid body, with the given velocity of its
/// center of mass and the given angular velocity. Reports bodies that belong to several moving
/// placements.
void SetBodyVelocities(const BodyInstances& in, ModelDef& model, Diagnostics& out);

}  // namespace taut::description
