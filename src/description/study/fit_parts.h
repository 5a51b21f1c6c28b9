/// From what a fit file says to what is fitted.
#pragma once

#include <vector>

#include "description/study/fit_keys.h"
#include "taut/fit_spec.h"

namespace taut::description {

/// `known`: per experiment, whether it could be read; what is wrong with others is not asked.
std::vector<FitEstimate> ToEstimates(const std::vector<FitEstimateText>& texts,
                                     const std::vector<FitExperiment>& experiments,
                                     const std::vector<bool>& known, const Scope& scope);
/// `of_design`: there is no data for them.
std::vector<FitResidual> ToResiduals(const std::vector<FitResidualText>& texts,
                                     const std::vector<FitExperiment>& experiments,
                                     const std::vector<bool>& known, bool of_design,
                                     const Scope& scope);
std::vector<FitCarried> ToCarried(const std::vector<FitCarriedText>& texts,
                                  const std::vector<FitExperiment>& experiments,
                                  const std::vector<bool>& known, const Scope& scope);
/// Those of `names`, all if it is empty.
std::vector<std::size_t> NamedExperiments(const std::vector<Placed>& names, const char* what,
                                          const std::vector<FitExperiment>& experiments,
                                          const Scope& scope);

}  // namespace taut::description
