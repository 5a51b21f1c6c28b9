#include "report_facts.h"

#include <fmt/format.h>

#include <cmath>

namespace taut::viewer {
namespace {

std::string Counted(std::size_t count, const char* what, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? what : many);
}

std::string Robot(const ModelDef& def) {
  double mass_kg = 0;
  for (const BodyDef& body : def.bodies) mass_kg += body.mass_kg;
  return fmt::format("{}: {}, {}, {:.4g} kg", def.name,
                     Counted(def.bodies.size(), "body", "bodies"),
                     Counted(def.cables.size(), "cable", "cables"), mass_kg);
}

const char* Start(StartKind start) {
  switch (start) {
    case StartKind::kAsDescribed:
      return "as described";
    case StartKind::kSettled:
      return "settled on the ground, at rest";
    case StartKind::kSettledFloating:
      return "settled without weight and ground, at rest";
  }
  return "";
}

std::string Controller(const ControllerSpec& controller) {
  std::size_t cables =
      controller.impedance ? controller.impedance->cables.size() : controller.position.size();
  std::string how = controller.impedance ? "impedance of" : "rest lengths of";
  if (const GaitInputSpec* gait = GaitInputOf(controller)) {
    if (controller.impedance == std::nullopt && cables == 0) {
      return fmt::format("{}: gait {}, every {:g} s", controller.name, gait->gait.name,
                         controller.clock.period_s);
    }
    how = fmt::format("gait {} and {}", gait->gait.name, how);
  }
  return fmt::format("{}: {} {}, every {:g} s", controller.name, how,
                     Counted(cables, "cable", "cables"), controller.clock.period_s);
}

std::string Push(const PushSpec& push, const std::vector<NodeDef>& nodes) {
  double most_n = 0;
  for (const auto& [time_s, force_n] : push.force_n) {
    if (std::abs(push.scale * force_n) > std::abs(most_n)) most_n = push.scale * force_n;
  }
  const double from_s = push.force_n.empty() ? 0 : push.force_n.front().first;
  const double to_s = push.force_n.empty() ? 0 : push.force_n.back().first;
  return fmt::format("{} on {}, up to {:.4g} N, {:g} to {:g} s", push.name,
                     nodes[static_cast<std::size_t>(push.node)].name, most_n, from_s, to_s);
}

template <class List, class Text>
void Add(Json& facts, const char* what, const List& list, const Text& text) {
  std::string all;
  for (const auto& item : list) all += (all.empty() ? "" : "; ") + text(item);
  if (!all.empty()) facts[what] = all;
}

}  // namespace

Json FactsOf(const ExperimentSpec& experiment) {
  const ModelDef& def = experiment.robot.def;
  Json facts = Json::object();
  facts["robot"] = Robot(def);
  facts["time"] =
      fmt::format("{:g} s in steps of {:g} s", experiment.duration_s, experiment.step_s);
  facts["start"] = Start(experiment.start);
  Add(facts, "control", experiment.controllers, Controller);
  Add(facts, "pushes", experiment.pushes,
      [&](const PushSpec& push) { return Push(push, def.nodes); });
  Add(facts, "drags", experiment.drags, [&](const DragSpec& drag) {
    return fmt::format("{} of {}, {:g} to {:g} s", drag.name,
                       def.nodes[static_cast<std::size_t>(drag.node)].name, drag.from_s, drag.to_s);
  });
  return facts;
}

}  // namespace taut::viewer
