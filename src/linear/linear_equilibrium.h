/// Equilibrium of an experiment's robot, the operating point for the linearization.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "linear/linear_tick.h"
#include "taut/state_space.h"

namespace taut::linear {

/// Robot at rest, at a tick of its controllers.
struct Rest {
  std::shared_ptr<const Model> model;
  std::unique_ptr<WorldBatch> batch;  ///< Batch of one world; null if the robot does not come to
                                      ///< rest.
  std::vector<DrivenCable> driven;
  std::vector<double> step_s;  ///< Lengths of the steps in one tick.
  std::string why, hint;
  std::vector<std::string> remarks;
};

/// Finds the equilibrium. If there is none, `batch` is null, and `why` or `out` contain the reason.
Rest FindRest(const ExperimentSpec& experiment, const LinearOptions& options, Diagnostics& out);

}  // namespace taut::linear
