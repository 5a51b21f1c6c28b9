#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/out_of_memory.h"
#include "plant/gait_kinds.h"
#include "plant/lane_kernel.h"
#include "plant/other_lanes.h"
#include "taut/control/turns.h"

namespace taut::plant {
namespace {

/// Phase oscillators with amplitude dynamics (paper eq. 4-6, docs/theory/gaits.md).
class CpgPlayer final : public GaitPlayer {
 public:
  explicit CpgPlayer(const GaitSetup& setup)
      : GaitPlayer(setup),
        kernel_(LaneKernelOf(lanes())),
        count_(static_cast<int>(cables().size())),
        sign_(setup.resolved.sign) {
    for (const CouplingGraph::Coupling& link : setup.resolved.graph.couplings) {
      to_.push_back(static_cast<unsigned short>(link.to));
      from_.push_back(static_cast<unsigned short>(link.from));
      group_.push_back(static_cast<std::size_t>(link.group));
    }
    for (std::vector<double>* row : {&frequency_hz_, &amplitude_, &convergence_per_s_, &gain_,
                                     &reference_n_, &signal_rad_per_s_}) {
      row->resize(signal_.size());
    }
    for (std::vector<double>* row : {&weight_, &phase_turns_}) {
      row->resize(to_.size() * setup.gaits.size());
    }
    const double step_s = setup.gaits[0]->cpg->integrator_step_s;
    steps_a_tick_ = std::max(1, static_cast<int>(std::ceil(setup.period_s / step_s - 1e-6)));
    integrator_step_s_ = setup.period_s / steps_a_tick_;
    const std::size_t bytes = (kernel_.cpg_bytes(count_, couplings()) + 63) / 64 * 64;
    memory_.reset(std::aligned_alloc(64, bytes));
    if (!memory_) base::OutOfMemory();
    kept_.Reserve(2, (kStateNumbers + 1) * signal_.size());
    for (int j = 0; j < lanes(); ++j) SetNumbers(j, *setup.gaits[static_cast<std::size_t>(j)]);
    kernel_.cpg_start(Rows(), memory_.get());
  }

  void Restart(int lane, const GaitSpec& gait) override {
    SetNumbers(lane, gait);
    for (std::size_t i = 0; i < cables().size(); ++i) signal_rad_per_s_[At(i, lane)] = 0.0;
    Start(Lanes{1} << lane);
  }

  void Retune(int lane, const GaitSpec& gait) override {
    SetNumbers(lane, gait);
    retuned_ |= Lanes{1} << lane;
  }

  void Carry(LaneState& state) override {
    GaitPlayer::Carry(state);
    state.Row(States(), kStateNumbers * cables().size());
    state.Row(signal_rad_per_s_);
  }

  /// The oscillators start at the first tick, and go from tick to tick under the signal that they
  /// had at the tick before.
  void Tick(const GaitTick& tick, const Observation& seen) override {
    const Lanes due = tick.due;
    if (retuned_ != 0) Start(0);
    Lanes first = 0;
    for (int j = 0; j < lanes(); ++j) {
      if (Has(due, j) && tick.number[j] == 0) first |= Lanes{1} << j;
    }
    if (first != 0) Go(first, 0);
    if (first != due) Go(due & ~first, steps_a_tick_);
    if (!wants_tensions_) return;
    for (std::size_t i = 0; i < cables().size(); ++i) {
      for (int j = 0; j < lanes(); ++j) {
        if (!Has(due, j)) continue;
        const std::size_t at = At(i, j);
        const double tension_n =
            seen.cables.tension_n[At(static_cast<std::size_t>(cables()[i]), j)];
        signal_rad_per_s_[at] = gain_[at] * (tension_n - reference_n_[at]);
      }
    }
  }

  /// Phases and amplitudes stay what they are: only what they tend to changes.
  bool GoOnFrom(const GaitPlayer& before, int lane) override {
    const auto* const other = dynamic_cast<const CpgPlayer*>(&before);
    if (other == nullptr || other->cables() != cables() || other->sign_ != sign_) return false;
    for (std::size_t k = 0; k < kStateNumbers * cables().size(); ++k) {
      States()[At(k, lane)] = other->States()[At(k, lane)];
    }
    for (std::size_t i = 0; i < cables().size(); ++i) {
      signal_rad_per_s_[At(i, lane)] = other->signal_rad_per_s_[At(i, lane)];
    }
    return true;
  }

 private:
  struct Free {
    void operator()(void* p) const noexcept { std::free(p); }
  };
  /// Of an oscillator: phase, amplitude, its rate.
  static constexpr std::size_t kStateNumbers = 3;

  int couplings() const noexcept { return static_cast<int>(to_.size()); }
  double* States() const { return kernel_.cpg_states(count_, couplings(), memory_.get()); }
  CpgRows Rows() const {
    return {count_,
            couplings(),
            frequency_hz_.data(),
            amplitude_.data(),
            convergence_per_s_.data(),
            to_.data(),
            from_.data(),
            weight_.data(),
            phase_turns_.data()};
  }

  void SetNumbers(int lane, const GaitSpec& gait) {
    const CpgGait& cpg = *gait.cpg;
    const CpgFeedback feedback = cpg.feedback.value_or(CpgFeedback{});
    wants_tensions_ = wants_tensions_ || feedback.gain_rad_per_n_s != 0.0;
    for (std::size_t i = 0; i < cables().size(); ++i) {
      const std::size_t at = At(i, lane);
      frequency_hz_[at] = cpg.frequency_hz;
      amplitude_[at] = cpg.amplitude;
      convergence_per_s_[at] = cpg.convergence_per_s;
      gain_[at] = feedback.gain_rad_per_n_s;
      reference_n_[at] = feedback.reference_n;
    }
    for (std::size_t k = 0; k < to_.size(); ++k) {
      const CouplingGroup& group = cpg.groups[group_[k]];
      weight_[At(k, lane)] = group.weight;
      phase_turns_[At(k, lane)] = control::WrapTurns(group.phase_rad * control::kTurnsPerRad);
    }
  }

  /// The kernel gets the numbers of all lanes; oscillators of those that begin are at their start.
  void Start(Lanes begin) {
    retuned_ = 0;
    OtherLanes others(begin, lanes(), kept_);
    others.Keep(States(), kStateNumbers * cables().size());
    kernel_.cpg_start(Rows(), memory_.get());
    others.PutBack();
  }

  void Go(Lanes due, int steps) {
    OtherLanes others(due, lanes(), kept_);
    others.Keep(States(), kStateNumbers * cables().size());
    others.Keep(signal_.data(), cables().size());
    kernel_.cpg_tick(count_, couplings(), memory_.get(),
                     wants_tensions_ ? signal_rad_per_s_.data() : nullptr, integrator_step_s_,
                     steps, sign_.data(), signal_.data());
    others.PutBack();
  }

  const LaneKernel& kernel_;
  int count_;
  std::vector<double> sign_;
  std::vector<unsigned short> to_, from_;
  std::vector<std::size_t> group_;  ///< Of each coupling: into `CpgGait::groups`.
  std::vector<double> frequency_hz_, amplitude_, convergence_per_s_, weight_, phase_turns_;
  std::vector<double> gain_, reference_n_, signal_rad_per_s_;
  bool wants_tensions_ = false;
  Lanes retuned_ = 0;  ///< Whose numbers the kernel has not got yet.
  KeptRows kept_;
  std::unique_ptr<void, Free> memory_;
  int steps_a_tick_ = 0;
  double integrator_step_s_ = 0;
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeCpg(const GaitSetup& setup) {
  if (!setup.gaits[0]->cpg) return nullptr;
  return std::make_unique<CpgPlayer>(setup);
}

}  // namespace taut::plant
