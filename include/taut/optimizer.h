/// Optimisers that ask for batches of points and are told their scores. What an optimiser asks for
/// is a function of its settings, its seed and the scores it was told: to resume one, tell it the
/// same scores again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/study.h"

namespace taut {

/// In [0, 1]^n: every parameter in widths of its bounds.
using UnitPoint = std::vector<double>;

class Optimizer {
 public:
  virtual ~Optimizer() = default;

  /// The points to evaluate next, at least one.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// Their scores, in the same order; more is better, NaN is a failure.
  virtual void Tell(const std::vector<double>& scores) = 0;
};

struct OptimizerStart {
  UnitPoint point;              ///< Where to begin.
  std::optional<double> score;  ///< Of that; nothing if it has not been evaluated.
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;  ///< Several optimisers of one seed use one each.
};

/// The optimiser that a search names.
std::unique_ptr<Optimizer> MakeOptimizer(const SearchSpec& search, const OptimizerStart& start);

}  // namespace taut
