/// `taut export`, and what adds a command to it.
#pragma once

#include <CLI/CLI.hpp>

namespace taut::cli {

void AddExport(CLI::App& app, int& exit_code);

void AddExportShape(CLI::App& group, int& exit_code);
void AddExportStructure(CLI::App& group, int& exit_code);

}  // namespace taut::cli
