#include "plant/lane_gait.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace taut::plant {

LaneGait::LaneGait(const std::vector<const GaitInputSpec*>& lanes, const RobotSpec& robot)
    : kernel_(LaneKernelOf(static_cast<int>(lanes.size()))),
      clock_{lanes[0]->clock.period_s, lanes[0]->clock.phase_s} {
  Diagnostics heard_before;
  std::vector<ResolvedGait> resolved;
  for (const GaitInputSpec* lane : lanes) {
    resolved.push_back(ResolveGait(lane->gait, robot, heard_before).value_or(ResolvedGait{}));
  }
  cables_ = resolved[0].cables;
  velocity_m_per_s_.resize(cables_.size() * lanes.size());
  if (lanes[0]->gait.sine) AddSine(resolved);
  if (lanes[0]->gait.cpg) AddCpg(lanes, resolved);
  if (lanes[0]->gait.table) table_.emplace(lanes[0]->gait, resolved[0], lanes[0]->clock);
}

void LaneGait::AddSine(const std::vector<ResolvedGait>& lanes) {
  is_sine_ = true;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    for (const ResolvedGait& lane : lanes) {
      const ResolvedGait::Wave& wave = lane.waves[i];
      frequency_hz_.push_back(wave.frequency_hz);
      amplitude_m_per_s_.push_back(wave.amplitude);
      phase_turns_.push_back(control::WrapTurns(wave.phase_rad * control::kTurnsPerRad));
      offset_m_per_s_.push_back(wave.offset);
    }
  }
}

void LaneGait::AddCpg(const std::vector<const GaitInputSpec*>& specs,
                      const std::vector<ResolvedGait>& lanes) {
  const std::vector<CouplingGraph::Coupling>& links = lanes[0].graph.couplings;
  std::vector<double> frequency, amplitude, convergence, weight, phase;
  std::vector<unsigned short> to, from;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    sign_.push_back(lanes[0].sign[i]);
    for (const GaitInputSpec* spec : specs) {
      const CpgGait& cpg = *spec->gait.cpg;
      frequency.push_back(cpg.frequency_hz);
      amplitude.push_back(cpg.amplitude);
      convergence.push_back(cpg.convergence_per_s);
      const CpgFeedback feedback = cpg.feedback.value_or(CpgFeedback{});
      gain_rad_per_n_s_.push_back(feedback.gain_rad_per_n_s);
      reference_n_.push_back(feedback.reference_n);
      wants_tensions_ = wants_tensions_ || feedback.gain_rad_per_n_s != 0.0;
    }
  }
  signal_rad_per_s_.resize(gain_rad_per_n_s_.size());
  for (const CouplingGraph::Coupling& link : links) {
    to.push_back(static_cast<unsigned short>(link.to));
    from.push_back(static_cast<unsigned short>(link.from));
    for (const GaitInputSpec* spec : specs) {
      const CouplingGroup& group = spec->gait.cpg->groups[static_cast<std::size_t>(link.group)];
      weight.push_back(group.weight);
      phase.push_back(control::WrapTurns(group.phase_rad * control::kTurnsPerRad));
    }
  }
  const double step_s = specs[0]->gait.cpg->integrator_step_s;
  steps_a_tick_ = std::max(1, static_cast<int>(std::ceil(clock_.period_s / step_s - 1e-6)));
  integrator_step_s_ = clock_.period_s / steps_a_tick_;
  const int count = static_cast<int>(cables_.size());
  coupling_count_ = static_cast<int>(links.size());
  const std::size_t bytes = (kernel_.cpg_bytes(count, coupling_count_) + 63) / 64 * 64;
  cpg_.reset(std::aligned_alloc(64, bytes));
  if (!cpg_) throw std::bad_alloc();
  kernel_.cpg_start({count, coupling_count_, frequency.data(), amplitude.data(), convergence.data(),
                     to.data(), from.data(), weight.data(), phase.data()},
                    cpg_.get());
}

bool LaneGait::Act(double time_s, const double* tension_n) {
  if (!control::IsDue(clock_, tick_, time_s)) return false;
  const auto lanes = static_cast<std::size_t>(kernel_.lanes);
  const int count = static_cast<int>(cables_.size());
  if (is_sine_) {
    kernel_.sine({count, frequency_hz_.data(), amplitude_m_per_s_.data(), phase_turns_.data(),
                  offset_m_per_s_.data()},
                 control::TickTime(clock_, tick_), velocity_m_per_s_.data());
  }
  if (cpg_) {
    // The oscillators start at the first tick, and go from tick to tick under the signal that
    // they had at the tick before.
    kernel_.cpg_tick(count, coupling_count_, cpg_.get(),
                     wants_tensions_ ? signal_rad_per_s_.data() : nullptr, integrator_step_s_,
                     tick_ == 0 ? 0 : steps_a_tick_, sign_.data(), velocity_m_per_s_.data());
    for (std::size_t k = 0; wants_tensions_ && k < signal_rad_per_s_.size(); ++k) {
      const std::size_t cable = static_cast<std::size_t>(cables_[k / lanes]);
      signal_rad_per_s_[k] =
          gain_rad_per_n_s_[k] * (tension_n[cable * lanes + k % lanes] - reference_n_[k]);
    }
  }
  if (table_) {
    table_->Act(time_s, [](int) { return 0.0; });
    for (std::size_t i = 0; i < cables_.size(); ++i) {
      std::fill_n(velocity_m_per_s_.begin() + static_cast<std::ptrdiff_t>(i * lanes), lanes,
                  table_->velocity_m_per_s()[i]);
    }
  }
  ++tick_;
  return true;
}

}  // namespace taut::plant
