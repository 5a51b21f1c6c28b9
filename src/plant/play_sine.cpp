#include "plant/lane_kernel.h"
#include "plant/other_lanes.h"
#include "plant/player_kinds.h"
#include "taut/control/turns.h"

namespace taut::plant {
namespace {

/// Sine gait (docs/theory/gaits.md, eq. G.1).
class SinePlayer final : public GaitPlayer {
 public:
  explicit SinePlayer(const GaitSetup& setup)
      : GaitPlayer(setup), kernel_(LaneKernelOf(lanes())), waves_(setup.resolved.waves) {
    for (std::vector<double>* row : {&frequency_hz_, &wanted_hz_, &amplitude_, &given_turns_,
                                     &shift_turns_, &phase_turns_, &offset_}) {
      row->resize(signal_.size());
    }
    kept_.Reserve(1, signal_.size());
    for (int j = 0; j < lanes(); ++j) Restart(j, *setup.gaits[static_cast<std::size_t>(j)]);
  }

  void Tick(const GaitTick& tick, const Observation&) override {
    if (retuned_ != 0) Shift(tick);
    OtherLanes others(tick.due, lanes(), kept_);
    others.Keep(signal_.data(), cables().size());
    kernel_.sine({static_cast<int>(cables().size()), frequency_hz_.data(), amplitude_.data(),
                  phase_turns_.data(), offset_.data()},
                 tick.time_s, signal_.data());
    others.PutBack();
  }

  void Restart(int lane, const GaitSpec& gait) override {
    Retune(lane, gait);
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const std::size_t at = At(i, lane);
      frequency_hz_[at] = wanted_hz_[at];
      shift_turns_[at] = 0.0;
      phase_turns_[at] = given_turns_[at];
    }
    retuned_ &= ~(Lanes{1} << lane);
  }

  void Retune(int lane, const GaitSpec& gait) override {
    const SineGait& sine = *gait.sine;
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      const SineWave& wave = sine.waves[static_cast<std::size_t>(waves_[i].wave)];
      const std::size_t at = At(i, lane);
      wanted_hz_[at] = wave.frequency_hz.value_or(sine.frequency_hz);
      amplitude_[at] = wave.amplitude;
      const double phase_rad =
          wave.phase_rad + waves_[i].segments_ahead * wave.phase_per_segment_rad;
      given_turns_[at] = control::WrapTurns(phase_rad * control::kTurnsPerRad);
      offset_[at] = wave.offset;
    }
    retuned_ |= Lanes{1} << lane;
  }

  void Serialize(LaneState& state) override {
    GaitPlayer::Serialize(state);
    for (std::vector<double>* row : {&frequency_hz_, &shift_turns_, &phase_turns_}) {
      state.Row(*row);
    }
    state.Bit(retuned_);
  }

 private:
  /// Keeps the phases of waves continuous when a frequency changes at time t: f' t + shift' = f t +
  /// shift.
  void Shift(const GaitTick& tick) {
    const Lanes shifted = retuned_ & tick.due;
    retuned_ &= ~shifted;
    for (std::size_t i = 0; i < waves_.size(); ++i) {
      for (int j = 0; j < lanes(); ++j) {
        if (!Has(shifted, j)) continue;
        const std::size_t at = At(i, j);
        if (wanted_hz_[at] != frequency_hz_[at]) {
          const double turns = (frequency_hz_[at] - wanted_hz_[at]) * tick.time_s[j];
          shift_turns_[at] = control::WrapTurns(shift_turns_[at] + turns);
          frequency_hz_[at] = wanted_hz_[at];
        }
        phase_turns_[at] = shift_turns_[at] == 0.0
                               ? given_turns_[at]
                               : control::WrapTurns(given_turns_[at] + shift_turns_[at]);
      }
    }
  }

  const LaneKernel& kernel_;
  std::vector<ResolvedGait::Wave> waves_;
  Lanes retuned_ = 0;  ///< Lanes retuned since their last tick.
  std::vector<double> frequency_hz_, wanted_hz_, amplitude_, offset_;
  /// Phase of each wave: value in the gait, sum of shifts by frequency changes, and their sum.
  std::vector<double> given_turns_, shift_turns_, phase_turns_;
  KeptRows kept_;
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeSine(const GaitSetup& setup) {
  if (!setup.gaits[0]->sine) return nullptr;
  return std::make_unique<SinePlayer>(setup);
}

}  // namespace taut::plant
