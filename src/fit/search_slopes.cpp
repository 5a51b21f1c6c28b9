// Slopes of searches. Step sizes are checked at the start and the end of a search, and if an
// iteration gains far less than predicted.
#include "fit/search.h"

namespace taut::fit {

bool Search::Derive() {
  std::vector<ColumnTask> tasks;
  for (std::size_t t = 0; t < jobs_.size(); ++t) {
    if (!Running(t) || !work_[t].slopes.empty()) continue;
    const FitTrack& track = state_.tracks[t];
    for (std::size_t j = 0; j < problem_.parameters.size(); ++j) {
      if (Held(t, j)) continue;
      tasks.push_back({t, j, &track.values, &work_[t].residual, track.check, track.step_share[j]});
    }
    work_[t].slopes.resize(problem_.parameters.size());
    work_[t].nearby.clear();
    work_[t].nearby_cost = track.cost;
  }
  const auto compute = [this](const std::vector<std::vector<double>>& points,
                              const std::vector<std::size_t>& owners,
                              std::vector<Residuals>& answers) {
    if (!Compute(points, answers)) return false;
    for (std::size_t k = 0; k < points.size(); ++k) TakeNearby(owners[k], points[k], answers[k]);
    return true;
  };
  auto columns = FindColumns(problem_, tasks, compute);
  if (!columns) return false;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    FitTrack& track = state_.tracks[tasks[k].owner];
    track.step_share[tasks[k].parameter] = (*columns)[k].step_share;
    work_[tasks[k].owner].slopes[tasks[k].parameter] = std::move((*columns)[k].slope);
  }
  resumed_ = false;
  return true;
}

void Search::TakeNearby(std::size_t t, const std::vector<double>& point, const Residuals& answer) {
  // A resumed search repeats points that were already counted.
  const bool counts = !resumed_ || state_.tracks[t].rejected == 0;
  if (counts) ++state_.points;
  if (!answer.failed.empty()) {
    if (counts) CountFailure(t, answer.failed);
    return;
  }
  const double cost = CostAt(t, point, answer.value);
  if (!(cost < work_[t].nearby_cost)) return;
  work_[t].nearby = point;
  work_[t].nearby_residual = answer.value;
  work_[t].nearby_cost = cost;
}

bool Search::CheckFirst(std::size_t t) {
  if (state_.tracks[t].check) return false;
  state_.tracks[t].check = true;
  work_[t].slopes.clear();
  return true;
}

}  // namespace taut::fit
