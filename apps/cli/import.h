/// Subcommands of `taut import`. Each has a file with its name, and a line in import_command.cpp.
#pragma once

#include <string>

#include "commands.h"
#include "taut/diagnostics.h"

namespace taut::cli {

void AddImportMjcf(CLI::App& group, int& exit_code);
void AddImportNtrt(CLI::App& group, int& exit_code);

/// File name of the model to which the experiment of `WarnOfRefusal` refers.
inline constexpr const char* kCheckedModel = "model.yaml";
/// Checks the imported model, and the experiment if its text is not empty, as `taut check` does.
/// Reports each error as a warning at the imported file.
void WarnOfRefusal(const std::string& model_yaml, const std::string& experiment_yaml,
                   const std::string& imported_file, Diagnostics& out);

}  // namespace taut::cli
