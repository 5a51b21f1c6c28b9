/// Subcommands of `taut`: each parses its arguments, calls the library, prints, and returns the
/// exit status.
#pragma once

#include <CLI/CLI.hpp>

namespace taut::cli {

/// Exit statuses, the same for every subcommand (docs/cli.md).
enum Exit : int {
  kOk = 0,
  kFailed = 1,    ///< The command ran and the result is negative, or it could not finish.
  kUsage = 2,     ///< The command line is wrong.
  kBadInput = 3,  ///< A file has errors, all of which were printed.
  kInterrupted = 130,
};

/// Each function adds one subcommand to `app`; after it has run, `exit_code` holds its status.
void AddAnalyze(CLI::App& app, int& exit_code);
void AddCheck(CLI::App& app, int& exit_code);
void AddRun(CLI::App& app, int& exit_code);
void AddCompare(CLI::App& app, int& exit_code);
void AddExport(CLI::App& app, int& exit_code);
void AddFit(CLI::App& app, int& exit_code);
void AddGait(CLI::App& app, int& exit_code);
void AddHelp(CLI::App& app, int& exit_code);
void AddImport(CLI::App& app, int& exit_code);
void AddLearn(CLI::App& app, int& exit_code);
void AddList(CLI::App& app, int& exit_code);
void AddNew(CLI::App& app, int& exit_code);
void AddPlot(CLI::App& app, int& exit_code);
void AddReport(CLI::App& app, int& exit_code);
void AddRobot(CLI::App& app, int& exit_code);
void AddSchema(CLI::App& app, int& exit_code);
void AddSize(CLI::App& app, int& exit_code);
void AddTrace(CLI::App& app, int& exit_code);
void AddView(CLI::App& app, int& exit_code);

}  // namespace taut::cli
