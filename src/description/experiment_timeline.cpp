#include <algorithm>
#include <cmath>
#include <map>

#include "description/experiment_parts.h"

namespace taut::description {
namespace {

/// The index of the node; 0 after a complaint or if the robot is unknown.
int ReadNodeName(const MapReader& map, const RobotSpec* robot) {
  const std::string name = map.Text("node");
  if (name.empty() || !robot) return 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot->def.nodes.size(); ++i) {
    names.push_back(robot->def.nodes[i].name);
    if (names.back() == name) return static_cast<int>(i);
  }
  map.scope().out.Error(map.Find("node")->at, "there is no node \"" + name + "\"",
                        NameHint(name, names));
  return 0;
}

PushSpec ReadPush(const Value& value, const RobotSpec* robot, const Scope& scope) {
  const MapReader map(value, "push", {"name", "node", "direction", "force_n", "scale"}, scope);
  PushSpec push;
  push.name = map.Name("name");
  push.node = ReadNodeName(map, robot);
  if (const Value* direction = map.Require("direction")) {
    push.direction = ReadDirection(*direction, map.Path("direction"), scope);
  }
  push.scale = map.NumberOr("scale", 1.0, Bound::kAny);
  if (const Value* force = map.Require("force_n")) {
    push.force_n = ReadPoints(*force, map.Path("force_n"), Bound::kAny, scope);
    if (push.force_n.size() == 1) {
      scope.out.Error(force->at, "push.force_n needs two points or more",
                      "the force is zero before the first and after the last one");
    }
  }
  return push;
}

DragSpec ReadDrag(const Value& value, const RobotSpec* robot, const Scope& scope) {
  const MapReader map(value, "drag",
                      {"name", "node", "velocity_m_per_s", "stiffness_n_per_m", "damping_n_s_per_m",
                       "from_s", "to_s"},
                      scope);
  DragSpec drag;
  drag.name = map.Name("name");
  drag.node = ReadNodeName(map, robot);
  drag.velocity_m_per_s = map.Vector("velocity_m_per_s");
  const Vec3& v = drag.velocity_m_per_s;
  if (v.x == 0.0 && v.y == 0.0 && v.z == 0.0) {
    map.Error("velocity_m_per_s", "drag.velocity_m_per_s must not be zero",
              "the force is measured along it");
  }
  drag.stiffness_n_per_m = map.Number("stiffness_n_per_m", Bound::kPositive);
  drag.damping_n_s_per_m = map.NumberOr("damping_n_s_per_m", 0.0, Bound::kNonNegative);
  drag.from_s = map.Number("from_s", Bound::kNonNegative);
  drag.to_s = map.Number("to_s", Bound::kNonNegative);
  if (drag.from_s >= drag.to_s) {
    map.Error("to_s", "drag.to_s must be after from_s, got " + Shown(drag.from_s) + ".." +
                          Shown(drag.to_s));
  }
  return drag;
}

void ReadPhases(const Value* value, double duration_s, const Scope& scope,
                std::vector<PhaseSpec>& phases) {
  for (const Entry& entry : Entries(value, "timeline.phases", scope)) {
    PhaseSpec phase;
    phase.name = ReadKey(entry, "timeline.phases", scope);
    const std::string what = "phase " + entry.key;
    const auto span = ReadNumbers(*entry.value, what, 2, scope);
    if (!span) continue;
    phase.from_s = (*span)[0];
    phase.to_s = (*span)[1];
    const std::string shown = Shown(phase.from_s) + ".." + Shown(phase.to_s) + " s";
    if (phase.from_s >= phase.to_s) {
      scope.out.Error(entry.value->at, what + " must end after it begins, got " + shown);
    } else if (phase.from_s < 0.0 || phase.to_s > duration_s) {
      scope.out.Error(entry.value->at, what + " must be within the experiment, 0.." +
                                           Shown(duration_s) + " s, got " + shown);
    }
    phases.push_back(std::move(phase));
  }
}

}  // namespace

void ReadTimeline(const Value& value, const RobotSpec* robot, const Scope& scope,
                  ExperimentSpec& out) {
  const MapReader map(value, "timeline", {"phases", "events"}, scope);
  ReadPhases(map.Find("phases"), out.duration_s, scope, out.phases);
  std::map<std::string, SourceRef> names;
  for (const ValuePtr& item : Items(map.Find("events"), "timeline.events", scope)) {
    const MapReader event(*item, "event", {"push", "drag"}, scope);
    const std::string kind = event.ExactlyOne({"push", "drag"});
    if (kind.empty()) continue;
    const Value& found = *event.Find(kind);
    std::string name;
    if (kind == "push") {
      out.pushes.push_back(ReadPush(found, robot, scope));
      name = out.pushes.back().name;
    } else {
      out.drags.push_back(ReadDrag(found, robot, scope));
      name = out.drags.back().name;
    }
    if (name.empty()) continue;
    const SourceRef at = found.Find("name")->at;
    const auto [first, fresh] = names.emplace(name, at);
    if (!fresh) {
      scope.out.Error(at, "there are two events " + name,
                      "the first is in line " + std::to_string(first->second.line));
    }
  }
}

}  // namespace taut::description
