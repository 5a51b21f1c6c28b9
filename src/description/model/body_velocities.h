/// Initial velocities of bodies from the velocities of their placements.
#pragma once

#include <vector>

#include "description/model/build.h"
#include "description/model/welds.h"

namespace taut::description {

/// Bodies of a model by the placements (instances of parts) that they come from.
struct BodyInstances {
  const Assembly& assembly;
  const std::vector<const Weld*>& weld_of_body;
  const std::vector<int>& instance_of_body;    ///< -1: its nodes are in several instances.
  const std::vector<int>& bodies_in_instance;  ///< Number of bodies.
};

/// Sets the initial velocities. A copy moves as one rigid body: the given velocity is at its center
/// of mass, the angular velocity about it. Reports bodies that join moving placements.
void SetBodyVelocities(const BodyInstances& in, ModelDef& model, Diagnostics& out);

}  // namespace taut::description
