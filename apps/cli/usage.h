/// Error messages for wrong command lines, with the correct alternatives.
#pragma once

#include <CLI/CLI.hpp>

namespace taut::cli {

/// Returns the last named command: for "taut gait export x" the command `export`.
const CLI::App& NamedCommand(const CLI::App& app);

/// Explains on stderr why `app` did not parse. Returns the exit status.
int ExplainUsage(const CLI::App& app, const CLI::ParseError& error);

/// Reports that `command` has no subcommand `word`. Returns the exit status.
int NoSuchCommand(const CLI::App& command, const std::string& word);

}  // namespace taut::cli
