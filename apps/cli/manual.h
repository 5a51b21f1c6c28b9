/// Manual page and shell completions, generated from the same description as help texts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_text.h"

namespace taut::cli {

/// Returns the page taut(1) in roff.
std::string ManPage(const CommandText& taut);

/// Supported shells: "bash", "zsh", "fish".
const std::vector<std::string>& Shells();

/// Returns a script that completes commands, flags, choices, files and folders; nothing for an
/// unknown shell.
std::optional<std::string> Completion(const CommandText& taut, const std::string& shell);

}  // namespace taut::cli
