/// Measurements during rollouts of a group of worlds, and the resulting scores.
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
  /// `loop` must be at its start and have the lanes of `setup`. `own`: replaces the objective's
  /// measure; may be null.
  Scorer(const ControlSetup& setup, const ObjectiveSpec& objective, const plant::Loop& loop,
         std::unique_ptr<Score> own);

  /// Call after every step.
  void Take();
  /// Returns whether at least one of the first `count` lanes has not failed.
  bool AnyAlive(int count) const;
  /// Returns the result of a lane after the last step.
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
  std::vector<int> driven_;    ///< Cables with set points, in ascending order.
  std::vector<double> rest_before_m_, wound_j_, max_tension_n_, error_n2_s_;
  std::vector<std::optional<Vec3>> start_m_;  ///< Center of mass at `from_s`.
  std::vector<Vec3> goal_m_;                  ///< Goal positions; empty without a goal.
  std::vector<double> goal_start_m_;          ///< Distances to the goal at `from_s`.
  std::vector<std::optional<double>> fell_s_;
  std::vector<std::string> failed_;
  std::vector<BodyState> states_;  ///< Bodies of the lane that is being evaluated.
  std::int64_t looks_ = 0;
};

}  // namespace taut::rollout
