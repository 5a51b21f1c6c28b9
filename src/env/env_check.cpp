// Checks of environments: periods on the grid of steps, actions and observed channels.
#include <cmath>
#include <set>
#include <string>

#include "base/brief.h"
#include "description/experiment/partial_load.h"
#include "env/plan.h"
#include "plant/recorder.h"
#include "taut/run.h"
#include "taut/study.h"

namespace taut {
namespace {

/// Tolerance for multiples of the step. All times must be multiples of the step, so that all lanes
/// take the same steps at any time of their episodes (src/plant/schedule.h).
constexpr double kRounding = 1e-9;

bool IsWhole(double ratio) {
  return std::fabs(ratio - std::floor(ratio + 0.5)) <= kRounding * std::fmax(1.0, ratio);
}

class Clocks {
 public:
  Clocks(const ExperimentSpec& experiment, Diagnostics& out)
      : experiment_(experiment), spec_(*experiment.environment), out_(out) {}

  void Check() {
    const double period_s = spec_.period_s, step_s = experiment_.step_s;
    if (!(period_s > 0))
      return Error("environment.period_not_positive",
                   "must be positive, got " + base::Shortest(period_s), "");
    if (!IsWhole(period_s / step_s) || period_s < 0.5 * step_s) {
      Error("environment.period_not_whole",
            "must be a whole multiple of the step, got " + base::Shortest(period_s / step_s) +
                " steps",
            "step_s is " + base::Shortest(step_s));
    }
    const double periods = experiment_.duration_s / period_s;
    if (!IsWhole(periods) || periods < 0.5) {
      Error("environment.period_not_whole",
            "must divide duration_s into whole periods, got " + base::Shortest(periods),
            "an episode lasts duration_s, " + base::Shortest(experiment_.duration_s) + " s");
    }
    for (const ControllerSpec& controller : experiment_.controllers) {
      Check(controller.clock, "controller " + controller.name);
      const GaitInputSpec* const input = GaitInputOf(controller);
      if (input) Check(input->clock, "the gait of controller " + controller.name);
    }
    if (experiment_.sensors) Check({experiment_.sensors->period_s, 0.0}, "sensors");
    if (experiment_.goal) Check({experiment_.goal->period_s, 0.0}, "goal");
    for (const PushSpec& push : experiment_.pushes) {
      for (const auto& [time_s, force_n] : push.force_n) Corner(time_s, "push " + push.name);
    }
    for (const DragSpec& drag : experiment_.drags) {
      for (const double time_s : {drag.from_s, drag.to_s}) Corner(time_s, "drag " + drag.name);
    }
  }

 private:
  void Check(const ClockSpec& clock, const std::string& whose) {
    if (!IsWhole(spec_.period_s / clock.period_s)) {
      Error("environment.period_not_whole",
            "must be a whole multiple of the period of " + whose + ", " +
                base::Shortest(clock.period_s) + " s",
            "each action must span the same number of ticks");
    }
    OnGrid(clock.period_s, "the period of " + whose);
    OnGrid(clock.phase_s, "the phase of " + whose);
  }
  void Corner(double time_s, const std::string& whose) { OnGrid(time_s, "a corner of " + whose); }
  void OnGrid(double time_s, const std::string& what) {
    if (IsWhole(time_s / experiment_.step_s)) return;
    out_.Error("environment.period_not_whole", spec_.at,
               "environment: " + what + " must be a whole number of steps, got " +
                   base::Shortest(time_s) + " s",
               "step_s is " + base::Shortest(experiment_.step_s) +
                   "; all worlds must step at the same times");
  }
  void Error(MessageId id, const std::string& what, const std::string& hint) {
    out_.Error(id, spec_.period_at.line > 0 ? spec_.period_at : spec_.at,
               "environment.period_s " + what, hint);
  }

  const ExperimentSpec& experiment_;
  const EnvironmentSpec& spec_;
  Diagnostics& out_;
};

/// Checks actions of experiments that a program has created, since no file reader has checked them.
void CheckNumbers(const ExperimentSpec& experiment, Diagnostics& out) {
  const EnvironmentSpec& spec = *experiment.environment;
  std::vector<ControllerSpec> controllers = experiment.controllers;
  std::vector<ScaleSpec> none;
  std::set<std::string> known;
  for (const Tunable& number : FindTunables(controllers, none, experiment.robot)) {
    if (!number.at_start) known.insert(number.name);
  }
  const auto error = [&](const std::string& what) {
    out.Error("environment.bad_action", spec.at, "environment.actions: " + what);
  };
  for (const EnvironmentAction& action : spec.actions) {
    if (action.by && action.numbers.empty())
      error("an action with `by` needs at least one parameter");
    for (const std::string& name : action.numbers) {
      if (known.count(name) == 0)
        error("there is no parameter \"" + name + "\" that an action can change");
    }
  }
}

}  // namespace

std::int64_t env::Times(double whole_s, double part_s) noexcept {
  return static_cast<std::int64_t>(std::floor(whole_s / part_s + 0.5));
}

std::optional<ExperimentSpec> LoadExperimentAndChannels(const std::string& path,
                                                        const Overrides& overrides,
                                                        Diagnostics& out) {
  return description::LoadPartial(path, overrides, out, [&](const ExperimentSpec& read) {
    CheckRecord(read, out);
    if (!read.environment) return;
    const EnvironmentSpec& spec = *read.environment;
    plant::CheckChannels(read, spec.observations, spec.observation_sources,
                         "environment.observations", out);
  });
}

bool CheckEnvironment(const ExperimentSpec& experiment, Diagnostics& out) {
  const std::size_t before = out.items().size();
  if (!experiment.environment) {
    out.Error("environment.missing",
              experiment.files.empty() ? SourceRef{} : SourceRef{experiment.files[0]},
              "the experiment has no `environment`",
              "such as environment: {actions: [{cables: driven, rest_length_m: 0.05}], "
              "observations: [\"cable/*/tension_n\"]}");
    return false;
  }
  const EnvironmentSpec& spec = *experiment.environment;
  plant::CheckChannels(experiment, spec.observations, spec.observation_sources,
                       "environment.observations", out);
  Clocks(experiment, out).Check();
  CheckNumbers(experiment, out);
  return out.items().size() == before;
}

}  // namespace taut
