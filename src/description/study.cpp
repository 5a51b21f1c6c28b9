#include "taut/study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "base/pattern.h"
#include "description/experiment_parts.h"
#include "description/merged_file.h"
#include "description/study_parts.h"

namespace taut {
namespace description {
namespace {

class StudyReader {
 public:
  StudyReader(const MergedFile& file, OverrideSet& overrides, const Scope& scope)
      : scope_(scope),
        map_(*file.root, "",
             {"taut", "kind", "base", "name", "description", "experiment", "set", "parameters",
              "seed", "search", "vary", "objective", "worlds"},
             scope_),
        overrides_(overrides) {}

  StudySpec Read() {
    study_.name = map_.Name("name");
    study_.description = map_.TextOr("description", "");
    if (const Value* seed = map_.Find("seed")) {
      study_.seed = static_cast<std::uint64_t>(
          ReadInteger(*seed, "seed", 0, 2'147'483'647, scope_).value_or(0));
    }
    const bool known = LoadItsExperiment();
    std::vector<ControllerSpec> controllers = study_.experiment.controllers;
    std::vector<ScaleSpec> scales = TunableScales(study_.experiment.robot);
    std::vector<Tunable> tunables;
    if (known) tunables = FindTunables(controllers, scales, study_.experiment.robot);
    study_.parameters = ReadVary(map_.Require("vary"), known ? &tunables : nullptr, scope_);
    if (const Value* objective = map_.Require("objective")) {
      const double duration_s =
          known ? study_.experiment.duration_s : std::numeric_limits<double>::infinity();
      study_.objective = ReadObjective(*objective, duration_s, scope_);
    }
    if (const Value* worlds = map_.Find("worlds")) {
      study_.perturbation = ReadPerturbation(*worlds, scope_);
    }
    // After complaints about `vary` nobody knows how many parameters were meant.
    const std::size_t dimensions = scope_.out.ok() ? study_.parameters.size() : 0;
    study_.searches = ReadSearches(map_.Require("search"), dimensions, scope_);
    return std::move(study_);
  }

 private:
  /// False if it has errors of its own.
  bool LoadItsExperiment() {
    Overrides overrides;
    std::vector<SourceRef> places;
    for (const Entry& entry : Entries(map_.Find("set"), "set", scope_)) {
      const double number = ReadNumber(*entry.value, "set." + entry.key, Bound::kAny, scope_);
      overrides.emplace_back(entry.key, Shown(number));
    }
    for (const ParameterText& parameter : overrides_.Unused()) {
      overrides.emplace_back(parameter.name, parameter.expression);
    }
    const Value* value = map_.Require("experiment");
    if (!value) return false;
    const std::string text = ReadText(*value, "experiment", scope_);
    const std::string path = PathBeside(value->at.file, text);
    std::error_code ignored;
    if (text.empty() || !std::filesystem::is_regular_file(path, ignored)) {
      scope_.out.Error(value->at, "experiment: there is no file \"" + path + "\"",
                       "as seen from the folder of the file that names it");
      return false;
    }
    auto experiment = LoadExperiment(path, overrides, scope_.out);
    if (!experiment) return false;
    study_.experiment = std::move(*experiment);
    study_.experiment_file = path;
    return true;
  }

  Scope scope_;
  MapReader map_;
  OverrideSet& overrides_;
  StudySpec study_;
};

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
  StudySpec study = description::StudyReader(file, set, {names, out, &used}).Read();
  if (out.items().size() != errors_before) return std::nullopt;
  description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
  study.files = std::move(file.files);
  const std::vector<std::string>& more = study.experiment.files;
  study.files.insert(study.files.end(), more.begin(), more.end());
  return study;
}

}  // namespace taut
