#include "plant/stepper.h"

#include <algorithm>

#include "plant/start.h"

namespace taut::plant {

Stepper::Stepper(const ExperimentSpec& experiment, Batch& batch)
    : batch_(batch),
      schedule_(experiment.step_s, experiment.duration_s),
      timeline_(experiment),
      readings_(experiment.robot.def.cables.size()) {
  for (std::vector<double>* commands :
       {&commands_.target_m, &commands_.set_point_n, &commands_.velocity_input_m_per_s}) {
    commands->resize(readings_.size());
  }
  for (const ControllerSpec& spec : experiment.controllers) {
    controllers_.emplace_back(spec, experiment.robot);
  }
  if (experiment.sensors) {
    sensors_.emplace(*experiment.sensors, readings_.size(),
                     std::vector<std::uint64_t>{experiment.seed});
    sensed_.resize(readings_.size());
    EachReading([this](std::vector<double>& row) { row.resize(readings_.size()); }, exact_);
  }
  for (std::size_t c = 0; c < commands_.target_m.size(); ++c) {
    commands_.target_m[c] = batch.RestLengthTarget(kTheWorld, static_cast<int>(c));
  }
  Observe();
}

void Stepper::Prepare() {
  if (!schedule_.AtBoundary()) return;
  if (sensors_) Sense();
  for (Controller& controller : controllers_) {
    controller.Act(time_s(), sensed(), commands_);
  }
  for (std::size_t c = 0; c < commands_.target_m.size(); ++c) {
    batch_.SetRestLengthTarget(kTheWorld, static_cast<int>(c), commands_.target_m[c]);
  }
  schedule_.Aim(NextBoundary());
}

void Stepper::Step() {
  Prepare();
  timeline_.Apply(batch_, kTheWorld, time_s(), step_s());
  batch_.Step(step_s());
  schedule_.Advance();
  Observe();
}

bool Stepper::finite() const noexcept {
  return (batch_.Status(kTheWorld).bits & kStatusNonFinite) == 0;
}

void Stepper::SetTarget(int cable, double rest_length_m) {
  commands_.target_m[static_cast<std::size_t>(cable)] = rest_length_m;
  batch_.SetRestLengthTarget(kTheWorld, cable, rest_length_m);
}

void Stepper::Observe() {
  for (std::size_t c = 0; c < readings_.size(); ++c) {
    readings_[c] = batch_.Cable(kTheWorld, static_cast<int>(c));
  }
}

void Stepper::Sense() {
  for (std::size_t c = 0; c < readings_.size(); ++c) {
    EachReading([c](std::vector<double>& row, double x) { row[c] = x; }, exact_, readings_[c]);
  }
  sensors_->Sample(time_s(),
                   MapReadings([](const std::vector<double>& row) { return row.data(); }, exact_));
  const ReadingRows seen = sensors_->rows();
  for (std::size_t c = 0; c < sensed_.size(); ++c) {
    sensed_[c] = MapReadings([c](const double* row) { return row[c]; }, seen);
  }
}

/// The next tick or corner.
double Stepper::NextBoundary() const {
  double next = timeline_.NextCorner(time_s());
  if (sensors_) next = std::min(next, sensors_->next_tick_s());
  for (const Controller& controller : controllers_) {
    next = std::min(next, controller.next_tick_s());
  }
  return next;
}

}  // namespace taut::plant
