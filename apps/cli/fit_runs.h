/// What a fit leaves to look at: each experiment before and after.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/identify.h"

namespace taut::cli {

/// For each experiment of a fit, whose fitted ones (`fitted_NAME.yaml`) are in `folder` already,
/// the folders `untuned_NAME` and `fitted_NAME` there, as runs, and in the latter a report of both
/// where the viewer's pages are there to make it. The paths of these reports from `folder`, empty
/// without one; nothing and a complaint if a run cannot be written or was interrupted.
std::optional<std::vector<std::string>> WriteBeforeAndAfter(const Identification& fit,
                                                            const std::string& folder,
                                                            Diagnostics& out);

}  // namespace taut::cli
