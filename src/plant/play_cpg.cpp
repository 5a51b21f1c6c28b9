#include "plant/oscillators.h"
#include "taut/control/turns.h"

namespace taut::plant {
namespace {

/// Central pattern generator: phase oscillators with amplitude dynamics (Mirletz et al. 2015, eq.
/// 4-6; docs/theory/gaits.md).
class CpgPlayer final : public OscillatorPlayer {
 public:
  explicit CpgPlayer(const GaitSetup& setup)
      : OscillatorPlayer(setup, setup.gaits[0]->cpg->integrator_step_s),
        sign_(setup.resolved.sign) {
    for (const CouplingGraph::Coupling& link : setup.resolved.graph.couplings) {
      group_.push_back(static_cast<std::size_t>(link.group));
    }
    for (std::vector<double>* row : {&frequency_hz_, &amplitude_, &convergence_per_s_, &gain_,
                                     &reference_n_, &signal_rad_per_s_}) {
      row->resize(signal_.size());
    }
    for (std::vector<double>* row : {&weight_, &phase_turns_}) {
      row->resize(group_.size() * setup.gaits.size());
    }
    Prepare(setup, kernel().cpg_bytes(count(), couplings()));
  }

  void Serialize(LaneState& state) override {
    OscillatorPlayer::Serialize(state);
    state.Row(signal_rad_per_s_);
  }

  /// Takes over phases and amplitudes; only their targets change.
  bool GoOnFrom(const GaitPlayer& before, int lane) override {
    const auto* const other = dynamic_cast<const CpgPlayer*>(&before);
    if (other == nullptr || other->cables() != cables() || other->sign_ != sign_) return false;
    for (std::size_t k = 0; k < state_count(); ++k) {
      States()[At(k, lane)] = other->States()[At(k, lane)];
    }
    for (std::size_t i = 0; i < cables().size(); ++i) {
      signal_rad_per_s_[At(i, lane)] = other->signal_rad_per_s_[At(i, lane)];
    }
    return true;
  }

 private:
  double* States() const override { return kernel().cpg_states(count(), couplings(), memory()); }
  CpgRows Rows() const {
    return {
        count(), couplings(), frequency_hz_.data(), amplitude_.data(),  convergence_per_s_.data(),
        to(),    from(),      weight_.data(),       phase_turns_.data()};
  }

  void SetNumbers(int lane, const GaitSpec& gait) override {
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
    for (std::size_t k = 0; k < group_.size(); ++k) {
      const CouplingGroup& group = cpg.groups[group_[k]];
      weight_[At(k, lane)] = group.weight;
      phase_turns_[At(k, lane)] = control::WrapTurns(group.phase_rad * control::kTurnsPerRad);
    }
  }

  void StartKernel() override { kernel().cpg_start(Rows(), memory()); }

  void TickKernel(int steps) override {
    kernel().cpg_tick(count(), couplings(), memory(),
                      wants_tensions_ ? signal_rad_per_s_.data() : nullptr, integrator_step_s(),
                      steps, sign_.data(), signal_.data());
  }

  void Forget(int lane) override {
    for (std::size_t i = 0; i < cables().size(); ++i) signal_rad_per_s_[At(i, lane)] = 0.0;
  }

  void Hear(Lanes due, const Observation& seen) override {
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

  std::vector<double> sign_;
  std::vector<std::size_t> group_;  ///< Index of each coupling into `CpgGait::groups`.
  std::vector<double> frequency_hz_, amplitude_, convergence_per_s_, weight_, phase_turns_;
  std::vector<double> gain_, reference_n_, signal_rad_per_s_;
  bool wants_tensions_ = false;
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeCpg(const GaitSetup& setup) {
  if (!setup.gaits[0]->cpg) return nullptr;
  return std::make_unique<CpgPlayer>(setup);
}

}  // namespace taut::plant
