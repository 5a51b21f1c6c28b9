/// Kinds of files, for hints in messages.
#pragma once

#include <string>
#include <string_view>

namespace taut::description {

/// Kind of a file in which `ResolvedYaml` recorded an experiment.
inline constexpr const char* kResolvedKind = "resolved_experiment";

/// Returns a hint for a file of an unexpected kind: the command that reads files of this kind, or,
/// for an unknown kind, the list of kinds.
std::string HintOfKind(std::string_view kind);

}  // namespace taut::description
