// Timeline of an experiment: phases and events.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/experiment/experiment_keys.h"
#include "description/experiment/experiment_parts.h"

namespace taut::description {
namespace {

/// Returns the index of the node; 0 after an error or if the robot is unknown.
int FindNode(const Placed& name, const RobotSpec* robot, const Scope& scope) {
  if (name.text.empty() || !robot) return 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot->def.nodes.size(); ++i) {
    names.push_back(robot->def.nodes[i].name);
    if (names.back() == name.text) return static_cast<int>(i);
  }
  scope.out.Error("node.unknown", name.at, "there is no node \"" + name.text + "\"",
                  NameHint(name.text, names));
  return 0;
}

void AddPhases(const Named<Raw<SpanForm>>& phases, double duration_s, const Scope& scope,
               std::vector<PhaseSpec>& out) {
  for (const auto& item : phases.items) {
    PhaseSpec phase;
    phase.name = item.name;
    const std::string what = "phase " + item.name;
    const auto span = ReadNumbers(*item.value.value, what, 2, scope);
    if (!span) continue;
    phase.from_s = (*span)[0];
    phase.to_s = (*span)[1];
    const std::string shown = Shown(phase.from_s) + ".." + Shown(phase.to_s) + " s";
    if (phase.from_s >= phase.to_s) {
      scope.out.Error("event.ends_before_start", item.at,
                      what + " must end after it begins, got " + shown);
    } else if (phase.from_s < 0.0 || phase.to_s > duration_s) {
      scope.out.Error(
          "event.outside_experiment", item.at,
          what + " must be within the experiment, 0.." + Shown(duration_s) + " s, got " + shown);
    }
    out.push_back(std::move(phase));
  }
}

}  // namespace

void Check(const MapReader& map, PushText& push) {
  if (push.force_n.size() == 1) {
    map.scope().out.Error("event.few_points", map.Find("force_n")->at,
                          "push.force_n needs two points or more",
                          "the force is zero before the first and after the last one");
  }
}

void Check(const MapReader& map, DragText& drag) {
  const Vec3& v = drag.velocity_m_per_s;
  if (v.x == 0.0 && v.y == 0.0 && v.z == 0.0) {
    map.Error("event.no_velocity", "velocity_m_per_s", "drag.velocity_m_per_s must not be zero",
              "the force is measured along the velocity");
  }
  if (drag.from_s >= drag.to_s) {
    map.Error(
        "event.ends_before_start", "to_s",
        "drag.to_s must be after from_s, got " + Shown(drag.from_s) + ".." + Shown(drag.to_s));
  }
}

void Check(const MapReader& map, EventText& event) {
  for (const char* kind : {"push", "drag"}) {
    const Value* found = map.Find(kind);
    const Value* name = found ? found->Find("name") : nullptr;
    if (name) event.name_at = name->at;
  }
}

void AddTimeline(const TimelineText& text, const RobotSpec* robot, const Scope& scope,
                 ExperimentSpec& out) {
  AddPhases(text.phases, out.duration_s, scope, out.phases);
  std::map<std::string, SourceRef> names;
  for (const EventText& event : text.events) {
    std::string name;
    if (event.push) {
      out.pushes.push_back(*event.push);
      out.pushes.back().node = FindNode(event.push->node_name, robot, scope);
      name = event.push->name;
    } else if (event.drag) {
      out.drags.push_back(*event.drag);
      out.drags.back().node = FindNode(event.drag->node_name, robot, scope);
      name = event.drag->name;
    }
    if (name.empty()) continue;
    const auto [first, fresh] = names.emplace(name, event.name_at);
    if (!fresh) {
      scope.out.Error("event.duplicate_name", event.name_at, "two events are called " + name,
                      "the first is in line " + std::to_string(first->second.line));
    }
  }
}

}  // namespace taut::description
