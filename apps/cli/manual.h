/// The page of the manual and the completions of shells, made of the same table as help texts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command_text.h"

namespace taut::cli {

/// taut(1), for man.
std::string ManPage(const CommandText& taut);

/// "bash", "zsh", "fish".
const std::vector<std::string>& Shells();

/// What completes commands, flags, choices, files and folders. Nothing: an unknown shell.
std::optional<std::string> Completion(const CommandText& taut, const std::string& shell);

}  // namespace taut::cli
