// Reinforcement-learning environment of an experiment: actions and their checks.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/experiment/environment_keys.h"
#include "description/experiment/experiment_parts.h"
#include "description/experiment/match_tunables.h"

namespace taut::description {
namespace {

/// Controller that drives a cable (null if none), and whether it is an impedance controller.
struct Driver {
  const ControllerSpec* controller = nullptr;
  bool by_impedance = false;
};

std::vector<Driver> DriversOf(const ExperimentSpec& experiment, const RobotSpec& robot) {
  std::vector<Driver> drivers(robot.def.cables.size());
  for (const ControllerSpec& controller : experiment.controllers) {
    const auto drive = [&](int cable, bool by_impedance) {
      drivers[static_cast<std::size_t>(cable)] = {&controller, by_impedance};
    };
    if (controller.rest_length_input) {
      Diagnostics heard_before;
      const auto gait = ResolveGait(controller.rest_length_input->gait, robot, heard_before);
      for (std::size_t i = 0; gait && i < gait->cables.size(); ++i) drive(gait->cables[i], false);
    }
    for (const PositionProgram& program : controller.position) drive(program.cable, false);
    if (!controller.impedance) continue;
    for (const ImpedanceGains& gains : controller.impedance->cables) drive(gains.cable, true);
  }
  return drivers;
}

/// Returns the reason why an action cannot change a cable. Returns an empty text if the action can
/// change the cable, or is invalid for another reason.
std::string Obstacle(const EnvironmentAction& action, const CableDef& cable, const Driver& driver) {
  const bool by_length = action.rest_length_m || action.rest_length_rate_m_per_s;
  if (by_length == action.velocity_input_m_per_s.has_value()) return {};
  if (cable.actuator.kind == ActuatorDef::Kind::kNone) return "it has no actuator";
  if (by_length) {
    return driver.controller ? "controller " + driver.controller->name + " drives it" : "";
  }
  if (!driver.controller || !driver.by_impedance) return "no controller drives it by impedance";
  if (!driver.controller->velocity_input) return {};
  return "a gait already is the velocity_input of controller " + driver.controller->name;
}

class Actions {
 public:
  Actions(const RobotSpec& robot, bool drivers_known, const ExperimentSpec& experiment,
          const Scope& scope)
      : robot_(robot),
        drivers_known_(drivers_known),
        drivers_(DriversOf(experiment, robot)),
        controllers_(experiment.controllers),
        scope_(scope) {
    std::vector<ScaleSpec> none;
    if (drivers_known) tunables_ = FindTunables(controllers_, none, robot);
  }

  void Add(const EnvironmentActionText& text) {
    if (text.cables.value) AddCables(text, *text.cables.value);
    if (text.each.value) AddNumbers(text, *text.each.value, "environment.actions.each");
    if (text.all.value) AddNumbers(text, *text.all.value, "environment.actions.all");
  }

  std::vector<EnvironmentAction> Take() {
    std::sort(of_cables_.begin(), of_cables_.end(), [](const auto& a, const auto& b) {
      return a.cable < b.cable;  // equal cables have been reported
    });
    of_cables_.insert(of_cables_.end(), of_numbers_.begin(), of_numbers_.end());
    return std::move(of_cables_);
  }

 private:
  void AddCables(const EnvironmentActionText& text, const Value& selector) {
    std::map<std::string, std::string> refused;  // Names of cables by reason.
    for (const int cable : SelectCables(selector, "environment.actions.cables", &robot_, scope_)) {
      const auto index = static_cast<std::size_t>(cable);
      const CableDef& def = robot_.def.cables[index];
      EnvironmentAction& action = of_cables_.emplace_back(text);
      action.cable = cable;
      std::string why = drivers_known_ ? Obstacle(action, def, drivers_[index]) : "";
      const auto [first, fresh] = given_.emplace(cable, selector.at.line);
      if (!fresh) why = "it already has an action, in line " + std::to_string(first->second);
      if (why.empty()) continue;
      std::string& names = refused[why];
      names += (names.empty() ? "" : ", ") + def.name;
    }
    for (const auto& [why, names] : refused) {
      scope_.out.Error("environment.action_moves_nothing", selector.at,
                       "environment.actions: no action can change " + names, why);
    }
  }

  void AddNumbers(const EnvironmentActionText& text, const Value& patterns,
                  const std::string& what) {
    if (!drivers_known_) return;
    const std::size_t errors_before = scope_.out.items().size();
    EnvironmentAction action = text;
    action.cable = kWorld;
    for (const std::size_t i : MatchTunables(patterns, what, tunables_, scope_)) {
      const Tunable& tunable = tunables_[i];
      const auto [first, fresh] = taken_.emplace(tunable.name, patterns.at.line);
      if (!fresh) {
        scope_.out.Error("environment.action_overlap", patterns.at,
                         "environment.actions: two actions change " + tunable.name,
                         "the first is in line " + std::to_string(first->second));
      } else if (tunable.at_start) {
        scope_.out.Error("environment.action_moves_nothing", patterns.at,
                         "environment.actions: no action can change " + tunable.name,
                         "a gait reads it only at its start");
      }
      action.numbers.push_back(tunable.name);
      if (text.all.value) continue;
      of_numbers_.push_back(action);
      action.numbers.clear();
    }
    if (!text.all.value || action.numbers.empty()) return;
    if (action.name.empty()) action.name = action.numbers[0];
    const auto named = [&](const auto& other) { return NameOf(other) == action.name; };
    if (scope_.out.items().size() == errors_before &&
        std::any_of(of_numbers_.begin(), of_numbers_.end(), named)) {
      scope_.out.Error("environment.duplicate_action",
                       text.name_at.line > 0 ? text.name_at : patterns.at,
                       "environment.actions: two actions are called " + action.name);
    }
    of_numbers_.push_back(std::move(action));
  }
  static const std::string& NameOf(const EnvironmentAction& action) {
    return action.name.empty() ? action.numbers[0] : action.name;
  }

  const RobotSpec& robot_;
  bool drivers_known_;
  std::vector<Driver> drivers_;
  std::vector<ControllerSpec> controllers_;
  std::vector<Tunable> tunables_;  ///< Tunables of `controllers_`.
  const Scope& scope_;
  std::vector<EnvironmentAction> of_cables_, of_numbers_;
  std::map<int, int> given_;          ///< Line of the action, per cable.
  std::map<std::string, int> taken_;  ///< Line of the action, per tunable name.
};

/// Returns the position of a key in a part of the environment block.
SourceRef PlaceOf(const Value& block, std::string_view part, std::string_view key) {
  const Value* const inner = block.Find(part);
  return inner ? KeyAt(*inner, key) : block.at;
}

void CheckDelay(const Value& block, const char* key, double delay_s, double period_s,
                const Scope& scope) {
  constexpr double kMostPeriods = 1000;
  const double periods = delay_s / period_s;
  if (std::isnan(periods)) return;
  const std::string path = "environment.randomise." + std::string(key);
  const SourceRef at = PlaceOf(block, "randomise", key);
  if (periods > kMostPeriods) {
    scope.out.Error("environment.delay_too_long", at,
                    path + " must not be longer than 1000 periods",
                    "the period is " + Shown(period_s) + " s");
  } else if (std::fabs(periods - std::floor(periods + 0.5)) > 1e-6) {
    scope.out.Error("environment.delay_not_whole", at,
                    path + " must be a whole number of periods, got " + Shown(periods),
                    "environment.period_s is " + Shown(period_s));
  }
}

}  // namespace

void Check(const MapReader& map, EnvironmentActionText& action) {
  action.name_at = map.KeyAt("name");
  const auto only = [&](const char* key, const char* with) {
    if (map.Has(key))
      map.Error("environment.key_needs_key", key,
                map.Path(key) + " is allowed with " + with + " only");
  };
  if (action.cables.value) {
    only("by", "`each` or `all`");
    only("name", "`all`");
  } else if (action.each.value || action.all.value) {
    for (const char* const key :
         {"rest_length_m", "rest_length_rate_m_per_s", "velocity_input_m_per_s"}) {
      only(key, "`cables`");
    }
    if (action.each.value) only("name", "`all`");
  }
}

void Check(const MapReader& map, EnvironmentReward& reward) { CheckObjective(map, reward); }

void Check(const MapReader& map, EnvironmentText& environment) {
  environment.period_at = map.KeyAt("period_s");
  for (Placed& channel : environment.observation_texts) {
    environment.observations.push_back(std::move(channel.text));
    environment.observation_sources.push_back(std::move(channel.at));
  }
  for (const char* const key : {"actions", "observations"}) {
    const Value* const list = map.Find(key);
    if (!list || list->kind != Value::Kind::kSequence || !list->items.empty()) continue;
    map.Error("environment.empty_list", key, map.Path(key) + " is empty", "add at least one entry");
  }
}

EnvironmentSpec ToEnvironment(const EnvironmentText& text, const Value& block,
                              const RobotSpec* robot, bool drivers_known,
                              const ExperimentSpec& experiment, const Scope& scope) {
  EnvironmentSpec out = text;
  if (robot) {
    Actions actions(*robot, drivers_known, experiment, scope);
    for (const EnvironmentActionText& action : text.action_texts) actions.Add(action);
    out.actions = actions.Take();
  } else {
    for (const EnvironmentActionText& action : text.action_texts) {
      if (action.cables.value) {
        SelectCables(*action.cables.value, "environment.actions.cables", nullptr, scope);
      }
    }
  }
  const EnvironmentReward& reward = out.reward;
  if (reward.from_s >= experiment.duration_s) {
    scope.out.Error("environment.reward_after_end", PlaceOf(block, "reward", "from_s"),
                    "environment.reward.from_s must be before the end of the experiment",
                    "the end is at " + Shown(experiment.duration_s) + " s");
  }
  if (reward.measure == Measure::kNearer && !experiment.goal) {
    scope.out.Error("environment.reward_needs_goal", PlaceOf(block, "reward", "measure"),
                    "environment.reward.measure: nearer needs a goal",
                    "add a `goal` to the experiment");
  }
  const EnvironmentVariation& varied = out.randomise;
  if (varied.start.goal_rad > 0 && !experiment.goal) {
    scope.out.Error("environment.start_needs_goal", PlaceOf(block, "randomise", "start"),
                    "environment.randomise.start.goal_rad: the experiment has no `goal`");
  }
  CheckDelay(block, "action_delay_s", varied.action_delay_s, out.period_s, scope);
  CheckDelay(block, "observation_delay_s", varied.observation_delay_s, out.period_s, scope);
  return out;
}

}  // namespace taut::description
