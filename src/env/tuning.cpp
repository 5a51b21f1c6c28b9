#include "env/tuning.h"

#include <algorithm>
#include <map>
#include <string>

#include "base/assert.h"
#include "taut/study.h"

namespace taut::env {

Tuning::Tuning(const Plan& plan) {
  const std::vector<EnvironmentAction>& actions = plan.spec.actions;
  const bool any = std::any_of(actions.begin(), actions.end(),
                               [](const EnvironmentAction& action) { return action.by; });
  if (!any) return;
  lanes_.resize(static_cast<std::size_t>(plan.lanes));
  for (Lane& lane : lanes_) {
    lane.controllers = plan.experiment.controllers;
    std::vector<ScaleSpec> none;
    std::map<std::string, Tunable> by_name;
    for (Tunable& tunable : FindTunables(lane.controllers, none, plan.experiment.robot)) {
      by_name.emplace(tunable.name, tunable);
    }
    for (std::size_t i = 0; i < actions.size(); ++i) {
      for (const std::string& name : actions[i].numbers) {
        const auto found = by_name.find(name);
        TAUT_ASSERT(found != by_name.end());  // checked by `CheckEnvironment`
        const Tunable& tunable = found->second;
        if (&lane == &lanes_[0]) {
          // Not clamped, since action 0 must reproduce the experiment.
          const double base = *tunable.value;
          moved_.push_back({i, lane.numbers.size(), base, *actions[i].by,
                            std::min(tunable.min, base), std::max(tunable.max, base)});
        }
        lane.numbers.push_back(tunable.value);
      }
    }
  }
}

void Tuning::Begin(int lane) {
  for (const Moved& moved : moved_) {
    *lanes_[static_cast<std::size_t>(lane)].numbers[moved.number] = moved.base;
  }
}

void Tuning::Set(int lane, const double* action, std::size_t stride, plant::Loop& loop) {
  Lane& own = lanes_[static_cast<std::size_t>(lane)];
  bool changed = false;
  for (const Moved& moved : moved_) {
    const double x = moved.base + moved.by * action[moved.action * stride];
    const double number = std::clamp(x, moved.least, moved.most);
    changed = changed || number != *own.numbers[moved.number];
    *own.numbers[moved.number] = number;
  }
  if (changed) loop.Retune(lane, own.controllers);
}

}  // namespace taut::env
