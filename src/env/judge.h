/// What steps are worth and when episodes end, for the lanes of a group.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "env/plan.h"
#include "plant/lane_kernel.h"
#include "plant/loop.h"

namespace taut::env {

class Judge {
 public:
  Judge(const Plan& plan, const plant::Loop& loop);

  /// An episode begins: the lane's world is at its start. `bodies` as for `Look`.
  void Begin(int lane, const RolloutWorld& world, std::span<const BodyState> bodies);

  /// Whether it wants to see every step: `Measure` after each, of all lanes.
  bool measures() const noexcept { return measures_; }
  void Measure();

  struct Verdict {
    double reward = 0;
    EpisodeEnd end = EpisodeEnd::kNone;
  };
  /// After the period with this number, from 1 on, of a lane. `bodies`: as they are now.
  Verdict Look(int lane, std::int64_t number, bool good_action, std::span<const BodyState> bodies);

 private:
  EpisodeEnd EndOf(std::size_t lane, std::int64_t number, bool good_action,
                   std::span<const BodyState> bodies, const Vec3& center_m) const;
  double Progress(std::size_t lane, std::span<const BodyState> bodies, const Vec3& center_m) const;
  Vec3 Center(std::size_t lane, std::span<const BodyState> bodies) const;

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
