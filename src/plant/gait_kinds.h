/// A gait at work in all lanes of a plant. One kind a file, gait_*.cpp, and a line here.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "plant/lane_state.h"
#include "taut/gait.h"
#include "taut/plant.h"

namespace taut::plant {

/// The lanes' gaits, which differ in numbers only, so that `ResolveGait` makes the same of all.
struct GaitSetup {
  std::vector<const GaitSpec*> gaits;
  ResolvedGait resolved;
  double period_s = 0.01;
};

/// Who plays on now. Per lane: the time of the run, and how much time and how many ticks have
/// passed since this gait began there.
struct GaitTick {
  Lanes due = 0;
  const std::int64_t* number = nullptr;
  const double *time_s = nullptr, *since_s = nullptr;
};

class GaitPlayer {
 public:
  explicit GaitPlayer(const GaitSetup& setup)
      : lanes_(static_cast<int>(setup.gaits.size())),
        cables_(setup.resolved.cables),
        signal_(cables_.size() * setup.gaits.size()) {}
  virtual ~GaitPlayer() = default;

  /// Per output, the robot's cable.
  const std::vector<int>& cables() const noexcept { return cables_; }
  /// Of output i in lane j, at [i * lanes + j]: what it says since the last tick; 0 before.
  const std::vector<double>& signal() const noexcept { return signal_; }

  /// To the next tick, in the lanes that are due.
  virtual void Tick(const GaitTick& tick, const Observation& seen) = 0;
  /// A lane gets other numbers, and plays from the beginning.
  virtual void Restart(int lane, const GaitSpec& gait) = 0;
  /// A lane gets other numbers, and plays on: from its next tick, without a jump of a phase.
  /// Allocates nothing.
  virtual void Retune(int lane, const GaitSpec& gait) = 0;
  /// What the next ticks of a lane need to know of those before.
  virtual void Carry(LaneState& state) { state.Row(signal_); }
  /// Goes on in a lane from where another gait is, without a jump. False if there is no such way.
  virtual bool GoOnFrom(const GaitPlayer& before, int lane) {
    return (void)before, (void)lane, false;
  }

 protected:
  int lanes() const noexcept { return lanes_; }
  std::size_t At(std::size_t i, int lane) const noexcept {
    return i * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane);
  }

 private:
  int lanes_;
  std::vector<int> cables_;

 protected:
  std::vector<double> signal_;
};

/// Each makes a player if the gaits are of its kind.
using MakeGaitPlayer = std::unique_ptr<GaitPlayer> (*)(const GaitSetup&);

std::unique_ptr<GaitPlayer> MakeSine(const GaitSetup&);
std::unique_ptr<GaitPlayer> MakeCpg(const GaitSetup&);
std::unique_ptr<GaitPlayer> MakeTable(const GaitSetup&);
std::unique_ptr<GaitPlayer> MakeFeedbackCpg(const GaitSetup&);
std::unique_ptr<GaitPlayer> MakeTowardGoal(const GaitSetup&);

inline constexpr MakeGaitPlayer kGaitKinds[] = {MakeSine, MakeCpg, MakeTable, MakeFeedbackCpg,
                                                MakeTowardGoal};

inline std::unique_ptr<GaitPlayer> PlayerOf(const GaitSetup& setup) {
  for (const MakeGaitPlayer make : kGaitKinds) {
    if (auto player = make(setup)) return player;
  }
  TAUT_ASSERT(false && "a gait of no kind");
  return nullptr;
}

}  // namespace taut::plant
