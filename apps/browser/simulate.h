/// Run of an experiment from start to end in JavaScript, with its trace in memory (npm package,
/// docs/browser.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::browser {

struct SimulateInputs {
  std::string path;  ///< Path of the experiment file.
  Overrides overrides;
  std::optional<double> duration_s;  ///< Empty: duration of the experiment.
};

struct SimulateResult {
  /// {"good": bool, "found": as FindingsOf} and, if the experiment could run: "experiment",
  /// "simulated_s", "state_hash" (16 hexadecimal digits), "status" (empty if there is no problem),
  /// "max_tension_n": {cable: value}, "channels": [{"name", "unit"}], "rows": count.
  std::string json;
  /// Row by row: the time [s], then one value per channel.
  std::vector<double> rows;
};

/// Runs an experiment as `taut run` does, to the same bits. `good` is false if it could not start
/// or ended with an error.
SimulateResult Simulate(const SimulateInputs& inputs);

}  // namespace taut::browser
