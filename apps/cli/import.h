/// `taut import` and its subcommands: a file each, and a line in import.cpp.
#pragma once

#include <CLI/CLI.hpp>

namespace taut::cli {

void AddImport(CLI::App& app, int& exit_code);

/// Adds `ntrt` to `import`; when it ran, `exit_code` holds its status.
void AddImportNtrt(CLI::App& import, int& exit_code);

}  // namespace taut::cli
