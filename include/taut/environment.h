/// Definition of a reinforcement-learning environment: actions, observations, rewards, termination
/// and domain randomization of an experiment (docs/environments.md). taut/env.h steps it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/objective.h"
#include "taut/variation.h"

namespace taut {

/// Component of an action, from -1 to 1, and the quantity that it changes. 0 is the unmodified
/// experiment.
struct EnvironmentAction {
  int cable = 0;  ///< kWorld: no cable.
  // Effect of an action of 1, > 0: exactly one of the following is present.
  std::optional<double> rest_length_m = {};  ///< Added to the rest length commanded at the start.
  /// Rate of change of the commanded rest length.
  std::optional<double> rest_length_rate_m_per_s = {};
  /// Added to V0 of the cable's impedance control.
  std::optional<double> velocity_input_m_per_s = {};
  /// Added to each of `numbers`, in their unit; the sum is clipped to their valid range.
  std::optional<double> by = {};
  /// Parameters of controllers and gaits, by the names of `FindTunables` (taut/study.h).
  std::vector<std::string> numbers = {};
  std::string name = {};  ///< Name of an action on `numbers`.
};

/// Reward of a step. The rewards of an episode without an early end add up to the score of a study
/// with this objective, plus the terms below.
struct EnvironmentReward : ObjectiveSpec {
  EnvironmentReward() { measure = Measure::kNone; }
  double alive_per_s = 0;         ///< Per second of the episode.
  double work_penalty_per_j = 0;  ///< For the motors' work: tension times wound length.
  /// Once, when a world fails: not finite, too fast, off the terrain, or above `max_tension_n`.
  double failure_penalty = 0;
};

/// Domain randomization of episodes, in addition to the parts of the experiment that depend on its
/// seed (`start_noise`, the errors of `sensors`).
struct EnvironmentVariation : VariationSpec {
  /// Largest rotation of gravity about a random horizontal axis: a slope of the terrain. [rad]
  double slope_rad = 0;
  /// Largest delays of actions and observations: whole periods, drawn once per episode.
  double action_delay_s = 0, observation_delay_s = 0;
  /// Seeds count modulo this number, so that starts can be prepared once and cached; 0: all starts
  /// differ.
  int starts = 0;
};

struct EnvironmentSpec {
  double period_s = 0.01;  ///< Time between actions.
  std::vector<EnvironmentAction> actions;
  std::vector<std::string> observations;  ///< Name patterns of trace channels with `*`.
  EnvironmentReward reward;
  std::optional<double> max_tension_n;  ///< A higher cable tension ends the episode as failed.
  EnvironmentVariation randomise;
  // Positions in the file; may be empty.
  SourceRef at, period_at;
  std::vector<SourceRef> observation_sources;
};

}  // namespace taut
