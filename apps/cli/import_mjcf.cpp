// `taut import mjcf`: a MuJoCo model as a taut model.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "import.h"
#include "output.h"
#include "overrides.h"
#include "taut/mjcf.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

struct Arguments {
  std::string input, out, experiment;
  MjcfImport options;
  bool strict = false;
};

const std::map<std::string, MjcfSlack> kSlack{{"tension_only", MjcfSlack::kTensionOnly},
                                              {"as_mujoco", MjcfSlack::kAsMujoco}};

int Import(const Arguments& args) {
  if (!args.experiment.empty() && args.out.empty()) {
    fmt::print(stderr, "error: --experiment goes with --out: it names that model file\n");
    return kUsage;
  }
  Diagnostics found;
  const auto made = ImportMjcf(args.input, args.options, found);
  if (!made || !Pass(found, args.strict)) return Fail(found, kBadInput);
  std::string heading = fmt::format("Made by taut {} from {}.", kVersion,
                                    std::filesystem::path(args.input).filename().string());
  const std::size_t terrain = made->robot.def.planes.size() + made->robot.def.terrain_boxes.size();
  for (const std::string& note : made->notes) {
    fmt::print(stderr, "note: {}\n", note);
    heading += "\n" + note;
  }
  if (terrain > 0 && args.experiment.empty()) {
    fmt::print(stderr, "note: a model has no terrain: {} of the world {} for --experiment\n",
               terrain, terrain == 1 ? "geom is" : "geoms are");
  }
  const auto model = ModelYaml(made->robot, heading, found);
  if (!model) return Fail(found, kBadInput);
  const int wrote = WriteOrPrint(args.out, *model);
  if (wrote != kOk || args.experiment.empty()) return wrote;
  const std::filesystem::path folder =
      std::filesystem::absolute(args.experiment).parent_path().lexically_normal();
  const std::string beside =
      std::filesystem::absolute(args.out).lexically_normal().lexically_relative(folder).string();
  return WriteNamed(args.experiment, MjcfExperimentYaml(*made, beside));
}

}  // namespace

void AddImportMjcf(CLI::App& import, int& exit_code) {
  auto args = std::make_shared<Arguments>();
  CLI::App* mjcf =
      import.add_subcommand("mjcf", "A tensegrity robot of MuJoCo's language as a model file.");
  mjcf->add_option("file", args->input, "MJCF file (XML)")->required();
  const auto add_unit = [&](const char* flag, std::optional<double>& unit, const char* help) {
    mjcf->add_option_function<double>(
            flag, [&unit](double value) { unit = value; }, help)
        ->option_text("X")
        ->check(NumberWithin(1e-6, 1e6));
  };
  add_unit("--length_unit_m", args->options.length_unit_m,
           "What 1 in the file is [m] (default: 1)");
  add_unit("--mass_unit_kg", args->options.mass_unit_kg, "What 1 in the file is [kg] (default: 1)");
  AddChoice(*mjcf, "--slack", args->options.slack, kSlack,
            "What springs do that are shorter than at rest: nothing, as cables, or push, as bars "
            "(default: tension_only)");
  mjcf->add_flag("--without_frictionloss", args->options.without_frictionloss,
                 "Leave out the dry friction of tendons, for which a file is refused otherwise");
  mjcf->add_option("--keyframe", args->options.keyframe,
                   "Start, with its controls, from this key of the file (a name, or a number from "
                   "0; default: as bodies are described, controls 0)")
      ->option_text("KEY");
  mjcf->add_option("--name", args->options.name, "Name of the robot")
      ->option_text("NAME")
      ->check(CheckName);
  mjcf->add_option("--out", args->out, "Model file to write (default: print)")->option_text("FILE");
  mjcf->add_option("--experiment", args->experiment,
                   "Experiment file to write: that model on the file's planes and boxes, with its "
                   "timestep")
      ->option_text("FILE");
  mjcf->add_flag("--strict", args->strict, kStrictHelp);
  mjcf->footer(
      "Examples:\n"
      "  taut import mjcf prism.xml --out prism.yaml --experiment on_ground.yaml\n"
      "  taut import mjcf spine.xml --length_unit_m 0.1 --keyframe start --out spine.yaml\n"
      "What is not read is refused by its name and line, all at once; what is left out is told in\n"
      "a line (docs/from_mujoco.md).\n"
      "Exit status: 0 good, 1 a file cannot be written, 2 bad usage, 3 bad input.");
  mjcf->callback([args, &exit_code] { exit_code = Import(*args); });
}

}  // namespace taut::cli
