/// Conversion of the contents of a fit file to the fit.
#pragma once

#include <vector>

#include "description/study/fit_keys.h"
#include "taut/fit_spec.h"

namespace taut::description {

/// Converts estimates. `known`: per experiment, whether it could be read; otherwise its names are
/// not checked.
std::vector<FitEstimate> ToEstimates(const std::vector<FitEstimateText>& texts,
                                     const std::vector<FitExperiment>& experiments,
                                     const std::vector<bool>& known, const Scope& scope);
/// Converts residuals. `of_design`: for experimental design, without data.
std::vector<FitResidual> ToResiduals(const std::vector<FitResidualText>& texts,
                                     const std::vector<FitExperiment>& experiments,
                                     const std::vector<bool>& known, bool of_design,
                                     const Scope& scope);
std::vector<FitCarried> ToCarried(const std::vector<FitCarriedText>& texts,
                                  const std::vector<FitExperiment>& experiments,
                                  const std::vector<bool>& known, const Scope& scope);
/// Returns the experiments with these names; all if `names` is empty.
std::vector<std::size_t> NamedExperiments(const std::vector<Placed>& names, const char* what,
                                          const std::vector<FitExperiment>& experiments,
                                          const Scope& scope);

}  // namespace taut::description
