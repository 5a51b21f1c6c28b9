// `taut export mjcf`: a robot as a MuJoCo model.
#include <fmt/format.h>

#include <map>
#include <memory>

#include "any_robot.h"
#include "export.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "taut/mjcf.h"

namespace taut::cli {
namespace {

struct MjcfExportArguments {
  std::string input, out;
  std::vector<std::string> set;
  MjcfExport options;
  bool strict = false;
};

const std::map<std::string, MjcfCables> kCables{{"actuator", MjcfCables::kActuator},
                                                {"spring", MjcfCables::kSpring}};

int Export(const MjcfExportArguments& args) {
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  const auto robot = LoadAnyRobot(args.input, *overrides, found);
  if (!robot || !Pass(found, args.strict)) return Fail(found, kBadInput);
  const auto text = ExportMjcf(robot->def, args.options, found);
  if (!text || !Pass(found, args.strict)) return Fail(found, kBadInput);
  const int written = WriteOrPrint(args.out, *text);
  if (written == kOk && !args.out.empty()) {
    SayNextProgram({"python3", "-m", "mujoco.viewer", "--mjcf=" + args.out});
  }
  return written;
}

}  // namespace

void AddExportMjcf(CLI::App& export_, int& exit_code) {
  auto args = std::make_shared<MjcfExportArguments>();
  CLI::App* mjcf = export_.add_subcommand(
      "mjcf", "Write a robot, with the terrain of its experiment, for MuJoCo (2.2.2 and 3).");
  AddInput(*mjcf, "robot", {"model", "experiment"}, args->input, "Model or experiment file (YAML)")
      ->required();
  AddChoice(*mjcf, "--cables", args->options.cables, kCables,
            "Form of the cables: actuators that can only pull, or tendon springs with a dead band, "
            "for MuJoCo 3 only (default: actuator)");
  mjcf->add_flag("--keyframe", args->options.keyframe,
                 "Use rest lengths as controls, and write a keyframe `start` with controls and "
                 "velocities; otherwise controls are changes of rest lengths");
  mjcf->add_option("--set", args->set, "Set a parameter of the model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  mjcf->add_option("--out", args->out, "Output file (default: standard output)")
      ->option_text("FILE");
  mjcf->add_flag("--strict", args->strict, kStrictHelp);
  mjcf->footer(
      "Examples:\n"
      "  taut export mjcf models/prism3.yaml --out prism3.xml\n"
      "  taut export mjcf experiments/drop_six_strut.yaml --keyframe --out drop.xml\n"
      "  taut export mjcf models/tetraspine3.yaml --set segments=6 --cables spring\n"
      "Elements that MJCF cannot represent are errors; omissions are warnings "
      "(docs/from_mujoco.md).\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input.");
  mjcf->callback([args, &exit_code] { exit_code = Export(*args); });
}

}  // namespace taut::cli
