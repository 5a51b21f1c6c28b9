/// The kinds of files that there are.
#pragma once

#include <string>
#include <string_view>

namespace taut::description {

/// Kind of a file in which `ResolvedYaml` recorded an experiment.
inline constexpr const char* kResolvedKind = "resolved_experiment";

/// What to do with a file that says it is of this kind, where another was wanted; of a word that is
/// no kind, which kinds there are.
std::string HintOfKind(std::string_view kind);

}  // namespace taut::description
