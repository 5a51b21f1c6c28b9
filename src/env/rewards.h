/// Rewards and terminations of episodes for all lanes of a group.
#pragma once

#include <cstddef>
#include <vector>

#include "env/lane_bodies.h"
#include "env/plan.h"
#include "plant/lane_kernel.h"
#include "plant/loop.h"

namespace taut::env {

class RewardAndTermination {
 public:
  /// Call `bodies.Read` before `Begin` and before `Evaluate`.
  RewardAndTermination(const Plan& plan, const plant::Loop& loop, const LaneBodies& bodies);

  /// Begins an episode. The lane's world must be at its start.
  void Begin(int lane, const RolloutWorld& world);

  /// Serializes the accumulated values of an episode, like a controller's `Serialize`. To restore,
  /// call `Begin` first.
  void Serialize(plant::LaneState& state);

  /// Returns whether `Measure` must be called after each step of all lanes.
  bool measures() const noexcept { return measures_; }
  void Measure();

  struct Verdict {
    double reward = 0;
    EpisodeEnd end = EpisodeEnd::kNone;
  };
  /// Returns the reward of a period and whether the episode ends. `number`: period of the episode,
  /// starting at 1.
  Verdict Evaluate(int lane, std::int64_t number, bool good_action);

 private:
  EpisodeEnd EndOf(std::size_t lane, std::int64_t number, bool good_action,
                   const Vec3& center_m) const;
  double Progress(std::size_t lane, const Vec3& center_m) const;
  Vec3 Center(std::size_t lane) const;

  /// Accumulated values of a lane's episode.
  struct RewardTotals {
    bool started = false;  ///< Whether the episode's progress already counts.
    Vec3 start_m, goal_m;
    double start_to_goal_m = 0;
    double progress_m = 0, tension_penalty = 0, work_j = 0;  ///< Values already included in
                                                             ///< rewards.
  };

  const Plan& plan_;
  const EnvironmentReward& reward_;
  const plant::Loop& loop_;
  const LaneBodies& bodies_;
  const World& world_;
  const plant::LaneKernel& kernel_;
  bool measures_, needs_center_;
  double cos_max_tilt_;
  std::vector<double> motor_;  ///< Per cable: 1 if it has a motor.
  std::vector<double> rest_before_m_, wound_j_, max_tension_n_, unused_;  ///< Rows for the kernel.
  std::vector<double> mass_kg_;                                           ///< [lane][body]
  std::vector<RewardTotals> totals_;
};

}  // namespace taut::env
