/// A gait at work: velocities of cables at the ticks of its clock.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/control/clock.h"
#include "taut/control/cpg.h"
#include "taut/control/sine.h"
#include "taut/gait.h"
#include "taut/spec.h"

namespace taut::plant {

class GaitPlayer {
 public:
  /// `resolved` is what `ResolveGait` made of `gait`.
  GaitPlayer(const GaitSpec& gait, ResolvedGait resolved, const ClockSpec& clock);

  /// Per output, the robot's cable.
  const std::vector<int>& cables() const noexcept { return resolved_.cables; }
  double next_tick_s() const noexcept { return control::TickTime(clock_, tick_); }
  bool wants_tensions() const noexcept { return feedback_.gain_rad_per_n_s != 0.0; }

  /// Acts if a tick is due at `time_s`. `tension_n(cable)` is asked where a gait has feedback.
  template <class Tension>
  void Act(double time_s, const Tension& tension_n) {
    if (!control::IsDue(clock_, tick_, time_s)) return;
    Tick();
    if (!wants_tensions()) return;
    for (std::size_t i = 0; i < signal_rad_per_s_.size(); ++i) {
      signal_rad_per_s_[i] =
          feedback_.gain_rad_per_n_s * (tension_n(resolved_.cables[i]) - feedback_.reference_n);
    }
  }

  /// V0 of each output since the last tick [m/s]; 0 before the first.
  const std::vector<double>& velocity_m_per_s() const noexcept { return velocity_m_per_s_; }

 private:
  /// To the next tick. A CPG goes there from the tick before under the signal it had then.
  void Tick();
  void TickSine(double time_s);
  void TickCpg();
  void TickTable(double time_s);
  void StartCpg(const CpgGait& cpg);

  ResolvedGait resolved_;
  control::Clock<double> clock_;
  std::int64_t tick_ = 0;
  std::vector<double> velocity_m_per_s_;

  std::vector<control::Sine<double>> waves_;

  CpgFeedback feedback_;
  std::vector<double> signal_rad_per_s_;
  std::vector<control::CpgLaw<double>> laws_;
  std::vector<control::CpgCoupling<double>> couplings_;
  std::vector<control::CpgState<double>> states_;
  std::vector<control::CpgWork<double>> work_;
  double integrator_step_s_ = 0.0;
  int steps_a_tick_ = 0;

  TableGait table_;
};

}  // namespace taut::plant
