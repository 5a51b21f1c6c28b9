/// Interface of plants that can take several steps in one call, with no sensor or controller
/// between them.
#pragma once

namespace taut::plant {

/// Optional interface. taut's simulated plant implements it.
class ManySteps {
 public:
  virtual ~ManySteps() = default;
  /// Equivalent to `count` calls of `Plant::Advance` with the same step in all lanes. `to_s`: times
  /// after the last step.
  virtual void AdvanceMany(double step_s, int count, const double* to_s) = 0;
};

}  // namespace taut::plant
