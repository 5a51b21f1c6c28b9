/// Interface of plants that take several steps in one call, with no sensor or controller between
/// them.
#pragma once

namespace taut::plant {

/// Optional: taut's simulated plant implements it; plants of other programs need not.
class ManySteps {
 public:
  virtual ~ManySteps() = default;
  /// Equals `count` calls of `Plant::Advance` with the same step in all lanes. `to_s`: times at the
  /// end of the last step.
  virtual void AdvanceMany(double step_s, int count, const double* to_s) = 0;
};

}  // namespace taut::plant
