/// From what a study file says to what is searched.
#pragma once

#include <vector>

#include "description/study_keys.h"
#include "taut/study.h"

namespace taut::description {

/// Which tunables patterns stand for. Empty after a complaint.
std::vector<std::size_t> MatchTunables(const Value& value, const std::string& what,
                                       const std::vector<Tunable>& tunables, const Scope& scope);

/// `list` is where the texts stand. `tunables` is null where the experiment could not be read: then
/// names are not checked.
std::vector<StudyParameter> ToParameters(const Value* list, const std::vector<VaryText>& texts,
                                         const std::vector<Tunable>* tunables, const Scope& scope);
std::vector<SearchSpec> ToSearches(const Value* list, const std::vector<SearchText>& texts,
                                   std::size_t dimensions, const Scope& scope);

}  // namespace taut::description
