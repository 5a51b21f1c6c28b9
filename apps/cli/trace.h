/// The commands of `taut trace`, each in its file, and a line in trace.cpp.
#pragma once

#include "commands.h"

namespace taut::cli {

void AddTraceConvert(CLI::App& group, int& exit_code);

}  // namespace taut::cli
