/// From what a study file says to what is searched.
#pragma once

#include <vector>

#include "description/study/study_keys.h"
#include "taut/study.h"

namespace taut::description {

/// `list` is where the texts stand. `tunables` is null where the experiment could not be read: then
/// names are not checked.
std::vector<StudyParameter> ToParameters(const Value* list, const std::vector<VaryText>& texts,
                                         const std::vector<Tunable>* tunables, const Scope& scope);
std::vector<SearchSpec> ToSearches(const Value* list, const std::vector<SearchText>& texts,
                                   std::size_t dimensions, const Scope& scope);

}  // namespace taut::description
