#include "plant/gait_kinds.h"
#include "plant/lane_kernel.h"
#include "plant/other_lanes.h"
#include "taut/control/turns.h"

namespace taut::plant {
namespace {

/// docs/theory/gaits.md, eq. G.1.
class SinePlayer final : public GaitPlayer {
 public:
  explicit SinePlayer(const GaitSetup& setup) : GaitPlayer(setup), kernel_(LaneKernelOf(lanes())) {
    for (std::vector<double>* row : {&frequency_hz_, &amplitude_, &phase_turns_, &offset_}) {
      row->resize(signal_.size());
    }
    for (int j = 0; j < lanes(); ++j) {
      const auto lane = static_cast<std::size_t>(j);
      Restart(j, *setup.gaits[lane], setup.resolved[lane]);
    }
  }

  void Tick(const GaitTick& tick, const Observation&) override {
    OtherLanes others(tick.due, lanes());
    others.Keep(signal_.data(), cables().size());
    kernel_.sine({static_cast<int>(cables().size()), frequency_hz_.data(), amplitude_.data(),
                  phase_turns_.data(), offset_.data()},
                 tick.time_s, signal_.data());
    others.PutBack();
  }

  void Restart(int lane, const GaitSpec&, const ResolvedGait& resolved) override {
    for (std::size_t i = 0; i < resolved.waves.size(); ++i) {
      const ResolvedGait::Wave& wave = resolved.waves[i];
      const std::size_t at = At(i, lane);
      frequency_hz_[at] = wave.frequency_hz;
      amplitude_[at] = wave.amplitude;
      phase_turns_[at] = control::WrapTurns(wave.phase_rad * control::kTurnsPerRad);
      offset_[at] = wave.offset;
    }
  }

 private:
  const LaneKernel& kernel_;
  std::vector<double> frequency_hz_, amplitude_, phase_turns_, offset_;
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeSine(const GaitSetup& setup) {
  if (!setup.gaits[0]->sine) return nullptr;
  return std::make_unique<SinePlayer>(setup);
}

}  // namespace taut::plant
