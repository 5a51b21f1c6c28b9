// `taut export mjcf`: a robot as a MuJoCo model.
#include <fmt/format.h>

#include <map>
#include <memory>

#include "any_robot.h"
#include "export.h"
#include "output.h"
#include "overrides.h"
#include "shipped.h"
#include "taut/mjcf.h"

namespace taut::cli {
namespace {

struct Arguments {
  std::string input, out;
  std::vector<std::string> set;
  MjcfExport options;
  bool strict = false;
};

const std::map<std::string, MjcfCables> kCables{{"actuator", MjcfCables::kActuator},
                                                {"spring", MjcfCables::kSpring}};

int Export(const Arguments& args) {
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return kUsage;
  Diagnostics found;
  const auto robot = LoadAnyRobot(args.input, *overrides, found);
  if (!robot || !Pass(found, args.strict)) return Fail(found, kBadInput);
  const auto text = ExportMjcf(robot->def, args.options, found);
  if (!text || !Pass(found, args.strict)) return Fail(found, kBadInput);
  return WriteOrPrint(args.out, *text);
}

}  // namespace

void AddExportMjcf(CLI::App& export_, int& exit_code) {
  auto args = std::make_shared<Arguments>();
  CLI::App* mjcf = export_.add_subcommand(
      "mjcf", "A robot, with the terrain of its experiment, for MuJoCo (2.2.2 and 3).");
  AddInput(*mjcf, "robot", args->input, "Model or experiment file (YAML)")->required();
  AddChoice(*mjcf, "--cables", args->options.cables, kCables,
            "A cable is an actuator that can only pull, or a tendon's spring with a dead band, for "
            "MuJoCo 3 alone (default: actuator)");
  mjcf->add_flag("--keyframe", args->options.keyframe,
                 "Controls are rest lengths, which a keyframe `start` has, with velocities; else "
                 "changes of rest lengths");
  mjcf->add_option("--set", args->set, "Parameter of the model")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  mjcf->add_option("--out", args->out, "File to write (default: print)")->option_text("FILE");
  mjcf->add_flag("--strict", args->strict, kStrictHelp);
  mjcf->footer(
      "Examples:\n"
      "  taut export mjcf models/prism3.yaml --out prism3.xml\n"
      "  taut export mjcf experiments/drop_six_strut.yaml --keyframe --out drop.xml\n"
      "  taut export mjcf models/tetraspine3.yaml --set segments=6 --cables spring\n"
      "What MJCF cannot say is refused by name; what is left out is a warning\n"
      "(docs/from_mujoco.md).\n"
      "Exit status: 0 good, 1 a file cannot be written, 2 bad usage, 3 bad input.");
  mjcf->callback([args, &exit_code] { exit_code = Export(*args); });
}

}  // namespace taut::cli
