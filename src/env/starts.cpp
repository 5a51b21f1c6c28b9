#include "env/starts.h"

namespace taut::env {

Workplace::Workplace(const Plan& plan) : finder_(plan.model), experiment_(plan.experiment) {}

std::shared_ptr<const std::vector<std::uint8_t>> Workplace::Prepare(const Episode& episode,
                                                                    std::string& failed) {
  SetEpisode(episode, experiment_);
  Diagnostics found;
  auto start = finder_.Find(experiment_, found, &episode.gravity_m_per_s2);
  if (!start) {
    failed = plant::ReasonOf(found);
    return nullptr;
  }
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(*start));
}

std::shared_ptr<const std::vector<std::uint8_t>> Starts::Of(const Episode& episode,
                                                            std::unique_ptr<Workplace>& place,
                                                            std::string& failed) {
  const bool keeps = !plan_.start_varies || plan_.varied.starts > 0;
  const std::uint64_t key = plan_.start_varies ? episode.seed : 0;
  if (keeps) {
    const std::lock_guard lock(mutex_);
    const auto found = kept_.find(key);
    if (found != kept_.end()) return found->second;
  }
  if (!place) place = std::make_unique<Workplace>(plan_);
  auto start = place->Prepare(episode, failed);
  if (keeps && start) {
    const std::lock_guard lock(mutex_);  // two threads may have prepared the same start
    start = kept_.emplace(key, std::move(start)).first->second;
  }
  return start;
}

}  // namespace taut::env
