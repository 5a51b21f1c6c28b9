#include <fmt/format.h>

#include <cmath>
#include <string>

#include "plant/schedule.h"
#include "taut/run.h"

namespace taut {
namespace {

/// Clock with the shortest period.
struct Ticks {
  std::string of;  ///< Name of the clock's owner and a verb, for the message.
  double period_s = INFINITY;
};

Ticks FastestTicks(const ExperimentSpec& experiment) {
  Ticks fastest;
  const auto take = [&](double period_s, const std::string& of) {
    if (period_s < fastest.period_s) fastest = {of, period_s};
  };
  for (const ControllerSpec& controller : experiment.controllers) {
    const std::string name = fmt::format("controller \"{}\" has", controller.name);
    take(controller.clock.period_s, name);
    if (const GaitInputSpec* gait = GaitInputOf(controller)) {
      take(gait->clock.period_s, "the gait of " + name);
    }
  }
  if (experiment.sensors) take(experiment.sensors->period_s, "the sensors have");
  if (experiment.goal) take(experiment.goal->period_s, "the goal has");
  return fastest;
}

}  // namespace

double LongestStep(const ExperimentSpec& experiment) {
  const double period_s = FastestTicks(experiment).period_s;
  if (!std::isfinite(period_s)) return experiment.step_s;
  plant::Schedule schedule(experiment.step_s, INFINITY);
  schedule.Aim(period_s);
  return schedule.step_s();
}

void WarnOfStep(const ExperimentSpec& experiment, Diagnostics& out) {
  const Ticks fastest = FastestTicks(experiment);
  if (experiment.step_s <= fastest.period_s * (1 + 1e-9)) return;
  out.Warning("experiment.step_without_effect",
              {experiment.files.empty() ? "" : experiment.files[0]},
              fmt::format("step_s {:g} has no effect: {} a period of {:g} s, and steps are "
                          "shortened to end at every tick",
                          experiment.step_s, fastest.of, fastest.period_s),
              fmt::format("set step_s to {:g} or less, or use a longer period", fastest.period_s));
}

}  // namespace taut
