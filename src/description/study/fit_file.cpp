// Loader of fit files.
#include <filesystem>
#include <map>

#include "description/study/fit_parts.h"
#include "description/yaml/file_parameters.h"
#include "description/yaml/merged_file.h"
#include "description/yaml/read_keys.h"
#include "taut/fit_spec.h"

namespace taut {
namespace description {
namespace {

std::string WholePath(const std::string& path) {
  std::error_code ignored;
  const auto whole = std::filesystem::weakly_canonical(path, ignored);
  return whole.empty() ? path : whole.string();
}

/// Loads the experiment of an entry. Returns false if it has errors.
bool LoadItsExperiment(const FitExperimentText& text, const OverrideSet& of_user,
                       const Scope& scope, FitExperiment& out) {
  for (const Entry& entry : Entries(text.set.value, "experiments.set", scope)) {
    const double number =
        ReadNumber(*entry.value, "experiments.set." + entry.key, Bound::kAny, scope);
    out.set.emplace_back(entry.key, Shown(number));
  }
  for (const ParameterText& parameter : of_user.Unused()) {
    out.set.emplace_back(parameter.name, parameter.expression);
  }
  const auto path = FindFile(text.experiment.value, "experiments.experiment", scope);
  if (!path) return false;
  out.experiment_file = *path;
  auto experiment = LoadExperiment(*path, out.set, scope.out);
  if (!experiment) return false;
  out.experiment = std::move(*experiment);
  return true;
}

/// Reports measurements that are listed twice, especially in both training and test data.
void CheckFiles(const std::vector<FitExperiment>& experiments, const Scope& scope) {
  std::map<std::string, const FitExperiment*> seen;
  for (const FitExperiment& one : experiments) {
    if (one.data_file.empty()) continue;
    const auto [first, fresh] = seen.emplace(WholePath(one.data_file), &one);
    if (fresh) continue;
    const FitExperiment& other = *first->second;
    const bool held_out = one.train != other.train;
    scope.out.Error("fit.data_used_twice", one.data_at,
                    "experiments: " + one.name + " has the same data as " + other.name +
                        (held_out ? ", but one of them is held out for validation" : ""),
                    held_out ? "use separate data for `use: test`" : "list each measurement once");
  }
}

void ReadExperiments(const std::vector<FitExperimentText>& texts, const OverrideSet& of_user,
                     const Scope& scope, std::vector<FitExperiment>& out,
                     std::vector<bool>& known) {
  std::map<std::string, SourceRef> names;
  for (const FitExperimentText& text : texts) {
    FitExperiment& one = out.emplace_back();
    one.name = text.name;
    one.at = text.at, one.data_at = text.data_at, one.setpoints_at = text.setpoints_at;
    one.train = text.train;
    one.forward = text.forward;
    if (!one.name.empty() && !names.emplace(one.name, text.name_at).second) {
      scope.out.Error("fit.duplicate_experiment", text.name_at,
                      "experiments: two entries are called " + one.name);
    }
    known.push_back(LoadItsExperiment(text, of_user, scope, one));
    one.data_file = FindFile(text.data.value, "experiments.data", scope).value_or("");
    one.map_file = FindFile(text.map.value, "experiments.map", scope).value_or("");
    one.setpoints_file =
        FindFile(text.setpoints.value, "experiments.setpoints", scope).value_or("");
    if (known.back() && one.forward == FitForward::kLoadCases &&
        one.experiment.load_cases.empty()) {
      scope.out.Error("fit.no_load_cases", one.at,
                      "experiments: " + one.name + " has no load cases",
                      "add `load_cases` to the experiment, or change `forward`");
    }
  }
  CheckFiles(out, scope);
}

FitSpec ReadFit(const Value& root, const OverrideSet& overrides, const Scope& scope) {
  FitFileText text;
  ReadMapping(root, "", scope, text);
  FitSpec fit;
  fit.name = text.name;
  fit.description = text.description;
  fit.groups = text.groups;
  if (text.search) fit.search = text.search->values;
  std::vector<bool> known;
  ReadExperiments(text.experiments, overrides, scope, fit.experiments, known);
  const Value* list = root.Find("experiments");
  if (list && list->kind == Value::Kind::kSequence) {
    bool any = false;
    for (const FitExperiment& one : fit.experiments) any |= one.train;
    if (!any) {
      scope.out.Error("fit.no_experiments", list->at,
                      "experiments: no entry is used for the estimation",
                      "write `use: train` for at least one, or leave out `use`");
    }
  }
  fit.estimates = ToEstimates(text.estimate, fit.experiments, known, scope);
  fit.residuals = ToResiduals(text.residuals, fit.experiments, known, false, scope);
  for (const FitCandidateText& candidate : text.design) {
    fit.design.push_back(
        {candidate.name, ToResiduals(candidate.residuals, fit.experiments, known, true, scope)});
  }
  fit.carried = ToCarried(text.carried, fit.experiments, known, scope);
  for (const char* key : {"estimate", "residuals"}) {
    const Value* items = root.Find(key);
    if (items && items->kind == Value::Kind::kSequence && items->items.empty()) {
      scope.out.Error("fit.empty_list", items->at,
                      std::string(key) + " is empty: there is nothing to fit");
    }
  }
  return fit;
}

}  // namespace

void Check(const MapReader& map, FitExperimentText& experiment) {
  experiment.name_at = map.KeyAt("name");
  experiment.data_at = map.KeyAt("data");
  experiment.setpoints_at = map.KeyAt("setpoints");
  for (const char* key : {"map", "setpoints"}) {
    if (map.Has(key) && !map.Has("data")) {
      map.Error("fit.key_needs_data", key,
                std::string("experiments.") + key + " has no effect without `data`");
    }
  }
  if (experiment.forward == FitForward::kLoadCases && map.Has("setpoints")) {
    map.Error("fit.setpoints_with_load_cases", "setpoints",
              "experiments.setpoints: load cases have no set points",
              "leave it out: row i of the data belongs to load case i");
  }
  if (experiment.forward != FitForward::kDynamic && map.Has("experiment") && !map.Has("data")) {
    map.Error("fit.forward_without_data", "forward",
              "experiments.forward: an equilibrium needs `data` for comparison");
  }
}

std::vector<std::size_t> NamedExperiments(const std::vector<Placed>& names, const char* what,
                                          const std::vector<FitExperiment>& experiments,
                                          const Scope& scope) {
  std::vector<std::string> all;
  for (const FitExperiment& one : experiments) all.push_back(one.name);
  std::vector<std::size_t> found;
  for (const Placed& name : names) {
    const auto at = std::find(all.begin(), all.end(), name.text);
    if (at == all.end()) {
      scope.out.Error(
          "fit.unknown_experiment", name.at,
          std::string(what) + ".experiments: there is no experiment called \"" + name.text + "\"",
          NameHint(name.text, all));
    } else {
      found.push_back(static_cast<std::size_t>(at - all.begin()));
    }
  }
  if (names.empty()) {
    for (std::size_t i = 0; i < all.size(); ++i) found.push_back(i);
  }
  return found;
}

}  // namespace description

std::optional<FitSpec> LoadFit(const std::string& path, const Overrides& overrides,
                               Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  description::MergedFile file = description::ReadMergedFile(path, "fit", out);
  if (!file.root) return std::nullopt;
  description::OverrideSet set(overrides);
  set.Apply(file.parameters);
  const description::NameTable names = description::ResolveParameters(file.parameters, out);
  description::NameSet used;
  FitSpec fit = description::ReadFit(*file.root, set, {names, out, &used});
  if (out.items().size() != errors_before) return std::nullopt;
  description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
  fit.files = std::move(file.files);
  for (const FitExperiment& one : fit.experiments) {
    fit.files.insert(fit.files.end(), one.experiment.files.begin(), one.experiment.files.end());
    for (const std::string* more : {&one.data_file, &one.map_file, &one.setpoints_file}) {
      if (!more->empty()) fit.files.push_back(*more);
    }
  }
  return fit;
}

}  // namespace taut
