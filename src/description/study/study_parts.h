/// Conversion of the contents of a study file to the study.
#pragma once

#include <vector>

#include "description/study/study_keys.h"
#include "taut/study.h"

namespace taut::description {

/// Converts parameters. `list`: value with the entries. `tunables`: null if the experiment could
/// not be read; then names are not checked.
std::vector<StudyParameter> ToParameters(const Value* list, const std::vector<VaryText>& texts,
                                         const std::vector<Tunable>* tunables, const Scope& scope);
std::vector<SearchSpec> ToSearches(const Value* list, const std::vector<SearchText>& texts,
                                   std::size_t dimensions, const Scope& scope);

}  // namespace taut::description
