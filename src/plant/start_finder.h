/// Finds the starts of many variants of an experiment, as snapshots of a world.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plant/find_start.h"

namespace taut::plant {

/// Workspace of a thread. The workspace computes one start after the other in a single world.
class StartFinder {
 public:
  explicit StartFinder(const std::shared_ptr<const Model>& model,
                       const WorldBatchOptions& options = {})
      : alone_(model, options), fresh_(alone_.Save(kTheWorld)) {}

  /// Returns the snapshot of the experiment's start. Returns nothing and reports an error if there
  /// is none. `gravity_m_per_s2`: replaces the model's gravity if not null. `settled`: as in
  /// `PrepareStart`.
  std::optional<std::vector<std::uint8_t>> Find(const ExperimentSpec& experiment, Diagnostics& out,
                                                const Vec3* gravity_m_per_s2 = nullptr,
                                                const std::function<bool()>& go_on = {},
                                                std::optional<SettledStart>* settled = nullptr) {
    alone_.Restore(kTheWorld, fresh_);
    if (gravity_m_per_s2 != nullptr) {
      alone_.SetParameter(kTheWorld, Parameter::kGravityX, 0, gravity_m_per_s2->x);
      alone_.SetParameter(kTheWorld, Parameter::kGravityY, 0, gravity_m_per_s2->y);
      alone_.SetParameter(kTheWorld, Parameter::kGravityZ, 0, gravity_m_per_s2->z);
    }
    if (!PrepareStart(experiment, alone_, out, go_on, settled)) return std::nullopt;
    return alone_.Save(kTheWorld);
  }

 private:
  WorldBatch alone_;
  std::vector<std::uint8_t> fresh_;
};

/// Returns the first error about a start that was not found.
inline std::string ReasonOf(const Diagnostics& found) {
  return found.items().empty() ? "the start failed" : found.items()[0].what;
}

}  // namespace taut::plant
