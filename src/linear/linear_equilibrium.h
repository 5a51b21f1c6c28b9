/// State of rest of an experiment's robot, the operating point for linearization.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "linear/linear_tick.h"
#include "taut/state_space.h"

namespace taut::linear {

/// Robot at rest at a tick of its controllers.
struct Rest {
  std::shared_ptr<const Model> model;
  std::unique_ptr<WorldBatch> batch;  ///< Of one world; null if it does not come to rest.
  std::vector<DrivenCable> driven;
  std::vector<double> step_s;  ///< Steps of a tick.
  std::string why, hint;
  std::vector<std::string> remarks;
};

/// Returns the state of rest; if there is none, no batch, and `why` or diagnostics.
Rest FindRest(const ExperimentSpec& experiment, const LinearOptions& options, Diagnostics& out);

}  // namespace taut::linear
