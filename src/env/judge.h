/// What steps are worth and when episodes end, for the lanes of a group.
#pragma once

#include <cstddef>
#include <vector>

#include "env/lane_bodies.h"
#include "env/plan.h"
#include "plant/lane_kernel.h"
#include "plant/loop.h"

namespace taut::env {

class Judge {
 public:
  /// `bodies`: read before `Begin` and before `Look`.
  Judge(const Plan& plan, const plant::Loop& loop, const LaneBodies& bodies);

  /// An episode begins: the lane's world is at its start.
  void Begin(int lane, const RolloutWorld& world);

  /// What an episode came to so far, as a controller's `Carry`. Into a lane that has begun it.
  void Carry(plant::LaneState& state);

  /// Whether it wants to see every step: `Measure` after each, of all lanes.
  bool measures() const noexcept { return measures_; }
  void Measure();

  struct Verdict {
    double reward = 0;
    EpisodeEnd end = EpisodeEnd::kNone;
  };
  /// After the period with this number, from 1 on, of a lane.
  Verdict Look(int lane, std::int64_t number, bool good_action);

 private:
  EpisodeEnd EndOf(std::size_t lane, std::int64_t number, bool good_action,
                   const Vec3& center_m) const;
  double Progress(std::size_t lane, const Vec3& center_m) const;
  Vec3 Center(std::size_t lane) const;

  /// What a lane's episode came to so far.
  struct Account {
    bool started = false;  ///< Its way counts.
    Vec3 start_m, goal_m;
    double start_to_goal_m = 0;
    double progress_m = 0, tension_penalty = 0, work_j = 0;  ///< That was paid for.
  };

  const Plan& plan_;
  const EnvironmentReward& reward_;
  const plant::Loop& loop_;
  const LaneBodies& bodies_;
  const World& world_;
  const plant::LaneKernel& kernel_;
  bool measures_, needs_center_;
  double cos_max_tilt_;
  std::vector<double> motor_;  ///< Per cable: 1 if it has one.
  std::vector<double> rest_before_m_, wound_j_, max_tension_n_, unused_;  ///< Rows of the kernel.
  std::vector<double> mass_kg_;                                           ///< [lane][body]
  std::vector<Account> accounts_;
};

}  // namespace taut::env
