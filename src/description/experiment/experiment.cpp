// Loader of experiment files, including their models and overrides.
#include <cmath>
#include <functional>

#include "base/fixed.h"
#include "description/experiment/experiment_keys.h"
#include "description/experiment/experiment_parts.h"
#include "description/experiment/partial_load.h"
#include "description/experiment/resolved.h"
#include "description/model/model.h"
#include "description/model/sanity_checks.h"
#include "description/yaml/kinds.h"
#include "description/yaml/merged_file.h"
#include "description/yaml/read_keys.h"
#include "description/yaml/yaml_hash.h"

namespace taut {
namespace description {
namespace {

/// Adds the entries of `set:` as overrides with file positions. Evaluates their expressions with
/// the parameters of the experiment.
void AddSet(const Value* value, const Scope& scope, OverrideSet& overrides) {
  for (const Entry& entry : Entries(value, "set", scope)) {
    const double number = ReadNumber(*entry.value, "set." + entry.key, Bound::kAny, scope);
    const bool good = !std::isnan(number);
    // An empty file name marks an invalid value that is already reported.
    overrides.Add({entry.key, good ? Shown(number) : "", good ? entry.key_at : SourceRef{}});
  }
}

LoadedModel LoadItsModel(const ExperimentText& text, const OverrideSet& of_user,
                         const Scope& scope) {
  OverrideSet overrides({});
  AddSet(text.set.value, scope, overrides);
  for (const ParameterText& parameter : of_user.Unused()) overrides.Add(parameter);
  const auto path = FindFile(text.model.value, "model", scope);
  if (!path) return {};
  LoadedModel model = LoadModel(*path, overrides, scope.out, text.model_options);
  std::vector<std::string> all = model.parameter_names;
  for (const auto& parameter : scope.names) all.push_back(parameter.first);
  for (const ParameterText& parameter : overrides.Unused()) {
    if (parameter.at.file.empty()) continue;
    const bool from_file = parameter.at.line > 0;  // entries of `set:` address the model only
    ReportUnknownParameter(parameter, from_file ? model.parameter_names : all, scope.out);
  }
  return model;
}

/// Reports random rotations of the start pose that would break a joint with the world.
void CheckTurns(const ModelDef& def, const char* key, const Value* noise, const Scope& scope) {
  for (const JointDef& joint : def.joints) {
    if (!base::IsFixed(def, joint.body_a) && !base::IsFixed(def, joint.body_b)) continue;
    scope.out.Error(
        "start_noise.joint_holds_robot", noise->at,
        "start_noise." + std::string(key) + " cannot move the robot: the joint \"" + joint.name +
            "\" connects it to the world",
        "use start_noise.position_m, which moves the bodies that are not connected to the world");
    return;
  }
}

/// Returns the experiment as far as it could be read. The caller must check the diagnostics.
ExperimentSpec ReadExperiment(const Value& root, const OverrideSet& overrides, const Scope& scope,
                              const std::function<void(const ExperimentSpec&)>& look) {
  const std::size_t errors_before = scope.out.items().size();
  ExperimentText text;
  ReadMapping(root, "", scope, text);
  LoadedModel model = LoadItsModel(text, overrides, scope);
  const RobotSpec* known = model.robot ? &*model.robot : nullptr;
  if (text.sensor_text) text.sensors = *text.sensor_text;
  text.record = text.record_text;
  text.compare_with = FindFile(text.compare_file.value, "compare_with", scope);
  text.scales = ToScales(text.scale_texts, known, scope);
  const std::size_t errors_before_controllers = scope.out.items().size();
  text.controllers = ToControllers(text.controller_texts, known, model.good, scope);
  if (text.boards_text) AddBoards(*text.boards_text, known, scope, text);
  const bool drivers_known = model.good && scope.out.items().size() == errors_before_controllers;
  AddTimeline(text.timeline, known, scope, text);
  text.load_cases = ToLoadCases(text.load_case_texts, text.load_combinations, known, scope);
  text.references = ToReferences(text.reference_texts, known, text.phases, scope);

  if (model.robot) text.robot = std::move(*model.robot);
  ModelDef& def = text.robot.def;
  if (text.gravity_m_per_s2) def.gravity_m_per_s2 = *text.gravity_m_per_s2;
  if (text.place) Place(*text.place, text.start, scope, text.robot);
  AddTerrain(text.terrain, scope, text.robot);
  if (text.goal_text) text.goal = ToGoal(*text.goal_text, known ? &text.robot : nullptr, scope);
  CheckGoalIsSensed(text, scope.out);
  if (text.start_noise.goal_rad > 0 && !text.goal_text) {
    scope.out.Error("start_noise.no_goal", root.Find("start_noise")->at,
                    "start_noise.goal_rad: the experiment has no `goal`");
  }
  const StartNoise& noise = text.start_noise;
  if (noise.place_m > 0) CheckTurns(def, "place_m", root.Find("start_noise"), scope);
  if (noise.heading_rad > 0) CheckTurns(def, "heading_rad", root.Find("start_noise"), scope);
  if (noise.any_pose) CheckTurns(def, "any_pose", root.Find("start_noise"), scope);
  if (text.environment_text) {
    text.environment = ToEnvironment(*text.environment_text, *root.Find("environment"),
                                     known ? &text.robot : nullptr, drivers_known, text, scope);
  }
  AddMotions(text.motions, model.good, scope, text.robot);
  if (scope.out.ok()) CheckMotions(text.motions, text, scope);
  if (scope.out.ok()) CheckPositions(text.robot, scope.out, text.place ? &text.place->at : nullptr);
  if (look && drivers_known && scope.out.items().size() != errors_before) look(text);
  return text;
}

}  // namespace

void Check(const MapReader&, RecordText& record) {
  for (Placed& channel : record.channel_texts) {
    record.channels.push_back(std::move(channel.text));
    record.channel_sources.push_back(std::move(channel.at));
  }
}

}  // namespace description

std::optional<ExperimentSpec> LoadExperiment(const std::string& path, const Overrides& overrides,
                                             Diagnostics& out) {
  return description::LoadPartial(path, overrides, out, {});
}

std::optional<ExperimentSpec> description::LoadPartial(
    const std::string& path, const Overrides& overrides, Diagnostics& out,
    const std::function<void(const ExperimentSpec&)>& look) {
  const std::size_t errors_before = out.items().size();
  std::optional<ExperimentSpec> experiment;
  const description::ValuePtr root = description::ReadYaml(path, out);
  if (!root) return std::nullopt;
  const description::Value* const kind = root->Find("kind");
  if (kind && kind->text == description::kResolvedKind) {
    experiment = description::ReadResolved(path, *root, overrides, out);
  } else {
    description::MergedFile file = description::MergeBases(path, root, "experiment", out);
    if (!file.root) return std::nullopt;
    description::OverrideSet set(overrides);
    set.Apply(file.parameters);
    const description::NameTable names = description::ResolveParameters(file.parameters, out);
    description::NameSet used;
    experiment = description::ReadExperiment(*file.root, set, {names, out, &used}, look);
    if (out.items().size() == errors_before) {
      description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
    }
    experiment->parameters.insert(names.begin(), names.end());
    experiment->files = std::move(file.files);
  }
  if (!experiment || out.items().size() != errors_before) return std::nullopt;
  for (const ControllerSpec& controller : experiment->controllers) {
    const GaitInputSpec* input = GaitInputOf(controller);
    if (!input) continue;
    const auto add = [&](const GaitSpec& gait) {
      experiment->files.insert(experiment->files.end(), gait.files.begin(), gait.files.end());
    };
    add(input->gait);
    for (const GaitSpec& gait : input->others) add(gait);
  }
  const std::vector<std::string>& model_files = experiment->robot.files;
  experiment->files.insert(experiment->files.end(), model_files.begin(), model_files.end());
  const auto hash = description::HashInputs(experiment->files, overrides, out);
  if (!hash) return std::nullopt;
  experiment->input_hash = *hash;
  experiment->robot.def.experiment_parts = ActingParts(*experiment);
  return experiment;
}

std::string ActingParts(const ExperimentSpec& experiment) {
  std::string parts;
  const auto add = [&](bool has, const char* name) {
    if (has) parts += (parts.empty() ? "" : ", ") + std::string(name);
  };
  add(!experiment.controllers.empty(), "controllers");
  add(!experiment.pushes.empty(), "pushes");
  add(!experiment.drags.empty(), "drags");
  add(experiment.start != StartKind::kAsDescribed, "a settled start");
  return parts;
}

const BoardsSpec* BoardsOf(const std::vector<ControllerSpec>& controllers) noexcept {
  const bool has = !controllers.empty() && controllers.back().boards;
  return has ? &*controllers.back().boards : nullptr;
}

RolloutWorld WorldOf(const ExperimentSpec& experiment) {
  return {experiment.controllers, experiment.scales, experiment.start_noise, experiment.seed, {}};
}

ExperimentSpec ExperimentOf(const ExperimentSpec& base, const RolloutWorld& world) {
  ExperimentSpec experiment = base;
  experiment.controllers = world.controllers;
  experiment.scales = world.scales;
  experiment.start_noise = world.start_noise;
  experiment.seed = world.seed;
  return experiment;
}

}  // namespace taut
