// `taut import`: robots of other programs as models of taut.
#include "import.h"

namespace taut::cli {

void AddImport(CLI::App& app, int& exit_code) {
  CLI::App* group = app.add_subcommand("import", "Models of other simulators as models of taut.");
  group->require_subcommand(1);
  AddImportMjcf(*group, exit_code);
  AddImportNtrt(*group, exit_code);
  group->footer(
      "Examples:\n"
      "  taut import mjcf robot.xml --out robot.yaml\n"
      "  taut import ntrt SuperBall.yaml --length_unit_m 0.1 --out superball.yaml\n"
      "`taut import COMMAND --help` tells more.\n"
      "Exit status: 0 good, 1 a file cannot be written, 2 bad usage, 3 bad input.");
}

}  // namespace taut::cli
