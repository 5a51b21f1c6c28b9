/// Gait players: gaits in all lanes of a plant. One file per kind (gait_*.cpp) and one entry in the
/// list of makers.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "taut/gait.h"
#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

/// The lanes' gaits. They differ in numbers only, so `ResolveGait` returns the same for all.
struct GaitSetup {
  std::vector<const GaitSpec*> gaits;
  ResolvedGait resolved;
  double period_s = 0.01;
};

/// Lanes in which this gait plays now. Per lane: time of the run, and time and number of ticks
/// since this gait began there.
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

  /// Per output, index of the robot's cable.
  const std::vector<int>& cables() const noexcept { return cables_; }
  /// Output i in lane j since the last tick, at [i * lanes + j]; 0 before the first.
  const std::vector<double>& signal() const noexcept { return signal_; }

  /// Advances to the next tick in the lanes that are due.
  virtual void Tick(const GaitTick& tick, const Observation& seen) = 0;
  /// Sets the parameters of a lane and plays from the beginning.
  virtual void Restart(int lane, const GaitSpec& gait) = 0;
  /// Sets the parameters of a lane while it plays on: from its next tick, without a jump of a
  /// phase. Allocates nothing.
  virtual void Retune(int lane, const GaitSpec& gait) = 0;
  /// Serializes the state of a lane: all that its next ticks depend on.
  virtual void Serialize(LaneState& state) { state.Row(signal_); }
  /// Continues in a lane from the state of another gait, without a jump. Returns false if that is
  /// impossible.
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

/// Each returns a player if the gaits are of its kind, else null.
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
