// Reader of resolved experiments.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/number_text.h"
#include "description/experiment/experiment_parts.h"
#include "description/experiment/resolved.h"
#include "description/experiment/resolved_keys.h"
#include "description/model/sanity_checks.h"
#include "description/yaml/file_parameters.h"
#include "description/yaml/kinds.h"
#include "description/yaml/read_keys.h"
#include "taut/shape_kinds.h"
#include "taut/study.h"

namespace taut::description {
namespace {

void Read(const Value& value, const std::string& what, const Scope& scope, double& out) {
  out = ReadNumber(value, what, Bound::kAny, scope);
}
void Read(const Value& value, const std::string& what, const Scope& scope, bool& out) {
  out = ReadBool(value, what, scope).value_or(false);
}
void Read(const Value& value, const std::string& what, const Scope& scope, int& out) {
  out = ReadInteger(value, what, kWorld, std::numeric_limits<int>::max(), scope).value_or(0);
}
void Read(const Value& value, const std::string& what, const Scope& scope, std::uint64_t& out) {
  const char* end = value.text.data() + value.text.size();
  const auto [stop, status] = base::FromChars(value.text.data(), end, out);
  if (status == std::errc() && stop == end) return;
  scope.out.Error("resolved.not_whole", value.at, what + " must be a whole number");
}
void Read(const Value& value, const std::string& what, const Scope& scope, std::string& out) {
  out = ReadText(value, what, scope);
}
void Read(const Value& value, const std::string& what, const Scope& scope, Vec3& out) {
  out = ReadVec3(value, what, scope);
}
void Read(const Value& value, const std::string& what, const Scope& scope, Quat& out) {
  if (const auto q = ReadNumbers(value, what, 4, scope)) out = {(*q)[0], (*q)[1], (*q)[2], (*q)[3]};
}
void Read(const Value& value, const std::string& what, const Scope& scope, Inertia& out) {
  if (const auto i = ReadNumbers(value, what, 6, scope)) {
    out = {(*i)[0], (*i)[1], (*i)[2], (*i)[3], (*i)[4], (*i)[5]};
  }
}
void Read(const Value& value, const std::string& what, const Scope& scope,
          std::pair<double, double>& out) {
  if (const auto point = ReadNumbers(value, what, 2, scope)) out = {(*point)[0], (*point)[1]};
}
/// Reads numbers separated by spaces.
template <class List>
void Read(const Value& value, const std::string& what, const Scope& scope, Packed<List>& out) {
  const char* at = value.text.data();
  const char* const end = at + value.text.size();
  bool good = true;
  const auto take = [&](auto& number) {
    const auto [stop, status] = base::FromChars(at, end, number);
    good = good && status == std::errc();
    at = stop;
    if (at != end && *at == ' ') ++at;
  };
  while (good && at != end) {
    const char* const before = at;
    EachNumber(out.list.emplace_back(), take);
    good = good && at != before;
  }
  if (!good)
    scope.out.Error("resolved.not_numbers", value.at,
                    what + " must be numbers separated by spaces");
}
template <class T>
void Read(const Value& value, const std::string& what, const Scope& scope, T& out);  // for structs
template <class T>
void Read(const Value& value, const std::string& what, const Scope& scope, std::optional<T>& out) {
  Read(value, what, scope, out.emplace());
}
template <class T>
void Read(const Value& value, const std::string& what, const Scope& scope, std::vector<T>& out) {
  for (const ValuePtr& item : Items(&value, what, scope)) {
    Read(*item, what, scope, out.emplace_back());
  }
}

/// Reader of resolved experiments. All keys are required, except optional fields, limits and keys
/// that earlier versions of taut did not write. `Model::Compile` checks the ranges.
class ResolvedReader : public KeyVisitor<ResolvedReader, true> {
 public:
  explicit ResolvedReader(MapReader& map) : map_(map) { spelling = map.scope().spelling; }

  template <class T>
  void On(const Key& key, T& out) {
    map_.Know(key.name);
    if constexpr (std::same_as<T, double>) {
      if (key.limit) {
        out = map_.NumberOr(key.name, std::numeric_limits<double>::infinity(), Bound::kNonNegative);
        return;
      }
    }
    const bool may_lack = kIsOptional<T> || key.later;
    const Value* value = may_lack ? map_.Find(key.name) : map_.Require(key.name);
    if (!value) return;
    Scope scope = map_.scope();
    scope.spelling = spelling;
    Read(*value, map_.Path(key.name), scope, out);
  }
  /// Checks alternative names of a key; the kind of a joint determines the valid one.
  template <class OfName>
  void Spell(const Spellings& spellings, const OfName& of_name) {
    const char* const right = spellings.names[std::max(0, spelling.index)];
    for (const char* name : spellings.names) {
      if (name != right && map_.Has(name)) {
        map_.Know(name);
        map_.Error("key.wrong_quantity", name, map_.Path(name) + " has the wrong unit");
      }
    }
    of_name(right);
  }
  template <class E>
  void On(const Key& key, E& out, const Choices<E>& choices) {
    map_.Know(key.name);
    const Value* value = key.later ? map_.Find(key.name) : map_.Require(key.name);
    if (!value) return;
    out = ReadChoice<E>(*value, map_.Path(key.name), choices, map_.scope()).value_or(out);
  }

 private:
  MapReader& map_;
};

template <class T>
void ReadStruct(const Value& value, const std::string& what,
                const std::vector<std::string>& more_keys, const Scope& scope, T& out) {
  MapReader map(value, what, scope);
  ResolvedReader reader(map);
  Keys(reader, out);
  for (const std::string& key : more_keys) map.Know(key);
  map.RefuseOthers();
}

template <class T>
void Read(const Value& value, const std::string& what, const Scope& scope, T& out) {
  ReadStruct(value, what, {}, scope, out);
}

/// Applies the numeric checks of a gait file.
void CheckGait(const GaitSpec& gait, const SourceRef& at, Diagnostics& out) {
  if (CountKinds(gait) != 1) {
    out.Error("gait.kind_missing", at,
              "a gait must be exactly one of sine, cpg, table, feedback_cpg and toward_goal");
    return;
  }
  ForEachGaitKind([&](const auto& kind, auto) {
    if (gait.*kind.gait) CheckNumbers(*(gait.*kind.gait), at, out);
  });
}

/// Returns the cables that the gaits of an input drive.
std::vector<int> CheckInput(const GaitInputSpec& input, const GaitInputKind& kind,
                            const RobotSpec& robot, const SourceRef& at, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const auto check = [&](bool good, const char* what) {
    if (!good) out.Error("resolved.bad_value", at, std::string(kind.key) + what);
  };
  check(input.clock.period_s > 0.0, ".period_s must be positive");
  check(input.blend_s >= 0.0, ".blend_s must not be negative");
  double before_s = -1.0;
  for (const GaitChange& change : input.changes) {
    check(change.at_s >= 0.0 && change.at_s > before_s, ".changes: times must increase");
    check(change.gait >= 0 && static_cast<std::size_t>(change.gait) <= input.others.size(),
          ".changes refers to a gait that does not exist");
    before_s = change.at_s;
  }
  CheckGait(input.gait, at, out);
  for (const GaitSpec& gait : input.others) CheckGait(gait, at, out);
  if (out.items().size() != errors_before) return {};
  return CheckGaits(input, kind, std::vector<SourceRef>(input.others.size() + 1, at), &robot, out);
}

/// Checks names by the rules of the files that people write.
void CheckNames(const ExperimentSpec& experiment, const SourceRef& at, Diagnostics& out) {
  const auto check = [&](const std::string& name, bool good) {
    if (!good)
      out.Error("name.bad", at, "\"" + name + "\" cannot be a name",
                "use letters, digits, _ and -");
  };
  const auto check_all = [&](const auto& list) {
    for (const auto& item : list) check(item.name, IsFullName(item.name));
  };
  check(experiment.name, IsName(experiment.name));
  const ModelDef& def = experiment.robot.def;
  check(def.name, IsName(def.name));
  check_all(def.bodies), check_all(def.nodes), check_all(def.cables);
  EachShape(def, [&](const auto& shape) { check(shape.name, IsFullName(shape.name)); });
  check_all(def.planes), check_all(def.terrain_boxes), check_all(def.motions);
  check_all(def.height_fields), check_all(def.terrain_meshes);
  check_all(experiment.controllers), check_all(experiment.pushes), check_all(experiment.drags);
  check_all(experiment.phases), check_all(experiment.load_cases);
}

/// Checks indices that `Model::Compile` does not check.
void CheckIndices(const ExperimentSpec& experiment, const SourceRef& at, Diagnostics& out) {
  const RobotSpec& robot = experiment.robot;
  const auto check = [&](int index, std::size_t count, const char* what) {
    if (index >= 0 && static_cast<std::size_t>(index) < count) return;
    out.Error("resolved.bad_index", at,
              "there is no " + std::string(what) + " " + std::to_string(index));
  };
  for (const ControllerSpec& controller : experiment.controllers) {
    for (const PositionProgram& program : controller.position) {
      check(program.cable, robot.def.cables.size(), "cable");
    }
    if (controller.rest_length_input) {
      if (controller.impedance)
        out.Error("resolved.rest_length_input_with_impedance", at,
                  "rest_length_input cannot be combined with impedance");
      CheckInput(*controller.rest_length_input, kRestLengthInput, robot, at, out);
    }
    if (!controller.impedance) {
      if (controller.velocity_input)
        out.Error("resolved.velocity_input_without_impedance", at,
                  "velocity_input needs impedance");
      continue;
    }
    if (controller.velocity_input) {
      const std::size_t errors_before = out.items().size();
      const std::vector<int> moved =
          CheckInput(*controller.velocity_input, kVelocityInput, robot, at, out);
      if (out.items().size() == errors_before) CheckGaitDrives(controller, moved, robot, at, out);
    }
    for (const ImpedanceGains& gains : controller.impedance->cables) {
      check(gains.cable, robot.def.cables.size(), "cable");
    }
  }
  for (const ReferenceSpec& reference : experiment.references) {
    for (const ReferenceSpec::Value& value : reference.values) {
      check(value.cable, robot.def.cables.size(), "cable");
    }
  }
  for (const ScaleSpec& scale : experiment.scales) {
    const bool of_bodies = scale.quantity == ScaleSpec::Quantity::kMass;
    const std::size_t count = of_bodies ? robot.def.bodies.size() : robot.def.cables.size();
    for (const int index : scale.index) check(index, count, of_bodies ? "body" : "cable");
  }
  for (const LoadCaseSpec& loads : experiment.load_cases) {
    const std::size_t joints = robot.def.joints.size();
    for (const auto& force : loads.forces) check(force.node, robot.def.nodes.size(), "node");
    for (const auto& settlement : loads.settlements) check(settlement.joint, joints, "joint");
    for (const auto& cable : loads.cables) check(cable.index, robot.def.cables.size(), "cable");
    for (const auto& bar : loads.bars) check(bar.index, joints, "joint");
  }
  if (experiment.goal) check(experiment.goal->body, robot.def.bodies.size(), "body");
  if (experiment.environment) {
    std::vector<ControllerSpec> controllers = experiment.controllers;
    std::vector<ScaleSpec> none;
    std::set<std::string> known;
    for (const Tunable& number : FindTunables(controllers, none, robot)) known.insert(number.name);
    for (const EnvironmentAction& action : experiment.environment->actions) {
      if (!action.by) check(action.cable, robot.def.cables.size(), "cable");
      if (action.by && action.numbers.empty())
        out.Error("resolved.empty_action", at, "an action changes no parameter");
      for (const std::string& name : action.numbers) {
        if (known.count(name) == 0)
          out.Error("resolved.unknown_number", at, "there is no parameter \"" + name + '"');
      }
    }
  }
  CheckGoalIsSensed(experiment, out);
  for (const PushSpec& push : experiment.pushes) check(push.node, robot.def.nodes.size(), "node");
  for (const DragSpec& drag : experiment.drags) check(drag.node, robot.def.nodes.size(), "node");
  if (robot.node_tags.size() != robot.def.nodes.size() ||
      robot.cable_tags.size() != robot.def.cables.size()) {
    out.Error("resolved.tags_missing", at, "every node and every cable needs its tags");
  }
  const std::size_t joint_tags = robot.joint_tags.size();  // absent from files of earlier versions
  if (joint_tags != 0 && joint_tags != robot.def.joints.size()) {
    out.Error("resolved.joint_tags_missing", at, "every joint needs its tags");
  }
}

}  // namespace

std::optional<ExperimentSpec> ReadResolved(const std::string& path, const Value& root,
                                           const Overrides& overrides, Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  if (!CheckHeader(root, kResolvedKind, out)) return std::nullopt;
  OverrideSet(overrides).ReportUnused({}, out);
  const NameTable no_names;
  const Scope scope{no_names, out};
  ExperimentSpec experiment;
  ReadStruct(root, "", {"taut", "kind"}, scope, experiment);
  if (out.items().size() == errors_before) {
    CheckNames(experiment, root.at, out);
    CheckIndices(experiment, root.at, out);
  }
  if (out.items().size() != errors_before) return std::nullopt;
  const SourceRef at{path, 0, 0};
  RobotSpec& robot = experiment.robot;
  for (std::size_t j = robot.joint_tags.size(); j < robot.def.joints.size(); ++j) {
    robot.joint_tags.push_back({robot.def.joints[j].name});
  }
  robot.cable_sources.resize(robot.def.cables.size(), at);
  robot.body_sources.resize(robot.def.bodies.size(), at);
  robot.node_sources.resize(robot.def.nodes.size(), at);
  robot.plane_sources.resize(robot.def.planes.size(), at);
  robot.terrain_box_sources.resize(robot.def.terrain_boxes.size(), at);
  robot.height_field_sources.resize(robot.def.height_fields.size(), at);
  robot.mesh_sources.resize(robot.def.terrain_meshes.size(), at);
  CheckPositions(robot, out);
  if (out.items().size() != errors_before) return std::nullopt;
  WarnImplausible(robot, out);
  experiment.files = {path};
  return experiment;
}

}  // namespace taut::description
