/// The keys of what an experiment is to learners (docs/environments.md).
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
         "Some cables, or some numbers of controllers and gaits, each with a number of its own in "
         "the action, -1 to 1. 0 is what the experiment does without a learner.");
  if constexpr (Io::kResolved) {
    io("cable", a.cable);
  } else {
    io.OneOf({"cables", "each", "all"});
    io.OneOf({"rest_length_m", "rest_length_rate_m_per_s", "velocity_input_m_per_s", "by"});
    io.Rule(R"("if": {"required": ["cables"]}, )"
            R"("then": {"not": {"anyOf": [{"required": ["by"]}, {"required": ["name"]}]}}, )"
            R"("else": {"required": ["by"]})");
    io("cables", a.cables,
       "Which cables. An action has them in the order of the model's cables, before all others.",
       Example{R"("driven")"});
  }
  io("rest_length_m", a.rest_length_m, Bound::kPositive,
     "What 1 adds to the rest length that is commanded at the start. For cables that no controller "
     "drives.");
  io("rest_length_rate_m_per_s", a.rest_length_rate_m_per_s, Bound::kPositive,
     "How fast 1 lengthens what is commanded. For cables that no controller drives.");
  io("velocity_input_m_per_s", a.velocity_input_m_per_s, Bound::kPositive,
     "What 1 adds to V0 of impedance control. For cables of a controller with `impedance` and "
     "without `velocity_input`.");
  if constexpr (Io::kResolved) {
    io("numbers", a.numbers, kLater);
  } else {
    io("each", a.each,
       "Numbers of the controllers and their gaits, by the names that a study's `vary` has for "
       "them, `*` for any letters: set points and gains of impedance control, frequencies, "
       "amplitudes and phases of a gait. Each that fits has an action of its own.",
       Example{R"("hold.*.tension_offset_n")"});
    io("all", a.all, "The same, with one action for all that fit together.",
       Example{R"("hold.sine.*.amplitude_m_per_s")"});
  }
  io("by", a.by, Bound::kPositive,
     "What 1 adds to the number, in its unit. The sum stays within the bounds that the number has "
     "anywhere: no tension below 0. A frequency that changes does so without a jump of the phase.");
  io("name", a.name, kName, kLater,
     "Of an action on `all` of some numbers. That of the first of them if absent.");
}
void Check(const MapReader& map, EnvironmentActionText& action);

template <class Io>
void Keys(Io& io, Like<EnvironmentReward> auto& r) {
  io.Map("", "environment.reward",
         "What a step is worth: by how much the score of a study with this objective would grow, "
         "and more. Without an early end the rewards of an episode add up to that score.");
  io("measure", r.measure, kRewardMeasures,
     "As of a study's objective: `distance`, `heading` or `nearer` [m]. `none`: only what is below "
     "counts, or what a program says.");
  ObjectiveKeys(io, r);
  io("alive_per_s", r.alive_per_s, Bound::kNonNegative, "For every second of an episode.");
  io("work_penalty_per_j", r.work_penalty_per_j, Bound::kNonNegative,
     "Taken for every joule of the motors' work, tension times winding in.");
  io("failure_penalty", r.failure_penalty, Bound::kNonNegative,
     "Taken when a world fails: it is not finite any more, too fast, off its terrain, or a cable "
     "pulls more than `max_tension_n`.");
}
void Check(const MapReader& map, EnvironmentReward& reward);

template <class Io>
void Keys(Io& io, Like<EnvironmentVariation> auto& v) {
  io.Map("", "environment.randomise",
         "How episodes differ, each by its seed. What of the experiment depends on the seed "
         "(`start_noise`, the errors of `sensors`) differs, too.");
  VariationKeys(io, v);
  io("slope_rad", v.slope_rad,
     Bound{.least = 0.0,
           .most = 0.5 * 3.14159265358979323846,
           .below_most = true,
           .most_text = "pi / 2"},
     "Gravity is turned by up to this about a horizontal axis, any of them: the terrain lies "
     "aslant.");
  io("action_delay_s", v.action_delay_s, Bound::kNonNegative,
     "Actions act by up to this later: whole periods, drawn once an episode.");
  io("observation_delay_s", v.observation_delay_s, Bound::kNonNegative,
     "Observations come by up to this later, likewise.");
  io("starts", v.starts, Bound{.least = 0, .most = 100'000},
     "How many different episodes there are: seeds count modulo this, and each start is prepared "
     "once and kept. 0: no two are alike, and each is prepared anew, which takes long where a "
     "robot settles first.");
}

template <class Io, Either<EnvironmentSpec, EnvironmentText> Environment>
void Keys(Io& io, Environment& e) {
  io.Map("environment", "environment",
         "The experiment as an environment for learners, docs/environments.md: what they may do, "
         "what they see, what they are rewarded for. `duration_s` is how long an episode lasts. "
         "`taut run` does not look at it.",
         R"({"actions": [{"cables": "driven", "rest_length_m": 0.05}], )"
         R"("observations": ["cable/*/tension_n"]})");
  io("period_s", e.period_s, Bound::kPositive,
     "Time from action to action: a whole multiple of `step_s` and of the periods of all "
     "controllers and sensors.");
  if constexpr (Io::kResolved) {
    io("actions", e.actions);
    io("observations", e.observations);
  } else {
    io("actions", e.action_texts, kNeeded, "What an action is, number by number.");
    io("observations", e.observation_texts, kNeeded,
       "Names of trace channels (docs/formats/trace.md), `*` stands for any text. They are "
       "observed in the order in which a trace has them.",
       Example{R"(["body/*/position_z_m", "cable/*/tension_n"])"});
  }
  io("reward", e.reward);
  io("max_tension_n", e.max_tension_n, Bound::kPositive,
     "An episode ends as failed once a cable pulls more than this.");
  io("randomise", e.randomise);
}
void Check(const MapReader& map, EnvironmentText& environment);

}  // namespace taut::description
