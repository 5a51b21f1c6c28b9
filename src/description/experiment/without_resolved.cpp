// Stub without resolved experiments, for the browser build, which records no runs.
#include "description/experiment/resolved.h"

namespace taut::description {

std::optional<ExperimentSpec> ReadResolved(const std::string& path, const Value& /*root*/,
                                           const Overrides& /*overrides*/, Diagnostics& out) {
  out.Error("browser.no_resolved_experiments", {path, 0, 0},
            "resolved experiments cannot be read in a browser",
            "use the command-line program taut");
  return std::nullopt;
}

}  // namespace taut::description
