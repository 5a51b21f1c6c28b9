// Command `taut import`: conversion of other programs' robots to taut models.
#include "import.h"

#include <cstdlib>
#include <filesystem>

#include "output.h"
#include "taut/files.h"
#include "taut/spec.h"
#include "taut/start.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

/// A new folder in the system's temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code failed;
    std::string name = (fs::temp_directory_path(failed) / "taut_import_XXXXXX").string();
    if (!failed && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Returns an empty path if the folder could not be created.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

void WarnOfRefusal(const std::string& model_yaml, const std::string& experiment_yaml,
                   const std::string& imported_file, Diagnostics& out) {
  const std::string kind = experiment_yaml.empty() ? "model" : "experiment";
  const auto not_checked = [&](const std::string& why) {
    out.Warning("import.not_checked", {imported_file, 0, 0},
                "cannot check the " + kind + ": " + why, "run `taut check`");
  };
  const TemporaryFolder folder;
  if (folder.path().empty()) return not_checked("no temporary folder");
  const std::string model = folder.path() + "/" + kCheckedModel;
  const std::string path = experiment_yaml.empty() ? model : folder.path() + "/experiment.yaml";
  Diagnostics found;
  if (WriteWholeFile(model, model_yaml, found)) {
    if (experiment_yaml.empty()) {
      if (const auto robot = LoadRobot(path, {}, found)) {
        CheckStart(*robot, StartKind::kAsDescribed, found);
      }
    } else if (WriteWholeFile(path, experiment_yaml, found)) {
      if (const auto experiment = LoadExperiment(path, {}, found)) {
        CheckStart(experiment->robot, experiment->start, found);
      }
    }
  }
  for (const Diagnostic& reason : found.items()) {
    // An error without a line concerns the temporary file itself, not its contents.
    if ((reason.at.file == path || reason.at.file == model) && reason.at.line == 0) {
      not_checked("temporary file: " + reason.what);
      continue;
    }
    out.Warning("import.model_refused", {imported_file, 0, 0},
                "`taut check` refuses the " + kind + ": " + reason.what, reason.hint);
  }
}

void AddImport(CLI::App& app, int& exit_code) {
  CLI::App* group =
      app.add_subcommand("import", "Convert models of other simulators: MuJoCo, NTRT.");
  group->require_subcommand(1);
  AddImportMjcf(*group, exit_code);
  AddImportNtrt(*group, exit_code);
  group->footer(
      "Examples:\n"
      "  taut import mjcf robot.xml --out robot.yaml\n"
      "  taut import ntrt SuperBall.yaml --length_unit_m 0.1 --out superball.yaml\n"
      "Help on a command: `taut import COMMAND --help`\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input.");
}

}  // namespace taut::cli
