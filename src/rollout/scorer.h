/// Measurements during the rollouts of a group of worlds, and the resulting scores.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "plant/lane_kernel.h"
#include "plant/loop.h"
#include "taut/objective.h"
#include "taut/rollout.h"

namespace taut::rollout {

class Scorer {
 public:
  /// `loop` is at its start, and its lanes are the lanes of `setup`. `own` replaces the objective's
  /// measure; may be null.
  Scorer(const ControlSetup& setup, const ObjectiveSpec& objective, const plant::Loop& loop,
         std::unique_ptr<Score> own);

  /// Call after every step.
  void Take();
  /// Returns whether any of the first `count` lanes has not failed.
  bool AnyAlive(int count) const;
  /// Returns the result at the end.
  RolloutResult Result(int lane) const;

 private:
  void LookAround();
  Vec3 CenterOfMass(int lane) const;
  double DistanceToGoal(int lane) const;
  void NoteStart();

  const ExperimentSpec& experiment_;
  const ObjectiveSpec& objective_;
  const plant::Loop& loop_;
  const World& world_;
  std::unique_ptr<Score> own_;
  const plant::LaneKernel& kernel_;
  double cos_max_tilt_;
  std::vector<double> motor_;  ///< Per cable: 1 if it has a motor.
  std::vector<int> driven_;    ///< Cables with set points, ascending.
  std::vector<double> rest_before_m_, wound_j_, max_tension_n_, error_n2_s_;
  std::vector<std::optional<Vec3>> start_m_;  ///< Center of mass at `from_s`.
  std::vector<Vec3> goal_m_;                  ///< Empty without a goal.
  std::vector<double> goal_start_m_;          ///< Distance to it at `from_s`.
  std::vector<std::optional<double>> fell_s_;
  std::vector<std::string> failed_;
  std::vector<BodyState> states_;  ///< Bodies of the lane under examination.
  std::int64_t looks_ = 0;
};

}  // namespace taut::rollout
