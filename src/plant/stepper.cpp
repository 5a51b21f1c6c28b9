#include "plant/stepper.h"

#include <algorithm>
#include <cmath>

#include "plant/start.h"

namespace taut::plant {

namespace {

/// After the experiment's end there may be no boundary left; spans then have this length.
constexpr double kSpanAfterEndS = 1.0;

}  // namespace

Stepper::Stepper(const ExperimentSpec& experiment, Batch& batch)
    : experiment_(experiment),
      batch_(batch),
      timeline_(experiment),
      readings_(experiment.robot.def.cables.size()) {
  for (std::vector<double>* commands :
       {&commands_.target_m, &commands_.set_point_n, &commands_.velocity_input_m_per_s}) {
    commands->resize(readings_.size());
  }
  for (const ControllerSpec& spec : experiment.controllers) {
    controllers_.emplace_back(spec, experiment.robot);
  }
  for (std::size_t c = 0; c < commands_.target_m.size(); ++c) {
    commands_.target_m[c] = batch.RestLengthTarget(kTheWorld, static_cast<int>(c));
  }
  Observe();
}

void Stepper::Prepare() {
  if (done_ < steps_) return;
  for (Controller& controller : controllers_) {
    controller.Act(time_s_, readings_, commands_);
  }
  for (std::size_t c = 0; c < commands_.target_m.size(); ++c) {
    batch_.SetRestLengthTarget(kTheWorld, static_cast<int>(c), commands_.target_m[c]);
  }
  from_s_ = time_s_;
  until_s_ = NextBoundary();
  // Steps land on the boundary: as many as are needed at no more than the step asked for.
  const double span = until_s_ - from_s_;
  steps_ = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(std::ceil(span / experiment_.step_s - 1e-6)));
  done_ = 0;
  step_s_ = span / static_cast<double>(steps_);
  // "n steps" that differ from the step asked for by rounding only are that step.
  if (std::fabs(step_s_ - experiment_.step_s) < 1e-9 * experiment_.step_s) {
    step_s_ = experiment_.step_s;
  }
}

void Stepper::Step() {
  Prepare();
  timeline_.Apply(batch_, kTheWorld, time_s_, step_s_);
  batch_.Step(step_s_);
  ++done_;
  time_s_ = done_ == steps_ ? until_s_ : from_s_ + static_cast<double>(done_) * step_s_;
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
    const int cable = static_cast<int>(c);
    const CableState s = batch_.Cable(kTheWorld, cable);
    readings_[c] = {
        s.rest_length_m, s.length_m,
        s.rate_m_per_s,  s.tension_n,
        s.elastic_n,     batch_.GetParameter(kTheWorld, Parameter::kCableStiffness, cable)};
  }
}

/// The next tick, corner of the timeline, or end.
double Stepper::NextBoundary() const {
  const bool over = time_s_ >= experiment_.duration_s;
  const double end_s = over ? time_s_ + kSpanAfterEndS : experiment_.duration_s;
  double next = std::min(end_s, timeline_.NextCorner(time_s_));
  for (const Controller& controller : controllers_) {
    next = std::min(next, controller.next_tick_s());
  }
  return next > time_s_ ? next : std::min(end_s, time_s_ + experiment_.step_s);
}

}  // namespace taut::plant
