#include "description/model/model.h"

#include <cmath>

#include "description/model/build.h"
#include "description/model/members.h"
#include "description/model/model_keys.h"
#include "description/model/sanity_checks.h"
#include "description/yaml/kinds.h"
#include "description/yaml/read_keys.h"

namespace taut::description {
namespace {

/// Reports overflows: sums and products of finite numbers may be infinite.
void CheckFinite(const RobotSpec& robot, Diagnostics& out) {
  for (std::size_t i = 0; i < robot.def.bodies.size(); ++i) {
    const BodyDef& body = robot.def.bodies[i];
    const Inertia& inertia = body.inertia_kg_m2;
    if (std::isfinite(body.mass_kg + body.com_m.x + body.com_m.y + body.com_m.z) &&
        std::isfinite(inertia.xx + inertia.yy + inertia.zz + inertia.xy + inertia.xz +
                      inertia.yz)) {
      continue;
    }
    out.Error("body.too_large", robot.body_sources[i],
              "the mass or inertia of the body \"" + body.name +
                  "\" is too large for a floating-point number");
  }
  for (std::size_t i = 0; i < robot.def.cables.size(); ++i) {
    const CableDef& cable = robot.def.cables[i];
    if (std::isfinite(cable.rest_length_m)) continue;
    out.Error("cable.rest_length_not_finite", robot.cable_sources[i],
              "the cable \"" + cable.name + "\" has a rest length that is not finite");
  }
}

/// Replaces laws of the model by laws of an experiment. Errors in these laws are already reported.
void Replace(const Value& value, ModelText& model) {
  Diagnostics unheard;
  const NameTable no_names;
  ModelOptions options{model.inertia, model.damping_law, model.def};
  ReadMapping(value, "", {no_names, unheard}, options);
  model.inertia = options.inertia;
  model.def = options.def;
  if (!value.Find("damping_law")) return;
  model.damping_law = options.damping_law;
  for (BuilderText& builder : model.builders) {
    if (builder.cable) builder.cable->own_damping_law = false;
  }
}

/// Builds the robot of a model file. `errors_before`: number of errors before the file was read.
LoadedModel BuildModel(const MergedFile& file, std::size_t errors_before, Diagnostics& out,
                       const Overlay<ModelOptions>& options) {
  const auto errors = [&out] { return out.items().size(); };
  LoadedModel result;
  const NameTable values = ResolveParameters(file.parameters, out);
  bool numbers_known = true;  // false if a parameter is NaN because the experiment overrides it
                              // with an invalid value
  for (const auto& [name, value] : values) {
    result.parameter_names.push_back(name);
    numbers_known = numbers_known && !std::isnan(value);
  }
  NameSet used;
  ModelText model = ReadModelText(*file.root, {values, out, &used});
  if (options.value) Replace(*options.value, model);
  RobotSpec robot;
  robot.def = model.def;
  robot.def.name = model.name;
  robot.parameters.insert(values.begin(), values.end());
  robot.files = file.files;
  robot.solids.emplace().bounding_box_inertia = model.inertia == InertiaLaw::kBoundingBox;
  const std::size_t errors_in_text = errors();
  const Assembly assembly = Assemble(model, out);
  Assignment assignment = AssignBuilders(model, assembly, out);
  LumpMembers(model, assembly, assignment);
  const bool complete = errors() == errors_in_text && model.nodes_complete &&
                        model.pairs_complete && model.builders_complete;
  const BodyOfNode body_of_node = BuildBodies(model, assembly, assignment, robot, out);
  BuildCables(model, assembly, assignment, body_of_node, robot, out);
  BuildJoints(model, assembly, assignment, body_of_node, robot, out);

  // Skip this check after any other error: if a cable is missing, bodies seem disconnected.
  if (errors() == errors_before && !model.allow_disconnected) CheckConnected(robot, out);
  if (errors() == errors_before && numbers_known) {
    CheckPositions(robot, out);
    if (errors() == errors_before) CheckFinite(robot, out);
  }
  result.good = errors() == errors_before;
  if (result.good) {
    WarnOfUnused(file.parameters, std::move(used), file.files, out);
    WarnImplausible(robot, out);
  }
  if (!result.good && !complete) return result;
  result.robot = std::move(robot);
  return result;
}

}  // namespace

LoadedModel LoadModel(const std::string& path, OverrideSet& overrides, Diagnostics& out,
                      const Overlay<ModelOptions>& options) {
  const std::size_t errors_before = out.items().size();
  MergedFile file = ReadMergedFile(path, "model", out);
  if (!file.root) {
    overrides.Silence();
    return {};
  }
  overrides.Apply(file.parameters);
  return BuildModel(file, errors_before, out, options);
}

std::optional<RobotSpec> ModelOfText(const std::string& text, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  MergedFile file;
  file.root = ParseYaml(text, "", out);
  if (!file.root) return std::nullopt;
  LoadedModel model = BuildModel(file, errors_before, out, {});
  return model.good ? std::move(model.robot) : std::nullopt;
}

}  // namespace taut::description

namespace taut {

std::optional<RobotSpec> LoadRobot(const std::string& path, const Overrides& overrides,
                                   Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  description::OverrideSet set(overrides);
  description::LoadedModel model = description::LoadModel(path, set, out);
  set.ReportUnused(model.parameter_names, out);
  return out.items().size() == errors_before ? std::move(model.robot) : std::nullopt;
}

std::optional<std::string> FileKind(const std::string& path, Diagnostics& out) {
  const description::ValuePtr root = description::ReadYaml(path, out);
  if (!root) return std::nullopt;
  const description::Value* kind = root->Find("kind");
  for (const char* known : {"model", "experiment", "gait"}) {
    if (kind && kind->text == known) return kind->text;
  }
  if (kind && kind->text == description::kResolvedKind) return "experiment";
  if (kind) {
    out.Error("file.unknown_kind", kind->at,
              "kind must be model, experiment or gait, got " + kind->text,
              description::HintOfKind(kind->text));
  } else {
    out.Error("file.unknown_kind", root->at, "the file needs a kind: model, experiment or gait",
              "write `kind: model`, `kind: experiment` or `kind: gait` at the top of the file");
  }
  return std::nullopt;
}

std::optional<FileHead> ReadFileHead(const std::string& path, Diagnostics& out) {
  const description::ValuePtr root = description::ReadYaml(path, out);
  if (!root) return std::nullopt;
  const auto text = [&](const char* key) {
    const description::Value* value = root->Find(key);
    return value ? value->text : std::string();
  };
  return FileHead{text("kind"), text("name"), text("description")};
}

}  // namespace taut
