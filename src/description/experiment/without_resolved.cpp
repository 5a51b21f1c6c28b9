// Where nothing is recorded, and no run's resolved experiment is read again: in a browser.
#include "description/experiment/resolved.h"

namespace taut::description {

std::optional<ExperimentSpec> ReadResolved(const std::string& path, const Overrides& /*overrides*/,
                                           Diagnostics& out) {
  out.Error({path, 0, 0}, "resolved experiments cannot be read in a browser",
            "the command taut reads them");
  return std::nullopt;
}

}  // namespace taut::description
