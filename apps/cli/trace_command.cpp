// Command `taut trace`: tools for recordings.
#include "trace_command.h"

namespace taut::cli {

void AddTrace(CLI::App& app, int& exit_code) {
  CLI::App* group =
      app.add_subcommand("trace", "Convert recordings for other programs: CSV, MCAP.");
  group->require_subcommand(1);
  AddTraceConvert(*group, exit_code);
  group->footer(
      "Examples:\n"
      "  taut trace convert runs/push_20n --out push_20n.mcap\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input, 130 "
      "interrupted.");
}

}  // namespace taut::cli
