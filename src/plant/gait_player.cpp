#include "plant/gait_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut::plant {
namespace {

/// The row that holds at `time_s`, which is not before the first.
std::size_t RowAt(const std::vector<double>& times_s, double time_s) {
  // A tick and a row that are one rounding apart are at one time.
  const double tolerance_s = 1e-9;
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s + tolerance_s);
  return static_cast<std::size_t>(after - times_s.begin()) - 1;
}

}  // namespace

GaitPlayer::GaitPlayer(const GaitSpec& gait, ResolvedGait resolved, const ClockSpec& clock)
    : resolved_(std::move(resolved)),
      clock_{clock.period_s, clock.phase_s},
      velocity_m_per_s_(resolved_.cables.size()) {
  for (const ResolvedGait::Wave& wave : resolved_.waves) {
    waves_.push_back(
        {wave.amplitude, control::WrapTurns(wave.phase_rad * control::kTurnsPerRad), wave.offset});
  }
  if (gait.cpg) StartCpg(*gait.cpg);
  if (gait.table) table_ = *gait.table;
}

void GaitPlayer::StartCpg(const CpgGait& cpg) {
  const std::size_t count = resolved_.cables.size();
  laws_.assign(count, {cpg.frequency_hz, cpg.amplitude, cpg.convergence_per_s});
  states_.assign(count, control::StartCpg<double>());
  work_.resize(count);
  feedback_ = cpg.feedback.value_or(CpgFeedback{});
  signal_rad_per_s_.assign(count, 0.0);
  for (const CouplingGraph::Coupling& link : resolved_.graph.couplings) {
    const CouplingGroup& group = cpg.groups[static_cast<std::size_t>(link.group)];
    couplings_.push_back(control::MakeCoupling(
        static_cast<std::uint16_t>(link.to), static_cast<std::uint16_t>(link.from), group.weight,
        control::WrapTurns(group.phase_rad * control::kTurnsPerRad)));
  }
  steps_a_tick_ =
      std::max(1, static_cast<int>(std::ceil(clock_.period_s / cpg.integrator_step_s - 1e-6)));
  integrator_step_s_ = clock_.period_s / steps_a_tick_;
}

void GaitPlayer::Tick() {
  const double time_s = control::TickTime(clock_, tick_);
  if (!waves_.empty()) TickSine(time_s);
  if (!states_.empty()) TickCpg();
  if (!table_.rows.empty()) TickTable(time_s);
  ++tick_;
}

void GaitPlayer::TickSine(double time_s) {
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    const double turns = control::ClockTurns(resolved_.waves[i].frequency_hz, time_s);
    velocity_m_per_s_[i] = control::SineVelocity(waves_[i], turns);
  }
}

void GaitPlayer::TickCpg() {
  const control::CpgNetwork<double> network{laws_.data(), laws_.size(), couplings_.data(),
                                            couplings_.size()};
  // The oscillators start at the first tick.
  for (int left = tick_ == 0 ? 0 : steps_a_tick_; left > 0;) {
    const int now = std::min(left, 60'000);
    control::StepCpg(network, wants_tensions() ? signal_rad_per_s_.data() : nullptr,
                     integrator_step_s_, static_cast<std::uint16_t>(now), states_.data(),
                     work_.data());
    left -= now;
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    velocity_m_per_s_[i] = resolved_.sign[i] * control::CpgVelocity(states_[i]);
  }
}

void GaitPlayer::TickTable(double time_s) {
  double t = time_s;
  const double end_s = table_.time_s.back();
  if (table_.repeat_from_s && t >= end_s) {
    // fmod is exact, so it has the same bits everywhere
    const double from_s = *table_.repeat_from_s;
    t = from_s + std::fmod(t - from_s, end_s - from_s);
  }
  const std::size_t row = RowAt(table_.time_s, t);
  velocity_m_per_s_ = table_.rows[row];
  if (!table_.linear || row + 1 == table_.rows.size()) return;
  const double part =
      std::max(0.0, (t - table_.time_s[row]) / (table_.time_s[row + 1] - table_.time_s[row]));
  for (std::size_t i = 0; i < velocity_m_per_s_.size(); ++i) {
    velocity_m_per_s_[i] += part * (table_.rows[row + 1][i] - velocity_m_per_s_[i]);
  }
}

}  // namespace taut::plant
