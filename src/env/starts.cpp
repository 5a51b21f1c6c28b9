#include "env/starts.h"

#include "plant/find_start.h"

namespace taut::env {

Workplace::Workplace(const Plan& plan)
    : alone_(plan.model, {}), fresh_(alone_.Save(plant::kTheWorld)), experiment_(plan.experiment) {}

std::shared_ptr<const std::vector<std::uint8_t>> Workplace::Prepare(const Episode& episode,
                                                                    std::string& failed) {
  SetEpisode(episode, experiment_);
  alone_.Restore(plant::kTheWorld, fresh_);
  const Vec3& gravity = episode.gravity_m_per_s2;
  alone_.SetParameter(plant::kTheWorld, Parameter::kGravityX, 0, gravity.x);
  alone_.SetParameter(plant::kTheWorld, Parameter::kGravityY, 0, gravity.y);
  alone_.SetParameter(plant::kTheWorld, Parameter::kGravityZ, 0, gravity.z);
  Diagnostics complaints;
  if (!plant::PrepareStart(experiment_, alone_, complaints)) {
    failed = complaints.items().empty() ? "unknown reason" : complaints.items()[0].what;
    return nullptr;
  }
  return std::make_shared<const std::vector<std::uint8_t>>(alone_.Save(plant::kTheWorld));
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
