#include <algorithm>
#include <cmath>
#include <filesystem>

#include "description/experiment_parts.h"
#include "description/hash.h"
#include "description/laws.h"
#include "description/merged_file.h"
#include "description/model.h"
#include "description/plausible.h"
#include "description/resolved.h"

namespace taut {
namespace description {
namespace {

/// What an experiment may say about the model's laws.
struct ModelOptions {
  std::optional<InertiaLaw> inertia;
  std::optional<DampingLaw> damping_law;
  std::optional<FrictionLaw> friction_law;
  std::optional<CombineRule> friction_combine, restitution_combine;
};

template <class E>
void FindChoice(const MapReader& map, std::string_view key, const Choices<E>& choices,
                std::optional<E>& out) {
  if (const Value* found = map.Find(key)) {
    out = ReadChoice<E>(*found, map.Path(key), choices, map.scope());
  }
}

ModelOptions ReadModelOptions(const Value* value, const Scope& scope) {
  ModelOptions options;
  if (!value) return options;
  const MapReader map(
      *value, "model_options",
      {"inertia", "damping_law", "friction_law", "friction_combine", "restitution_combine"}, scope);
  FindChoice(map, "inertia", kInertiaLaws, options.inertia);
  FindChoice(map, "damping_law", kDampingLaws, options.damping_law);
  FindChoice(map, "friction_law", kFrictionLaws, options.friction_law);
  FindChoice(map, "friction_combine", kCombineRules, options.friction_combine);
  FindChoice(map, "restitution_combine", kCombineRules, options.restitution_combine);
  return options;
}

void Apply(const ModelOptions& options, ModelDef& def) {
  if (options.friction_law) def.friction_law = *options.friction_law;
  if (options.friction_combine) def.friction_combine = *options.friction_combine;
  if (options.restitution_combine) def.restitution_combine = *options.restitution_combine;
  if (!options.damping_law) return;
  for (CableDef& cable : def.cables) cable.damping_law = *options.damping_law;
}

/// `set:` as overrides with places; values are worked out here, in the experiment's parameters.
void AddSet(const Value* value, const Scope& scope, OverrideSet& overrides) {
  for (const Entry& entry : Entries(value, "set", scope)) {
    const double number = ReadNumber(*entry.value, "set." + entry.key, Bound::kAny, scope);
    const bool good = !std::isnan(number);
    // Without a file, a parameter is one that was complained about.
    overrides.Add({entry.key, good ? Shown(number) : "", good ? entry.key_at : SourceRef{}});
  }
}

/// The path that a key names, if such a file is there.
std::optional<std::string> FindFile(const MapReader& map, std::string_view key) {
  const Value* value = map.Find(key);
  if (!value) return std::nullopt;
  const std::string text = ReadText(*value, map.Path(key), map.scope());
  if (value->kind != Value::Kind::kScalar) return std::nullopt;
  // Beside the file that says so, which may be a base.
  const std::string path = PathBeside(value->at.file, text);
  std::error_code ignored;
  if (!text.empty() && std::filesystem::is_regular_file(path, ignored)) return path;
  map.scope().out.Error(value->at, std::string(key) + ": there is no file \"" + path + "\"",
                        "as seen from the folder of the file that names it");
  return std::nullopt;
}

class ExperimentReader {
 public:
  ExperimentReader(const MergedFile& file, OverrideSet& overrides, const Scope& scope)
      : scope_(scope),
        map_(*file.root, "",
             {"taut",      "kind",        "base",        "name",          "description",
              "model",     "set",         "parameters",  "model_options", "gravity_m_per_s2",
              "terrain",   "place",       "start",       "step_s",        "duration_s",
              "seed",      "controllers", "timeline",    "record",        "compare_with",
              "reference", "scale",       "start_noise", "sensors"},
             scope_),
        overrides_(overrides) {}

  /// Whatever could be read; the caller looks at the diagnostics.
  ExperimentSpec Read() {
    spec_.name = map_.Name("name");
    spec_.description = map_.TextOr("description", "");
    LoadedModel model = LoadItsModel();
    const RobotSpec* known = model.robot ? &*model.robot : nullptr;
    ReadTimes();
    spec_.start = map_.ChoiceOr<StartKind>("start", StartKind::kAsDescribed,
                                           {{"as_described", StartKind::kAsDescribed},
                                            {"settled", StartKind::kSettled},
                                            {"settled_floating", StartKind::kSettledFloating}});
    spec_.scales = ReadScales(map_.Find("scale"), known, scope_);
    if (const Value* noise = map_.Find("start_noise")) {
      spec_.start_noise = ReadStartNoise(*noise, scope_);
    }
    if (const Value* sensors = map_.Find("sensors")) spec_.sensors = ReadSensors(*sensors, scope_);
    spec_.controllers = ReadControllers(map_.Find("controllers"), known, model.good, scope_);
    if (const Value* timeline = map_.Find("timeline"))
      ReadTimeline(*timeline, known, scope_, spec_);
    if (const Value* record = map_.Find("record")) ReadRecord(*record);
    spec_.compare_with = FindFile(map_, "compare_with");

    spec_.references = ReadReferences(map_.Find("reference"), known, spec_.phases, scope_);

    if (model.robot) spec_.robot = std::move(*model.robot);
    ModelDef& def = spec_.robot.def;
    def.gravity_m_per_s2 = map_.VectorOr("gravity_m_per_s2", def.gravity_m_per_s2);
    const Value* place = map_.Find("place");
    if (place) ReadPlace(*place, spec_.start, scope_, def);
    ReadTerrain(map_.Find("terrain"), scope_, spec_.robot);
    if (scope_.out.ok()) CheckPositions(spec_.robot, scope_.out, place ? &place->at : nullptr);
    return std::move(spec_);
  }

 private:
  LoadedModel LoadItsModel() {
    const ModelOptions options = ReadModelOptions(map_.Find("model_options"), scope_);
    OverrideSet overrides({});
    AddSet(map_.Find("set"), scope_, overrides);
    for (const ParameterText& parameter : overrides_.Unused()) overrides.Add(parameter);
    map_.Require("model");
    const auto path = FindFile(map_, "model");
    if (!path) return {};
    LoadedModel model = LoadModel(*path, overrides, scope_.out, options.inertia);
    std::vector<std::string> all = model.parameter_names;
    for (const auto& parameter : scope_.names) all.push_back(parameter.first);
    for (const ParameterText& parameter : overrides.Unused()) {
      if (parameter.at.file.empty()) continue;
      const bool from_file = parameter.at.line > 0;  // by `set:`, for the model alone
      ReportUnknownParameter(parameter, from_file ? model.parameter_names : all, scope_.out);
    }
    if (model.robot) Apply(options, model.robot->def);
    return model;
  }

  void ReadTimes() {
    spec_.step_s = map_.NumberOr("step_s", spec_.step_s, Bound::kPositive);
    if (spec_.step_s < 1e-9 || spec_.step_s > 1.0) {
      scope_.out.Error(map_.Find("step_s")->at,
                       "step_s must be within 1e-9..1, got " + Shown(spec_.step_s));
    }
    spec_.duration_s = map_.Number("duration_s", Bound::kNonNegative);
    if (const Value* seed = map_.Find("seed")) {
      spec_.seed = static_cast<std::uint64_t>(
          ReadInteger(*seed, "seed", 0, 2'147'483'647, scope_).value_or(0));
    }
  }

  void ReadRecord(const Value& value) {
    const MapReader map(value, "record", {"rate_hz", "channels"}, scope_);
    spec_.record.rate_hz = map.NumberOr("rate_hz", spec_.record.rate_hz, Bound::kNonNegative);
    for (const ValuePtr& item : Items(map.Find("channels"), "record.channels", scope_)) {
      spec_.record.channels.push_back(ReadText(*item, "record.channels", scope_));
      spec_.record.channel_sources.push_back(item->at);
    }
  }

  Scope scope_;
  MapReader map_;
  OverrideSet& overrides_;
  ExperimentSpec spec_;
};

/// Whether `path` holds what `ResolvedYaml` wrote. Complaints are left to whoever reads it next.
bool IsResolved(const std::string& path) {
  Diagnostics unheard;
  const ValuePtr root = ReadYaml(path, unheard);
  const Value* kind = root ? root->Find("kind") : nullptr;
  return kind && kind->text == kResolvedKind;
}

}  // namespace
}  // namespace description

std::optional<ExperimentSpec> LoadExperiment(const std::string& path, const Overrides& overrides,
                                             Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  std::optional<ExperimentSpec> experiment;
  if (description::IsResolved(path)) {
    experiment = description::ReadResolved(path, overrides, out);
  } else {
    description::MergedFile file = description::ReadMergedFile(path, "experiment", out);
    if (!file.root) return std::nullopt;
    description::OverrideSet set(overrides);
    set.Apply(file.parameters);
    const description::NameTable names = description::ResolveParameters(file.parameters, out);
    description::NameSet used;
    experiment = description::ExperimentReader(file, set, {names, out, &used}).Read();
    if (out.items().size() == errors_before) {
      description::WarnOfUnused(file.parameters, std::move(used), file.files, out);
    }
    experiment->parameters.insert(names.begin(), names.end());
    experiment->files = std::move(file.files);
  }
  if (!experiment || out.items().size() != errors_before) return std::nullopt;
  for (const ControllerSpec& controller : experiment->controllers) {
    if (!controller.velocity_input) continue;
    const std::vector<std::string>& of_gait = controller.velocity_input->gait.files;
    experiment->files.insert(experiment->files.end(), of_gait.begin(), of_gait.end());
  }
  const std::vector<std::string>& model_files = experiment->robot.files;
  experiment->files.insert(experiment->files.end(), model_files.begin(), model_files.end());
  experiment->input_hash = description::HashInputs(experiment->files, overrides);
  return experiment;
}

}  // namespace taut
