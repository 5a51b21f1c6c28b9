/// Black-box optimizers: `Ask` returns a batch of points, `Tell` receives their scores. The points
/// depend only on settings, seed and previous scores. To resume an optimizer, pass the same scores
/// again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/study.h"

namespace taut {

/// Point in [0, 1]^n: each parameter relative to its bounds.
using UnitPoint = std::vector<double>;

class Optimizer {
 public:
  virtual ~Optimizer() = default;

  /// Returns the points to evaluate next, at least one.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// Receives the scores of these points, in the same order. Higher is better; NaN marks a failure.
  virtual void Tell(const std::vector<double>& scores) = 0;
};

struct OptimizerStart {
  UnitPoint point;              ///< Initial point of the search.
  std::optional<double> score;  ///< Score of `point`; empty if it was not evaluated.
  std::uint64_t seed = 0;
  /// Number of the random stream, so that optimizers with the same seed differ.
  std::uint32_t stream = 0;
};

/// Returns the optimizer of a search.
std::unique_ptr<Optimizer> MakeOptimizer(const SearchSpec& search, const OptimizerStart& start);

}  // namespace taut
