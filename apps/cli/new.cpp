// Command `taut new`: files to start from.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "new_mapping.h"
#include "new_robot.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/diagnostics.h"
#include "templates.h"

namespace taut::cli {
namespace {

const std::vector<std::string> kKinds{"robot", "model", "experiment", "study", "mapping"};

struct NewArguments {
  std::string kind, name, model, out, like;
};

/// Returns the path of a shipped file without checking it: a missing file is reported when the new
/// file is read.
std::string Shipped(const std::string& folder, const std::string& file) {
  return ShippedFolderOf(folder).value_or(folder) + "/" + file;
}

std::string Schema(const std::string& kind) {
  const auto folder = ShippedFolderOf("schema");
  return folder ? *folder + "/" + kind + ".schema.json" : "";
}

/// Returns the text of the new file; `next`: command that uses it.
std::string Text(const NewArguments& args, std::string& next) {
  const std::string schema = Schema(args.kind);
  if (args.kind == "model") {
    next = "view";
    return NewModel(args.name, schema);
  }
  if (args.kind == "experiment") {
    next = "view";
    return NewExperiment(args.name, schema,
                         args.model.empty() ? Shipped("models", "prism3.yaml") : args.model);
  }
  next = "learn";
  return NewStudy(args.name, schema, Shipped("experiments", "sidewinder3_start.yaml"));
}

int New(const NewArguments& args) {
  if (args.kind == "mapping") return NewMapping({args.name, args.model, args.out});
  if (const std::string wrong = CheckName(args.name); !wrong.empty()) {
    fmt::print(stderr, "error: NAME: {}\n", Printable(wrong));
    return kUsage;
  }
  if (!args.model.empty() && args.kind != "experiment") {
    fmt::print(stderr, "error: --model needs an experiment or a mapping\n");
    return kUsage;
  }
  if (!args.out.empty()) {
    fmt::print(stderr, "error: --out needs a mapping\n");
    return kUsage;
  }
  if (!args.like.empty() && args.kind != "robot") {
    fmt::print(stderr, "error: --like needs a robot\n");
    return kUsage;
  }
  if (args.kind == "robot") {
    return NewRobot(args.name, args.like.empty() ? RobotTemplates().front() : args.like);
  }
  // Input files must not contain control characters; YAML would turn a line end into a space.
  if (Printable(args.model) != args.model || args.model.find('\n') != std::string::npos) {
    fmt::print(stderr,
               "error: --model {}: a path with control characters cannot be written into "
               "a file (rename the model)\n",
               Printable(args.model));
    return kUsage;
  }
  OutputIsNews();
  const std::string path = args.name + ".yaml";
  if (IsTaken(path)) return kBadInput;
  std::string next;
  const int exit = WriteNamed(path, Text(args, next));
  if (exit != kOk) return exit;
  fmt::print("Written: {}\n", path);
  SayNext({next, path});
  return exit;
}

}  // namespace

void AddNew(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<NewArguments>();
  CLI::App* create = app.add_subcommand("new",
                                        "Write files to start from: a robot's folder, a model, an "
                                        "experiment or a study, or a mapping for a log.");
  create->add_option("kind", args->kind, "robot, model, experiment, study or mapping")
      ->required()
      ->option_text(Alternatives(kKinds))
      ->check(OneOf(kKinds));
  create
      ->add_option(
          "name", args->name,
          "Name of the robot's folder, or of the file NAME.yaml, in the current folder; for a "
          "mapping: the log to read")
      ->required()
      ->option_text("NAME");
  AddInput(
      *create, "--model", {"model", "experiment"}, args->model,
      "For an experiment: model file of its robot (default: the shipped prism); for a mapping: "
      "model or experiment whose names occur in the log")
      ->option_text("FILE");
  create->add_option("--out", args->out, "Mapping file to write (default: LOG.map.json)")
      ->option_text("FILE");
  create->add_option("--like", args->like, "Robot to start from (default: six_bar)")
      ->option_text(Alternatives(RobotTemplates()))
      ->check(OneOf(RobotTemplates()));
  create->footer(
      "Examples:\n"
      "  taut new robot my_robot\n"
      "  taut new robot my_tower --like tower\n"
      "  taut new model my_robot\n"
      "  taut new experiment my_test --model my_robot.yaml\n"
      "  taut new study my_search\n"
      "  taut new mapping lab.csv --model my_robot.yaml\n"
      "A robot's folder contains a model, experiments, a README and a notebook; most also a gait "
      "and a\n"
      "study that improves it. All files have comments and run unchanged.");
  create->callback([args, &exit_code] { exit_code = New(*args); });
}

}  // namespace taut::cli
