/// Steps without anybody between them.
#pragma once

namespace taut::plant {

/// What a plant of this project can do that one of a program need not.
class ManySteps {
 public:
  virtual ~ManySteps() = default;
  /// As many calls of `Plant::Advance` with all lanes' steps alike. `to_s`: at the end of the last.
  virtual void AdvanceMany(double step_s, int count, const double* to_s) = 0;
};

}  // namespace taut::plant
