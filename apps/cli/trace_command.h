/// Subcommands of `taut trace`. Each has a file with its name, and a line in trace_command.cpp.
#pragma once

#include "commands.h"

namespace taut::cli {

void AddTraceConvert(CLI::App& group, int& exit_code);

}  // namespace taut::cli
