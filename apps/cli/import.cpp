#include "import.h"

namespace taut::cli {

void AddImport(CLI::App& app, int& exit_code) {
  CLI::App* import = app.add_subcommand("import", "Models of other simulators as models of taut.");
  import->require_subcommand(1);
  AddImportNtrt(*import, exit_code);
  import->footer(
      "Example:\n"
      "  taut import ntrt SuperBall.yaml --length_unit_m 0.1 --out superball.yaml\n"
      "Exit status: 0 good, 1 a file cannot be written, 2 bad usage, 3 bad input.");
}

}  // namespace taut::cli
