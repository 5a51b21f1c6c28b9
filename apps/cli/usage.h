/// What is wrong with a command line, in words that name what would have been right.
#pragma once

#include <CLI/CLI.hpp>

namespace taut::cli {

/// The command that was named last: of "taut gait export x" the export.
const CLI::App& NamedCommand(const CLI::App& app);

/// Says on stderr why `app` did not parse. Returns the exit status.
int ExplainUsage(const CLI::App& app, const CLI::ParseError& error);

/// Says that `command` has no command of that name. Returns the exit status.
int NoSuchCommand(const CLI::App& command, const std::string& word);

}  // namespace taut::cli
