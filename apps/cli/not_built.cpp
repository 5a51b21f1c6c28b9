// Stubs of commands that the target taut_first lacks: each prints how to build the command.
#include <fmt/format.h>

#include <string>

#include "commands.h"
#include "view_statics.h"

namespace taut::cli {
namespace {

void AddNotBuilt(CLI::App& app, const char* name, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand(name, "Not built yet (to build it, run script/build release taut).");
  command->allow_extras();
  command->prefix_command();
  command->callback([name, &exit_code] {
    fmt::print(
        stderr,
        "error: `taut {}` is not built yet (to build all commands, run script/build release taut "
        "in taut's source folder)\n",
        name);
    exit_code = kFailed;
  });
}

}  // namespace

void AddAnalyze(CLI::App& app, int& exit_code) { AddNotBuilt(app, "analyze", exit_code); }
void AddCompare(CLI::App& app, int& exit_code) { AddNotBuilt(app, "compare", exit_code); }
void AddExport(CLI::App& app, int& exit_code) { AddNotBuilt(app, "export", exit_code); }
void AddFit(CLI::App& app, int& exit_code) { AddNotBuilt(app, "fit", exit_code); }
void AddImport(CLI::App& app, int& exit_code) { AddNotBuilt(app, "import", exit_code); }
void AddLearn(CLI::App& app, int& exit_code) { AddNotBuilt(app, "learn", exit_code); }
void AddPlot(CLI::App& app, int& exit_code) { AddNotBuilt(app, "plot", exit_code); }
void AddRobot(CLI::App& app, int& exit_code) { AddNotBuilt(app, "robot", exit_code); }
void AddSize(CLI::App& app, int& exit_code) { AddNotBuilt(app, "size", exit_code); }
void AddTrace(CLI::App& app, int& exit_code) { AddNotBuilt(app, "trace", exit_code); }

viewer::Json ViewStatics(const ExperimentSpec&) {
  return {{"found", false},
          {"reason", "the analysis is not built yet (run script/build release taut)"},
          {"self_stress_states", 0},
          {"feasible", false},
          {"mechanisms", 0},
          {"rigid_motions", 0},
          {"cable_tension_n", viewer::Json::array()},
          {"modes", viewer::Json::array()}};
}

}  // namespace taut::cli
