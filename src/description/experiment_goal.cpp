#include <algorithm>

#include "description/experiment_parts.h"

namespace taut::description {

std::optional<GoalSpec> ToGoal(const GoalText& text, const RobotSpec* robot, const Scope& scope) {
  GoalSpec goal = text;
  if (!robot || text.body_name.text.empty()) return goal;
  std::vector<std::string> names;
  for (const BodyDef& body : robot->def.bodies) names.push_back(body.name);
  const auto found = std::find(names.begin(), names.end(), text.body_name.text);
  if (found == names.end()) {
    scope.out.Error(text.body_name.at, "goal.body: there is no body " + text.body_name.text,
                    NameHint(text.body_name.text, names));
    return std::nullopt;
  }
  goal.body = static_cast<int>(found - names.begin());
  return goal;
}

void CheckGoalIsSensed(const ExperimentSpec& experiment, Diagnostics& out) {
  if (experiment.goal) return;
  for (const ControllerSpec& controller : experiment.controllers) {
    const GaitInputSpec* input = GaitInputOf(controller);
    for (std::size_t g = 0; input != nullptr && g <= input->others.size(); ++g) {
      const GaitSpec& gait = GaitOf(*input, g);
      if (!gait.feedback_cpg || !gait.feedback_cpg->goal_network) continue;
      out.Error(
          gait.feedback_cpg->goal_network->at,
          "gait " + gait.name + " has a goal_network, but the experiment has no `goal`",
          "say where it is and whose way there is sensed: goal: {at_m: [3.5, 0, 0], body: ...}");
    }
  }
}

}  // namespace taut::description
