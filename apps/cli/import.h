/// The commands of `taut import`, each in its file, and a line in import.cpp.
#pragma once

#include <string>

#include "commands.h"
#include "taut/diagnostics.h"

namespace taut::cli {

void AddImportMjcf(CLI::App& group, int& exit_code);
void AddImportNtrt(CLI::App& group, int& exit_code);

/// Warns of each reason for which `taut check` refuses an imported model, at the imported file.
void WarnOfRefusal(const std::string& model_yaml, const std::string& imported_file,
                   Diagnostics& out);

}  // namespace taut::cli
