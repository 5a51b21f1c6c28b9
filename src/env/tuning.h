/// Numbers of controllers and gaits that actions move, for the lanes of a group.
#pragma once

#include <cstddef>
#include <vector>

#include "env/plan.h"
#include "plant/loop.h"

namespace taut::env {

class Tuning {
 public:
  explicit Tuning(const Plan& plan);

  /// A lane begins an episode: its controllers have been restarted with the experiment's numbers.
  void Begin(int lane);
  /// Its numbers under an action, an element per action of the plan. To the loop go those that have
  /// changed. Allocates nothing.
  void Set(int lane, const double* action, std::size_t stride, plant::Loop& loop);
  bool none() const noexcept { return moved_.empty(); }

 private:
  struct Moved {
    std::size_t action, number;  ///< Of the plan's actions; of `Lane::numbers`.
    double base, by, least, most;
  };
  struct Lane {
    std::vector<ControllerSpec> controllers;
    std::vector<double*> numbers;  ///< Into `controllers`.
  };

  std::vector<Moved> moved_;
  std::vector<Lane> lanes_;
};

}  // namespace taut::env
