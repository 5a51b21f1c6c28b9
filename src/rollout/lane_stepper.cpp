#include "rollout/lane_stepper.h"

#include <algorithm>
#include <limits>

namespace taut::rollout {

LaneStepper::LaneStepper(const ExperimentSpec& experiment,
                         std::span<const RolloutWorld* const> lanes, Batch& batch)
    : batch_(batch),
      schedule_(experiment.step_s, experiment.duration_s),
      cables_(batch.Cables(0)),
      set_point_n_(experiment.robot.def.cables.size() * lanes.size()) {
  if (!experiment.pushes.empty() || !experiment.drags.empty()) {
    for (std::size_t j = 0; j < lanes.size(); ++j) timelines_.emplace_back(experiment);
  }
  for (std::size_t c = 0; c < experiment.controllers.size(); ++c) {
    std::vector<const ControllerSpec*> same;
    for (const RolloutWorld* lane : lanes) same.push_back(&lane->controllers[c]);
    controllers_.emplace_back(same, experiment.robot);
    const std::vector<int>& driven = controllers_.back().driven();
    driven_.insert(driven_.end(), driven.begin(), driven.end());
  }
  std::sort(driven_.begin(), driven_.end());
  if (experiment.sensors) {
    std::vector<std::uint64_t> seeds;
    for (const RolloutWorld* lane : lanes) seeds.push_back(lane->seed);
    sensors_.emplace(*experiment.sensors, experiment.robot.def.cables.size(), std::move(seeds));
  }
}

void LaneStepper::Prepare() {
  if (!schedule_.AtBoundary()) return;
  ReadingRows seen = readings();
  if (sensors_) {
    sensors_->Sample(time_s(), seen);
    seen = sensors_->rows();
  }
  for (plant::LaneController& controller : controllers_) {
    controller.Act(time_s(), seen, cables_.rest_length_target_m, set_point_n_.data());
  }
  schedule_.Aim(NextBoundary());
}

void LaneStepper::Step() {
  Prepare();
  for (std::size_t j = 0; j < timelines_.size(); ++j) {
    timelines_[j].Apply(batch_, static_cast<int>(j), time_s(), step_s());
  }
  batch_.Step(step_s());
  schedule_.Advance();
  cables_ = batch_.Cables(0);
}

double LaneStepper::NextBoundary() const {
  double next = timelines_.empty() ? std::numeric_limits<double>::infinity()
                                   : timelines_[0].NextCorner(time_s());
  if (sensors_) next = std::min(next, sensors_->next_tick_s());
  for (const plant::LaneController& controller : controllers_) {
    next = std::min(next, controller.next_tick_s());
  }
  return next;
}

}  // namespace taut::rollout
