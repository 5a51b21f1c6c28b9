/// The parts of a study file, each read by one function.
#pragma once

#include <vector>

#include "description/reader.h"
#include "taut/study.h"

namespace taut::description {

/// `tunables` is null where the experiment could not be read: then names are not checked.
std::vector<StudyParameter> ReadVary(const Value* list, const std::vector<Tunable>* tunables,
                                     const Scope& scope);
ObjectiveSpec ReadObjective(const Value& value, double duration_s, const Scope& scope);
PerturbationSpec ReadPerturbation(const Value& value, const Scope& scope);
std::vector<SearchSpec> ReadSearches(const Value* list, std::size_t dimensions, const Scope& scope);

}  // namespace taut::description
