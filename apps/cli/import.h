/// The commands of `taut import`, each in its file, and a line in import.cpp.
#pragma once

#include "commands.h"

namespace taut::cli {

void AddImportMjcf(CLI::App& group, int& exit_code);
void AddImportNtrt(CLI::App& group, int& exit_code);

}  // namespace taut::cli
