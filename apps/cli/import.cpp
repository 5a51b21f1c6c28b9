#include "import.h"

namespace taut::cli {

void AddImport(CLI::App& app, int& exit_code) {
  CLI::App* import = app.add_subcommand("import", "Models of other simulators as model files.");
  import->require_subcommand(1);
  AddImportMjcf(*import, exit_code);
}

}  // namespace taut::cli
