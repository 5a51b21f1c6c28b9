#include "env/actions.h"

#include <algorithm>
#include <cmath>

namespace taut::env {

Actions::Actions(const Plan& plan)
    : plan_(plan),
      count_(plan.action_count()),
      lanes_(static_cast<std::size_t>(plan.lanes)),
      slots_(static_cast<std::size_t>(plan.most_action_delay) + 1),
      ring_(slots_ * count_ * lanes_),
      delay_(lanes_),
      command_m_(count_ * lanes_),
      now_(slots_ > 1 ? count_ * lanes_ : 0),
      tuning_(plan) {}

void Actions::Begin(int lane, const Commands& commands, int delay) {
  const auto j = static_cast<std::size_t>(lane);
  delay_[j] = static_cast<std::size_t>(delay);
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t slot = 0; slot < slots_; ++slot) At(slot, i, j) = 0.0;
    if (slots_ > 1) now_[i * lanes_ + j] = 0.0;
    if (plan_.spec.actions[i].by) continue;
    const auto cable = static_cast<std::size_t>(plan_.spec.actions[i].cable);
    command_m_[i * lanes_ + j] = commands.rest_length_m[cable * lanes_ + j];
  }
  tuning_.Begin(lane);
}

template <class T>
bool Actions::Read(int lane, const T* action) {
  const auto j = static_cast<std::size_t>(lane);
  bool finite = true;
  for (std::size_t i = 0; i < count_; ++i) {
    double x = action == nullptr ? 0.0 : static_cast<double>(action[i]);
    if (!std::isfinite(x)) {
      finite = false;
      x = 0.0;
    }
    At(next_, i, j) = std::clamp(x, -1.0, 1.0);
  }
  return finite;
}
template bool Actions::Read(int lane, const float* action);
template bool Actions::Read(int lane, const double* action);

void Actions::Apply(plant::Loop& loop) {
  const Commands& commands = loop.commands();
  for (std::size_t j = 0; slots_ > 1 && j < lanes_; ++j) {
    const std::size_t slot = (next_ + slots_ - delay_[j]) % slots_;
    for (std::size_t i = 0; i < count_; ++i) now_[i * lanes_ + j] = At(slot, i, j);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const EnvironmentAction& action = plan_.spec.actions[i];
    if (action.by) continue;
    const std::size_t row = static_cast<std::size_t>(action.cable) * lanes_;
    const double* const x = Acting() + i * lanes_;
    double* const base_m = &command_m_[i * lanes_];
    double* const rest_m = commands.rest_length_m + row;
    if (action.velocity_input_m_per_s) {
      const double scale = *action.velocity_input_m_per_s;
      for (std::size_t j = 0; j < lanes_; ++j) commands.signal[row + j] = scale * x[j];
    } else if (action.rest_length_m) {
      const double scale_m = *action.rest_length_m;
      for (std::size_t j = 0; j < lanes_; ++j) {
        rest_m[j] = std::max(base_m[j] + scale_m * x[j], 0.0);
      }
    } else {
      const double scale_m = *action.rest_length_rate_m_per_s * plan_.spec.period_s;
      const ActuatorDef& actuator =
          plan_.experiment.robot.def.cables[static_cast<std::size_t>(action.cable)].actuator;
      for (std::size_t j = 0; j < lanes_; ++j) {
        if (x[j] == 0.0) continue;  // keep a start value below the actuator's limit, too
        base_m[j] = std::max(base_m[j] + scale_m * x[j], actuator.min_rest_length_m);
        rest_m[j] = base_m[j];
      }
    }
  }
  for (std::size_t j = 0; !tuning_.none() && j < lanes_; ++j) {
    tuning_.Set(static_cast<int>(j), Acting() + j, lanes_, loop);
  }
  next_ = (next_ + 1) % slots_;
}

void Actions::Serialize(plant::LaneState& state, plant::Loop& loop) {
  for (std::size_t age = 1; age <= slots_; ++age) {
    for (std::size_t i = 0; i < count_; ++i) {
      state.Value(At((next_ + slots_ - age) % slots_, i, static_cast<std::size_t>(state.lane())));
    }
  }
  state.Row(command_m_);
  state.Row(now_);
  if (!state.reads() || tuning_.none()) return;
  tuning_.Set(state.lane(), Acting() + state.lane(), lanes_, loop);
}

}  // namespace taut::env
