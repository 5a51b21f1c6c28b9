/// Subcommands of `taut import`. Each has a file of this name, and a line in import_command.cpp.
#pragma once

#include <string>

#include "commands.h"
#include "taut/diagnostics.h"

namespace taut::cli {

void AddImportMjcf(CLI::App& group, int& exit_code);
void AddImportNtrt(CLI::App& group, int& exit_code);

/// Reports, at the imported file, each reason for which `taut check` would refuse the imported
/// model, as a warning.
void WarnOfRefusal(const std::string& model_yaml, const std::string& imported_file,
                   Diagnostics& out);

}  // namespace taut::cli
