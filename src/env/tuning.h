/// Numbers of controllers and gaits that actions change, for all lanes of a group.
#pragma once

#include <cstddef>
#include <vector>

#include "env/plan.h"
#include "plant/loop.h"

namespace taut::env {

class Tuning {
 public:
  explicit Tuning(const Plan& plan);

  /// Begins an episode of a lane. Its controllers must have been restarted with the experiment's
  /// numbers.
  void Begin(int lane);
  /// Sets a lane's numbers from an action. `stride`: distance between two elements of `action`.
  /// Passes controllers to the loop only if numbers changed. Allocates no memory.
  void Set(int lane, const double* action, std::size_t stride, plant::Loop& loop);
  bool none() const noexcept { return moved_.empty(); }

 private:
  struct Moved {
    std::size_t action, number;  ///< Index of the action in the plan; index in `Lane::numbers`.
    double base, by, least, most;
  };
  struct Lane {
    std::vector<ControllerSpec> controllers;
    std::vector<double*> numbers;  ///< Pointers into `controllers`.
  };

  std::vector<Moved> moved_;
  std::vector<Lane> lanes_;
};

}  // namespace taut::env
