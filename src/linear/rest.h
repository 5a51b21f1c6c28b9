/// Where an experiment's robot comes to rest.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "linear/tick.h"
#include "taut/state_space.h"

namespace taut::linear {

/// A robot at rest at a tick of its controllers.
struct Rest {
  std::shared_ptr<const Model> model;
  std::unique_ptr<Batch> batch;  ///< Of one world; null if it does not come to rest.
  std::vector<DrivenCable> driven;
  std::vector<double> step_s;  ///< Of a tick.
  std::string why, hint;
  std::vector<std::string> remarks;
};

/// Without a batch and with `why`, or with diagnostics, if there is no such rest.
Rest FindRest(const ExperimentSpec& experiment, const LinearOptions& options, Diagnostics& out);

}  // namespace taut::linear
