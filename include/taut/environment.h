/// An experiment as an environment for learners: what they may do, what they see, what they are
/// rewarded for, when an episode ends, and how episodes differ (taut/env.h runs it,
/// docs/environments.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/objective.h"
#include "taut/variation.h"

namespace taut {

/// One number of an action, -1..1, and what it moves. 0 is what the experiment does without a
/// learner.
struct EnvironmentAction {
  int cable = 0;  ///< kWorld: it is of no cable.
  // What 1 stands for, > 0: one of them is there.
  std::optional<double> rest_length_m = {};  ///< Added to the commanded rest length of the start.
  std::optional<double> rest_length_rate_m_per_s = {};  ///< The command goes on from where it is.
  std::optional<double> velocity_input_m_per_s =
      {};  ///< Added to V0 of the cable's impedance control.
  /// Added to each of `numbers`, in their unit; the sum stays within what makes sense of them.
  std::optional<double> by = {};
  /// Of controllers and their gaits, by the names of `FindTunables` (taut/study.h).
  std::vector<std::string> numbers = {};
  std::string name = {};  ///< Of such an action.
};

/// What a step is worth. The rewards of an episode that does not end early add up to the score that
/// a study with this objective would give it, and to what is below.
struct EnvironmentReward : ObjectiveSpec {
  EnvironmentReward() { measure = Measure::kNone; }
  double alive_per_s = 0;         ///< For every second that it goes on.
  double work_penalty_per_j = 0;  ///< For the motors' work: tension times winding in.
  /// Once, when a world fails: not finite, blown up, fallen off, above `max_tension_n`.
  double failure_penalty = 0;
};

/// How episodes differ, besides by what of the experiment depends on its seed (`start_noise`, the
/// errors of `sensors`).
struct EnvironmentVariation : VariationSpec {
  /// Gravity is turned by up to this about a horizontal axis, any: the terrain lies aslant. [rad]
  double slope_rad = 0;
  /// Actions act, and observations come, by up to this later: whole periods, drawn an episode.
  double action_delay_s = 0, observation_delay_s = 0;
  /// Seeds count modulo this, so that starts can be prepared once and kept; 0: no two are alike.
  int starts = 0;
};

struct EnvironmentSpec {
  double period_s = 0.01;  ///< From action to action.
  std::vector<EnvironmentAction> actions;
  std::vector<std::string> observations;  ///< Name patterns of trace channels with `*`.
  EnvironmentReward reward;
  std::optional<double> max_tension_n;  ///< An episode ends as failed once a cable pulls more.
  EnvironmentVariation randomise;
  // Where a file has them; may be empty.
  SourceRef at, period_at;
  std::vector<SourceRef> observation_sources;
};

}  // namespace taut
