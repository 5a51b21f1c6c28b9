/// Subcommands of `taut export`. Each has a file with its name, and a line in export.cpp.
#pragma once

#include "commands.h"

namespace taut::cli {

void AddExportMjcf(CLI::App& group, int& exit_code);
void AddExportShape(CLI::App& group, int& exit_code);
void AddExportStructure(CLI::App& group, int& exit_code);

}  // namespace taut::cli
