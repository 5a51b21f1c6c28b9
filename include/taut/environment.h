/// Definition of a reinforcement-learning environment: actions, observations, rewards, termination
/// and domain randomization of an experiment (docs/environments.md). `Env` of taut/env.h runs it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/objective.h"
#include "taut/variation.h"

namespace taut {

/// Component of an action, -1 to 1, and the quantity that it changes. An action of 0 leaves the
/// experiment unchanged.
struct EnvironmentAction {
  int cable = 0;  ///< Index of the driven cable; kWorld: no cable.
  // Effect of an action of 1, > 0. Exactly one of the next four is present.
  std::optional<double> rest_length_m = {};  ///< Added to the rest length commanded at the start.
  /// Rate of change of the commanded rest length.
  std::optional<double> rest_length_rate_m_per_s = {};
  /// Added to V0 of the cable's impedance control.
  std::optional<double> velocity_input_m_per_s = {};
  /// Added to each parameter in `numbers`, in the parameter's unit. The sum is clipped to the valid
  /// range of the parameter.
  std::optional<double> by = {};
  /// Names of controller and gait parameters, as in `FindTunables` (taut/study.h).
  std::vector<std::string> numbers = {};
  std::string name = {};  ///< Name of an action on `numbers`.
};

/// Reward of a step. Over an episode without an early end, the sum of rewards is the score of a
/// study with this objective, plus the terms below.
struct EnvironmentReward : ObjectiveSpec {
  EnvironmentReward() { measure = Measure::kNone; }
  double alive_per_s = 0;         ///< Reward per second of the episode.
  double work_penalty_per_j = 0;  ///< Weight of the motor work: tension times wound length.
  /// Applied once when a world fails: not finite, too fast, off the terrain, or above
  /// `max_tension_n`.
  double failure_penalty = 0;
};

/// Domain randomization of episodes. `start_noise` and the errors of `sensors` of the experiment
/// also depend on the seed of the episode.
struct EnvironmentVariation : VariationSpec {
  /// Largest rotation [rad] of gravity about a random horizontal axis, equivalent to a terrain
  /// slope.
  double slope_rad = 0;
  /// Largest delays of actions and observations: whole periods, drawn once per episode.
  double action_delay_s = 0, observation_delay_s = 0;
  /// Number of different starts: seeds are taken modulo this number, so starts are computed once
  /// and cached. 0: all starts differ.
  int starts = 0;
};

struct EnvironmentSpec {
  double period_s = 0.01;  ///< Time between actions.
  std::vector<EnvironmentAction> actions;
  std::vector<std::string> observations;  ///< Name patterns of trace channels with `*`.
  EnvironmentReward reward;
  std::optional<double> max_tension_n;  ///< Cable tension above which an episode ends as a failure.
  EnvironmentVariation randomise;
  // Positions in the file; may be empty.
  SourceRef at, period_at;
  std::vector<SourceRef> observation_sources;
};

}  // namespace taut
