/// Variants of an experiment as given in Python: values of parameters by name, and a seed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/spec.h"

namespace taut::python {

using GivenVariant =
    std::pair<std::optional<std::uint64_t>, std::vector<std::pair<std::string, double>>>;

/// Applies the values of all variants to the experiment. Reports all errors in `said`, with `what`
/// and the place in the list.
std::vector<RolloutWorld> VariantsOf(const ExperimentSpec& experiment,
                                     const std::vector<GivenVariant>& given,
                                     const std::string& what, Diagnostics& said);

}  // namespace taut::python
