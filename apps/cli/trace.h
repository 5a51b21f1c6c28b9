/// `taut trace`, and what adds a command to it.
#pragma once

#include <CLI/CLI.hpp>

namespace taut::cli {

void AddTrace(CLI::App& app, int& exit_code);

void AddTraceConvert(CLI::App& group, int& exit_code);

}  // namespace taut::cli
