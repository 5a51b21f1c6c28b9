// Goal of an experiment, and checks that gaits that need one have it.
#include <algorithm>

#include "description/experiment/experiment_parts.h"

namespace taut::description {

std::optional<GoalSpec> ToGoal(const GoalText& text, const RobotSpec* robot, const Scope& scope) {
  GoalSpec goal = text;
  if (!robot || text.body_name.text.empty()) return goal;
  std::vector<std::string> names;
  for (const BodyDef& body : robot->def.bodies) names.push_back(body.name);
  const auto found = std::find(names.begin(), names.end(), text.body_name.text);
  if (found == names.end()) {
    scope.out.Error("goal.unknown_body", text.body_name.at,
                    "goal.body: there is no body " + text.body_name.text,
                    NameHint(text.body_name.text, names));
    return std::nullopt;
  }
  goal.body = static_cast<int>(found - names.begin());
  return goal;
}

namespace {

constexpr const char* kSayWhere =
    "add its position and the tracked body: `goal: {at_m: [3.5, 0, 0], body: ...}`";

/// Reports a gait that needs a goal if the experiment has none. Neural networks accept a goal in
/// any frame. The rolling gait needs it in frame W, because it combines the goal's direction with
/// the directions of the struts.
void CheckGoalIsSensed(const ExperimentSpec& experiment, const GaitSpec& gait, Diagnostics& out) {
  if (gait.feedback_cpg && gait.feedback_cpg->goal_network && !experiment.goal) {
    out.Error("gait.goal_network_without_goal", gait.feedback_cpg->goal_network->at,
              "gait " + gait.name + " has a goal_network, but the experiment has no `goal`",
              kSayWhere);
  }
  if (!gait.toward_goal) return;
  if (!experiment.goal) {
    out.Error("gait.toward_goal_without_goal", gait.toward_goal->at,
              "gait " + gait.name + " moves toward a goal, but the experiment has no `goal`",
              kSayWhere);
  } else if (experiment.goal->frame != GoalFrame::kOfWorld) {
    out.Error("gait.goal_in_other_frame", gait.toward_goal->at,
              "gait " + gait.name + " needs the direction to the goal in the world frame",
              "write `goal: {frame: world, ...}`: a rolling body has no forward direction");
  }
}

}  // namespace

void CheckGoalIsSensed(const ExperimentSpec& experiment, Diagnostics& out) {
  for (const ControllerSpec& controller : experiment.controllers) {
    const GaitInputSpec* input = GaitInputOf(controller);
    for (std::size_t g = 0; input != nullptr && g <= input->others.size(); ++g) {
      CheckGoalIsSensed(experiment, GaitOf(*input, g), out);
    }
  }
}

}  // namespace taut::description
