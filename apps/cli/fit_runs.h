/// Runs of each experiment before and after a fit, for the viewer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/identify.h"

namespace taut::cli {

/// Writes for each experiment the runs `untuned_NAME` and `fitted_NAME` in `folder`. `fitted_NAME`
/// contains a report of both runs if the viewer's pages are installed. The fitted experiments
/// (`fitted_NAME.yaml`) must exist in `folder`. Returns the paths of the reports relative to
/// `folder`, empty without a report; nothing, with an error, if a run cannot be written or was
/// interrupted.
std::optional<std::vector<std::string>> WriteBeforeAndAfter(const Identification& fit,
                                                            const std::string& folder,
                                                            Diagnostics& out);

}  // namespace taut::cli
