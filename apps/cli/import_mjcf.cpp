// `taut import mjcf`: a MuJoCo model as a taut model.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "import.h"
#include "member_groups.h"
#include "output.h"
#include "overrides.h"
#include "standard_streams.h"
#include "taut/mjcf.h"
#include "taut/version.h"

namespace taut::cli {
namespace {

struct MjcfImportArguments {
  std::string input, out, experiment;
  MjcfImport options;
  bool strict = false;
};

const std::map<std::string, MjcfSlack> kSlack{{"tension_only", MjcfSlack::kTensionOnly},
                                              {"as_mujoco", MjcfSlack::kAsMujoco}};

int Import(const MjcfImportArguments& args) {
  if (!args.experiment.empty() && args.out.empty()) {
    fmt::print(stderr, "error: --experiment needs --out: the experiment names the model file\n");
    return kUsage;
  }
  Diagnostics found;
  const auto made = ImportMjcf(args.input, args.options, found);
  if (!made) return Fail(found, kBadInput);
  std::string heading = fmt::format("Made by taut {} from {}.", kVersion,
                                    std::filesystem::path(args.input).filename().string());
  const std::size_t terrain = made->robot.def.planes.size() + made->robot.def.terrain_boxes.size();
  for (const std::string& note : made->notes) heading += "\n" + note;
  const auto model = ModelYaml(made->robot, heading, found);
  if (model) {
    WarnOfRefusal(*model, args.experiment.empty() ? "" : MjcfExperimentYaml(*made, kCheckedModel),
                  args.input, found);
  }
  if (!model || !Pass(found, args.strict)) return Fail(found, kBadInput);
  for (const std::string& note : made->notes) fmt::print(stderr, "note: {}\n", note);
  if (terrain > 0 && args.experiment.empty()) {
    fmt::print(stderr,
               "note: a model has no terrain: {} of the world left out (use --experiment)\n",
               terrain == 1 ? "1 geom" : fmt::format("{} geoms", terrain));
  }
  if (!args.out.empty()) OutputIsNews();
  const int wrote = WriteOrPrint(args.out, *model);
  if (wrote != kOk || args.out.empty()) return wrote;
  const ModelDef& def = made->robot.def;
  fmt::print("{}: model of {}, {}, {}\n", args.out, Counted(def.bodies.size(), "body"),
             Counted(def.cables.size(), "cable"), Counted(def.joints.size(), "joint"));
  if (args.experiment.empty()) {
    SayNext({"check", args.out});
    return kOk;
  }
  const std::filesystem::path folder =
      std::filesystem::absolute(args.experiment).parent_path().lexically_normal();
  const std::string beside =
      std::filesystem::absolute(args.out).lexically_normal().lexically_relative(folder).string();
  const int exit = WriteNamed(args.experiment, MjcfExperimentYaml(*made, beside));
  if (exit == kOk) SayNext({"run", args.experiment});
  return exit;
}

}  // namespace

void AddImportMjcf(CLI::App& import, int& exit_code) {
  auto args = std::make_shared<MjcfImportArguments>();
  CLI::App* mjcf = import.add_subcommand(
      "mjcf", "Convert a MuJoCo model (MJCF) of a tensegrity robot to a model file.");
  mjcf->add_option("file", args->input, "MJCF file (XML)")->required();
  const auto add_unit = [&](const char* flag, std::optional<double>& unit, const char* help) {
    mjcf->add_option_function<double>(
            flag, [&unit](double value) { unit = value; }, help)
        ->option_text("X")
        ->check(NumberWithin(1e-6, 1e6));
  };
  add_unit("--length_unit_m", args->options.length_unit_m,
           "Length unit of the file [m] (default: 1)");
  add_unit("--mass_unit_kg", args->options.mass_unit_kg, "Mass unit of the file [kg] (default: 1)");
  AddChoice(*mjcf, "--slack", args->options.slack, kSlack,
            "Tendons shorter than their rest length: tension_only: no force (cables); as_mujoco: "
            "push (bars) (default: tension_only)");
  mjcf->add_flag("--without_frictionloss", args->options.without_frictionloss,
                 "Ignore the dry friction of tendons (an error without this flag)");
  mjcf->add_option("--keyframe", args->options.keyframe,
                   "Key of the file with the start pose and controls: name, or index from 0 "
                   "(default: described poses, controls 0)")
      ->option_text("KEY");
  mjcf->add_option("--name", args->options.name, "Name of the robot")
      ->option_text("NAME")
      ->check(CheckName);
  mjcf->add_option("--out", args->out, "Model file to write (default: standard output)")
      ->option_text("FILE");
  mjcf->add_option(
          "--experiment", args->experiment,
          "Experiment file to write: the model on the file's planes and boxes, with its timestep")
      ->option_text("FILE");
  mjcf->add_flag("--strict", args->strict, kStrictHelp);
  mjcf->footer(
      "Examples:\n"
      "  taut import mjcf prism.xml --out prism.yaml --experiment on_ground.yaml\n"
      "  taut import mjcf spine.xml --length_unit_m 0.1 --keyframe start --out spine.yaml\n"
      "Unsupported elements are errors with name and line; omissions are warnings\n"
      "or notes (docs/from_mujoco.md).\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input.");
  mjcf->callback([args, &exit_code] { exit_code = Import(*args); });
}

}  // namespace taut::cli
