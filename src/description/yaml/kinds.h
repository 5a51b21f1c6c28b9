/// Kinds of files, with hints for messages.
#pragma once

#include <string>
#include <string_view>

namespace taut::description {

/// Kind of the files that `ResolvedYaml` writes.
inline constexpr const char* kResolvedKind = "resolved_experiment";

/// Returns a hint for a file of an unexpected kind: the command for this kind. For an unknown kind,
/// returns the list of kinds.
std::string HintOfKind(std::string_view kind);

}  // namespace taut::description
