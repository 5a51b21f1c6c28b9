// Loader of study files.
#include "taut/study.h"

#include "description/study/study_parts.h"
#include "description/yaml/file_parameters.h"
#include "description/yaml/merged_file.h"
#include "description/yaml/read_keys.h"

namespace taut {
namespace description {
namespace {

/// Loads the experiment of a study. Returns false if it has errors.
bool LoadItsExperiment(const StudyFileText& text, const OverrideSet& of_user, const Scope& scope,
                       StudySpec& study) {
  Overrides overrides;
  for (const Entry& entry : Entries(text.set.value, "set", scope)) {
    const double number = ReadNumber(*entry.value, "set." + entry.key, Bound::kAny, scope);
    overrides.emplace_back(entry.key, Shown(number));
  }
  for (const ParameterText& parameter : of_user.Unused()) {
    overrides.emplace_back(parameter.name, parameter.expression);
  }
  const auto path = FindFile(text.experiment.value, "experiment", scope);
  if (!path) return false;
  auto experiment = LoadExperiment(*path, overrides, scope.out);
  if (!experiment) return false;
  study.experiment = std::move(*experiment);
  study.experiment_file = *path;
  return true;
}

/// Checks that the experiment has all that an objective needs.
void CheckAgainst(const ExperimentSpec& experiment, const ObjectiveText& objective,
                  Diagnostics& out) {
  if (objective.from_s >= experiment.duration_s) {
    out.Error("objective.starts_after_end", objective.from_at,
              "objective.from_s must be before the end of the experiment",
              "the end is at " + Shown(experiment.duration_s) + " s");
  }
  if (objective.measure == Measure::kNearer && !experiment.goal) {
    out.Error("objective.needs_goal", objective.measure_at,
              "objective.measure: nearer needs a goal", "add a `goal` to the experiment");
  }
}

/// Returns the study as far as it could be read. The caller must check the diagnostics.
StudySpec ReadStudy(const Value& root, const OverrideSet& overrides, const Scope& scope) {
  StudyFileText text;
  ReadMapping(root, "", scope, text);
  StudySpec study;
  study.name = text.name;
  study.description = text.description;
  study.seed = text.seed;
  const bool known = LoadItsExperiment(text, overrides, scope, study);
  std::vector<ControllerSpec> controllers = study.experiment.controllers;
  std::vector<ScaleSpec> scales = TunableScales(study.experiment.robot);
  std::vector<Tunable> tunables;
  if (known) tunables = FindTunables(controllers, scales, study.experiment.robot);
  study.parameters = ToParameters(root.Find("vary"), text.vary, known ? &tunables : nullptr, scope);
  study.objective = text.objective;
  if (known) CheckAgainst(study.experiment, text.objective, scope.out);
  if (text.worlds) study.perturbation = *text.worlds;
  if (known && study.perturbation.start.goal_rad > 0 && !study.experiment.goal) {
    scope.out.Error("study.start_needs_goal", root.Find("worlds")->at,
                    "worlds.start.goal_rad: the experiment has no `goal`");
  }
  // If `vary` has an error, the number of parameters is unknown.
  const std::size_t dimensions = scope.out.ok() ? study.parameters.size() : 0;
  study.searches = ToSearches(root.Find("search"), text.search, dimensions, scope);
  return study;
}

}  // namespace
}  // namespace description

std::optional<StudySpec> LoadStudy(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  description::MergedFile file = description::ReadMergedFile(path, "study", out);
  if (!file.root) return std::nullopt;
  description::OverrideSet set(overrides);
  set.Apply(file.parameters);
  const description::NameTable names = description::ResolveParameters(file.parameters, out);
  description::NameSet used;
  StudySpec study = description::ReadStudy(*file.root, set, {names, out, &used});
  if (out.items().size() != errors_before) return std::nullopt;
  description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
  study.files = std::move(file.files);
  const std::vector<std::string>& more = study.experiment.files;
  study.files.insert(study.files.end(), more.begin(), more.end());
  return study;
}

std::optional<ObjectiveSpec> ReadObjective(const std::string& text, const std::string& name,
                                           const ExperimentSpec& experiment, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const description::ValuePtr root = description::ParseYaml(text, name, out);
  if (!root) return std::nullopt;
  description::ObjectiveText objective;
  const description::NameTable no_parameters;
  description::ReadMapping(*root, "objective", {no_parameters, out}, objective);
  description::CheckAgainst(experiment, objective, out);
  if (out.items().size() != errors_before) return std::nullopt;
  return objective;
}

}  // namespace taut
