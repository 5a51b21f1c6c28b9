#include "export.h"

namespace taut::cli {

void AddExport(CLI::App& app, int& exit_code) {
  CLI::App* export_ = app.add_subcommand("export", "Models for other programs.");
  export_->require_subcommand(1);
  AddExportMjcf(*export_, exit_code);
}

}  // namespace taut::cli
