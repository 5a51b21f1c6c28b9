/// Keys of reinforcement-learning environments (docs/environments.md).
#pragma once

#include "description/experiment/experiment_text.h"
#include "description/experiment/objective_keys.h"

namespace taut::description {

inline const Choices<Measure> kRewardMeasures{{"none", Measure::kNone},
                                              {"distance", Measure::kDistance},
                                              {"heading", Measure::kHeading},
                                              {"nearer", Measure::kNearer}};

template <class Io, Either<EnvironmentAction, EnvironmentActionText> Action>
void Keys(Io& io, Action& a) {
  io.Map("", "environment.actions",
         "Action on selected cables, or on parameters of controllers and gaits, with values from "
         "-1 to 1. The value 0 leaves the experiment unchanged.");
  if constexpr (Io::kResolved) {
    io("cable", a.cable);
  } else {
    io.OneOf({"cables", "each", "all"});
    io.OneOf({"rest_length_m", "rest_length_rate_m_per_s", "velocity_input_m_per_s", "by"});
    io.Rule(R"("if": {"required": ["cables"]}, )"
            R"("then": {"not": {"anyOf": [{"required": ["by"]}, {"required": ["name"]}]}}, )"
            R"("else": {"required": ["by"]})");
    io("cables", a.cables,
       "Cable selector. Components for cables come first in the action vector, in the order of the "
       "model's "
       "cables.",
       Example{R"("driven")"});
  }
  io("rest_length_m", a.rest_length_m, Bound::kPositive,
     "Length that an action of 1 adds to the initially commanded rest length. Only for cables "
     "without a "
     "controller.");
  io("rest_length_rate_m_per_s", a.rest_length_rate_m_per_s, Bound::kPositive,
     "Rate at which an action of 1 lengthens the commanded rest length. For cables without a "
     "controller.");
  io("velocity_input_m_per_s", a.velocity_input_m_per_s, Bound::kPositive,
     "Velocity that an action of 1 adds to V0 of impedance control. For cables of a controller "
     "with `impedance` and without `velocity_input`.");
  if constexpr (Io::kResolved) {
    io("numbers", a.numbers, kLater);
  } else {
    io("each", a.each,
       "Parameters of controllers and gaits, named as in a study's `vary`; `*` stands for any "
       "text. They are set points and gains of impedance control, and frequencies, amplitudes and "
       "phases of a gait. The action has one component per matching parameter.",
       Example{R"("hold.*.tension_offset_n")"});
    io("all", a.all,
       "As `each`, but with one common component of the action for all matching parameters.",
       Example{R"("hold.sine.*.amplitude_m_per_s")"});
  }
  io("by", a.by, Bound::kPositive,
     "Amount that an action of 1 adds to the parameter, in its unit. The sum is limited to the "
     "parameter's valid range, so a tension, for example, does not become negative. If a frequency "
     "changes, the phase stays "
     "continuous.");
  io("name", a.name, kName, kLater,
     "Name of an action that uses `all`. Default: the name of the first matching parameter.");
}
void Check(const MapReader& map, EnvironmentActionText& action);

template <class Io>
void Keys(Io& io, Like<EnvironmentReward> auto& r) {
  io.Map(
      "", "environment.reward",
      "Reward of a step: increase of the score that a study with this objective computes, plus the "
      "terms below. Without these terms and early termination, the rewards of an episode sum to "
      "that score.");
  io("measure", r.measure, kRewardMeasures,
     "Objective as in a study: `distance`, `heading` or `nearer` [m]. `none`: only the terms "
     "below, or a reward that your program computes.");
  ObjectiveKeys(io, r);
  io("alive_per_s", r.alive_per_s, Bound::kNonNegative, "Reward per second of an episode.");
  io("work_penalty_per_j", r.work_penalty_per_j, Bound::kNonNegative,
     "Penalty per joule of motor work, tension times wound-in length.");
  io("failure_penalty", r.failure_penalty, Bound::kNonNegative,
     "Penalty if a world fails: its state is not finite, a body is too fast or off the terrain, or "
     "a cable tension exceeds `max_tension_n`.");
}
void Check(const MapReader& map, EnvironmentReward& reward);

template <class Io>
void Keys(Io& io, Like<EnvironmentVariation> auto& v) {
  io.Map("", "environment.randomise",
         "Domain randomization: differences between episodes, drawn from the seed of each episode. "
         "Parts "
         "of the experiment that depend on the seed (`start_noise`, the errors of `sensors`) also "
         "differ between episodes.");
  VariationKeys(io, v);
  io("slope_rad", v.slope_rad,
     Bound{.least = 0.0,
           .most = 0.5 * 3.14159265358979323846,
           .below_most = true,
           .most_text = "pi / 2"},
     "Largest rotation of gravity about a random horizontal axis: equivalent to a slope of the "
     "terrain.");
  io("action_delay_s", v.action_delay_s, Bound::kNonNegative,
     "Largest delay of actions: whole periods, drawn once per episode.");
  io("observation_delay_s", v.observation_delay_s, Bound::kNonNegative,
     "Largest delay of observations: whole periods, drawn once per episode.");
  io("starts", v.starts, Bound{.least = 0, .most = 100'000},
     "Number of different episodes: the seed modulo this number selects the episode, and each "
     "start is prepared "
     "once and kept. With 0, all episodes differ and each start is prepared separately, which is "
     "slow if the "
     "robot settles first.");
}

template <class Io, Either<EnvironmentSpec, EnvironmentText> Environment>
void Keys(Io& io, Environment& e) {
  io.Map("environment", "environment",
         "Environment for reinforcement learning (docs/environments.md): actions, observations, "
         "reward, domain randomization. `duration_s` is the length of an episode. `taut run` "
         "ignores this key.",
         R"({"actions": [{"cables": "driven", "rest_length_m": 0.05}], )"
         R"("observations": ["cable/*/tension_n"]})");
  io("period_s", e.period_s, Bound::kPositive,
     "Time between actions: a whole multiple of `step_s` and of the periods of controllers, gaits, "
     "sensors and the goal.");
  if constexpr (Io::kResolved) {
    io("actions", e.actions);
    io("observations", e.observations);
  } else {
    io("actions", e.action_texts, kNeeded, "List of the components of the action vector.");
    io("observations", e.observation_texts, kNeeded,
       "Observations: names of trace channels (docs/formats/trace.md), where `*` stands for any "
       "text. The observation vector has the order of the channels in a trace.",
       Example{R"(["body/*/position_z_m", "cable/*/tension_n"])"});
  }
  io("reward", e.reward);
  io("max_tension_n", e.max_tension_n, Bound::kPositive,
     "Cable tension above which an episode terminates as failed.");
  io("randomise", e.randomise);
}
void Check(const MapReader& map, EnvironmentText& environment);

}  // namespace taut::description
