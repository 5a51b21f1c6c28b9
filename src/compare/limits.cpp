#include <fmt/format.h>

#include <cmath>

#include "taut/compare.h"

namespace taut {

std::vector<std::string> ExceededLimits(const Comparison& comparison, const CompareLimits& limits) {
  std::vector<std::string> exceeded;
  if (const auto most = limits.max_error_percent) {
    for (const SystemMaximum& system : comparison.system) {
      if (std::abs(system.error_percent) <= *most) continue;  // NaN exceeds the limit
      exceeded.push_back(fmt::format("the largest {} differs by {:+.2f} %, more than {:g} %",
                                     system.pattern, system.error_percent, *most));
    }
    if (comparison.system.empty()) {
      exceeded.push_back("no compared channel is subject to the limit of the largest value");
    }
  }
  if (const auto most = limits.max_rmse) {
    for (const ChannelComparison& channel : comparison.channels) {
      if (channel.rmse <= *most) continue;
      exceeded.push_back(fmt::format("{} has an RMSE of {:.6g} {}, more than {:g}", channel.name,
                                     channel.rmse, channel.unit, *most));
    }
  }
  return exceeded;
}

}  // namespace taut
