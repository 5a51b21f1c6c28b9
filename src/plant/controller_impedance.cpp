#include <algorithm>

#include "plant/controller_kinds.h"
#include "plant/lane_kernel.h"
#include "plant/other_lanes.h"
#include "taut/lane_state.h"

namespace taut::plant {
namespace {

control::ImpedanceLaw LawOf(const ImpedanceSpec& spec, const ClockSpec& clock) {
  control::ImpedanceLaw law;
  law.by_pid = spec.conversion == TensionConversion::kPid;
  law.differenced_rate = spec.differenced_rate;
  law.start_from_rest_length = spec.start_from_rest_length;
  law.proportional = spec.pid.proportional_m_per_s_n;
  law.integral = spec.pid.integral_m_per_s2_n;
  law.derivative = spec.pid.derivative_m_per_n;
  law.period_s = clock.period_s;
  return law;
}

/// Impedance control of the cables of a controller (Mirletz et al. 2015, eq. 3). Gains may differ
/// between worlds.
class ImpedanceController final : public Controller {
 public:
  ImpedanceController(const ControlSetup& setup, std::size_t index)
      : index_(index),
        lanes_(static_cast<int>(setup.lanes.size())),
        kernel_(LaneKernelOf(lanes_)),
        clock_(setup.lanes[0]->controllers[index].clock) {
    const ImpedanceSpec& spec = *setup.lanes[0]->controllers[index].impedance;
    law_ = LawOf(spec, clock_);
    for (const ImpedanceGains& gains : spec.cables) cables_.push_back(gains.cable);
    for (std::vector<double>* row :
         {&tension_offset_n_, &length_offset_m_, &position_gain_, &velocity_gain_,
          &velocity_offset_, &error_before_, &integral_, &length_before_m_}) {
      row->resize(cables_.size() * setup.lanes.size());
    }
    kept_.Reserve(3 + 3 * cables_.size(), 6 * integral_.size());
    for (int j = 0; j < lanes_; ++j) Restart(j, *setup.lanes[static_cast<std::size_t>(j)]);
  }

  ClockSpec clock() const override { return clock_; }

  void Restart(int lane, const RolloutWorld& world) override { Retune(lane, world.controllers); }

  void Retune(int lane, const std::vector<ControllerSpec>& controllers) override {
    const std::vector<ImpedanceGains>& gains = controllers[index_].impedance->cables;
    for (std::size_t i = 0; i < cables_.size(); ++i) Set(i, lane, gains[i]);
  }

  void Serialize(LaneState& state) override {
    for (std::vector<double>* row :
         {&error_before_, &integral_, &length_before_m_, &tension_offset_n_, &length_offset_m_,
          &position_gain_, &velocity_gain_, &velocity_offset_}) {
      state.Row(*row);
    }
  }

  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    Lanes first = 0;
    for (int j = 0; j < lanes_; ++j) first |= Lanes{tick.number[j] == 0} << j;
    first &= tick.due;
    if (first != 0) Act(first, true, seen, commands);
    if (tick.due != first) Act(tick.due & ~first, false, seen, commands);
  }

  std::optional<ImpedanceGains> Gains(int lane, int cable) const override {
    const std::size_t i = PlaceOf(cable);
    if (i == cables_.size()) return std::nullopt;
    const std::size_t at = At(i, lane);
    return ImpedanceGains{cable,
                          tension_offset_n_[at],
                          length_offset_m_[at],
                          position_gain_[at],
                          velocity_gain_[at],
                          velocity_offset_[at]};
  }
  bool SetGains(int lane, const ImpedanceGains& gains) override {
    const std::size_t i = PlaceOf(gains.cable);
    if (i == cables_.size()) return false;
    Set(i, lane, gains);
    return true;
  }

 private:
  std::size_t PlaceOf(int cable) const {
    return static_cast<std::size_t>(std::find(cables_.begin(), cables_.end(), cable) -
                                    cables_.begin());
  }

  std::size_t At(std::size_t i, int lane) const {
    return i * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane);
  }

  void Set(std::size_t i, int lane, const ImpedanceGains& gains) {
    const std::size_t at = At(i, lane);
    tension_offset_n_[at] = gains.tension_offset_n;
    length_offset_m_[at] = gains.length_offset_m;
    position_gain_[at] = gains.position_gain_n_per_m;
    velocity_gain_[at] = gains.velocity_gain_n_s_per_m;
    velocity_offset_[at] = gains.velocity_offset_m_per_s;
  }

  void Act(Lanes due, bool first, const Observation& seen, Commands& commands) {
    OtherLanes others(due, lanes_, kept_);
    if (!others.none()) KeepAll(others, commands);
    law_.first_tick = first;
    const ImpedanceRows rows{
        static_cast<int>(cables_.size()), cables_.data(),        tension_offset_n_.data(),
        length_offset_m_.data(),          position_gain_.data(), velocity_gain_.data(),
        velocity_offset_.data(),          error_before_.data(),  integral_.data(),
        length_before_m_.data()};
    kernel_.impedance(law_, rows, seen.cables,
                      {commands.signal, commands.velocity_input_m_per_s, commands.rest_length_m,
                       commands.set_point_n});
    others.PutBack();
  }

  /// Backs up all rows that a tick writes.
  void KeepAll(OtherLanes& others, const Commands& commands) {
    for (std::vector<double>* memory : {&error_before_, &integral_, &length_before_m_}) {
      others.Keep(memory->data(), cables_.size());
    }
    for (const int cable : cables_) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(cable) * lanes_;
      others.Keep(commands.rest_length_m + at, 1);
      others.Keep(commands.set_point_n + at, 1);
      others.Keep(commands.velocity_input_m_per_s + at, 1);
    }
  }

  std::size_t index_;
  int lanes_;
  const LaneKernel& kernel_;
  ClockSpec clock_;
  control::ImpedanceLaw law_;
  std::vector<int> cables_;
  std::vector<double> tension_offset_n_, length_offset_m_, position_gain_, velocity_gain_,
      velocity_offset_;
  std::vector<double> error_before_, integral_, length_before_m_;
  KeptRows kept_;
};

}  // namespace

std::unique_ptr<Controller> MakeImpedance(const ControlSetup& setup, std::size_t index) {
  if (!setup.lanes[0]->controllers[index].impedance) return nullptr;
  return std::make_unique<ImpedanceController>(setup, index);
}

}  // namespace taut::plant
