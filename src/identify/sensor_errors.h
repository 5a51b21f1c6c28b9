/// Typical sensor errors that a fit does not estimate, to test whether the data contain them: gains
/// of force sensors and offsets of cameras and force sensors (docs/theory/identification.md, eq.
/// F.15b).
#pragma once

#include <vector>

#include "taut/fit_verdict.h"
#include "taut/identify.h"

namespace taut::identify {

/// Returns the sensor errors with their derivatives of the residuals. `residual`: residuals of the
/// fit, one per point. Omits errors that `spec` estimates for one of their channels. Needs no new
/// trials, since computed values follow from the residuals.
std::vector<FitAlias> SensorErrors(const FitSpec& spec, const std::vector<FitPoint>& points,
                                   const std::vector<double>& residual);

}  // namespace taut::identify
