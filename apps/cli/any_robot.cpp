#include "any_robot.h"

#include <utility>

#include "interrupt.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "taut/start.h"

namespace taut::cli {

std::optional<RobotSpec> LoadAnyRobot(const std::string& path, const Overrides& overrides,
                                      Diagnostics& out) {
  const auto kind = FileKind(path, out);
  if (!kind) return std::nullopt;
  if (*kind == "model") return LoadRobot(path, overrides, out);
  auto experiment = LoadExperiment(path, overrides, out);
  if (!experiment) return std::nullopt;
  return std::move(experiment->robot);
}

void AddPlacedRobot(CLI::App& command, PlacedRobotArguments& args) {
  AddInput(command, "file", {"model", "experiment"}, args.path, "Model or experiment file (YAML)")
      ->required();
  command.add_option("--set", args.set, "Set a parameter of the file")
      ->option_text("NAME=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--pose", args.pose.file,
                  "Trace (.h5, .csv, .csv.gz) or folder of a run, with the pose to use instead of "
                  "the start")
      ->option_text("FILE");
  command
      .add_option("--at_s", args.pose.at_s, "With --pose: time of the pose [s] (default: last row)")
      ->option_text("NUMBER")
      ->check(NumberWithin(-1e12, 1e12))
      ->needs(command.get_option("--pose"));
  command.add_flag("--strict", args.strict, kStrictHelp);
}

namespace {

/// Returns the start pose of an experiment's robot. Returns nothing after an error (in `out`) or an
/// interrupt (sets only `exit`).
std::optional<Pose> StartOf(const ExperimentSpec& experiment, Diagnostics& out, int& exit) {
  CatchInterrupts();
  const auto settled = FindSettledStart(experiment, out, [] { return !interrupt_asked.load(); });
  exit = interrupt_asked ? kInterrupted : kFailed;
  if (!settled) return std::nullopt;
  return settled->pose;
}

}  // namespace

std::optional<RobotSpec> LoadPlacedRobot(const PlacedRobotArguments& args, int& exit) {
  Diagnostics found;
  const auto fail = [&](int status) -> std::optional<RobotSpec> {
    Fail(found, kBadInput);
    exit = status;
    return std::nullopt;
  };
  exit = kUsage;
  const auto overrides = ParseOverrides(args.set);
  if (!overrides) return std::nullopt;
  const auto kind = FileKind(args.path, found);
  if (kind && *kind != "model" && *kind != "experiment") {
    found.Error("file.wrong_kind", {args.path, 0, 0}, "the file is a " + *kind,
                "expected a model or an experiment");
  }
  if (!found.ok()) return fail(kBadInput);
  ExperimentSpec experiment;
  if (*kind == "model") {
    auto robot = LoadRobot(args.path, *overrides, found);
    if (robot) experiment.robot = std::move(*robot);
  } else {
    auto whole = LoadExperiment(args.path, *overrides, found);
    if (whole) experiment = std::move(*whole);
  }
  if (!found.ok()) return fail(kBadInput);
  std::optional<Pose> pose;
  if (!args.pose.file.empty()) {
    pose = ReadPose(args.pose, experiment.robot, found);
  } else {
    CheckStart(experiment.robot, experiment.start, found);
  }
  if (!Pass(found, args.strict)) return fail(kBadInput);
  if (!pose && experiment.start != StartKind::kAsDescribed) {
    pose = StartOf(experiment, found, exit);
    if (!pose || !Pass(found, args.strict)) return fail(pose ? kBadInput : exit);
  }
  return pose ? RobotAt(experiment.robot, *pose) : std::move(experiment.robot);
}

}  // namespace taut::cli
