/// Black-box optimizers: `Ask` returns a batch of points, `Tell` takes their scores. The points are
/// a function of settings, seed and previous scores only, so an optimizer is resumed by passing the
/// same scores again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/study.h"

namespace taut {

/// Point in [0, 1]^n: each parameter as a fraction of the range between its bounds.
using UnitPoint = std::vector<double>;

class Optimizer {
 public:
  virtual ~Optimizer() = default;

  /// Returns the points to evaluate next, at least one.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// Takes the scores of these points, in the same order; more is better, NaN is a failure.
  virtual void Tell(const std::vector<double>& scores) = 0;
};

struct OptimizerStart {
  UnitPoint point;              ///< Start of the search.
  std::optional<double> score;  ///< Of `point`; nothing if it has not been evaluated.
  std::uint64_t seed = 0;
  /// Number of the random stream; optimizers with the same seed use different ones.
  std::uint32_t stream = 0;
};

/// Returns the optimizer of a search.
std::unique_ptr<Optimizer> MakeOptimizer(const SearchSpec& search, const OptimizerStart& start);

}  // namespace taut
