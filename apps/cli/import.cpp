// `taut import`: robots of other programs as models of taut.
#include "import.h"

#include <cstdlib>
#include <filesystem>

#include "output.h"
#include "taut/files.h"
#include "taut/spec.h"
#include "taut/start.h"

namespace taut::cli {

void WarnOfRefusal(const std::string& model_yaml, const std::string& imported_file,
                   Diagnostics& out) {
  std::error_code failed;
  std::string folder =
      (std::filesystem::temp_directory_path(failed) / "taut_import_XXXXXX").string();
  Diagnostics found;
  if (failed || mkdtemp(folder.data()) == nullptr) {
    out.Warning({imported_file, 0, 0}, "cannot check the model: no temporary folder",
                "run `taut check`");
    return;
  }
  const std::string path = folder + "/model.yaml";
  if (WriteWholeFile(path, model_yaml, found)) {
    if (const auto robot = LoadRobot(path, {}, found)) {
      CheckStart(*robot, StartKind::kAsDescribed, found);
    }
  }
  std::filesystem::remove_all(folder, failed);
  for (const Diagnostic& reason : found.items()) {
    out.Warning({imported_file, 0, 0}, "`taut check` refuses the model: " + reason.what,
                reason.hint);
  }
}

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
