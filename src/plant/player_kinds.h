/// Gait players, which play gaits in all lanes of a plant. Each kind has a file play_*.cpp and an
/// entry in the list of makers.
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

/// Gaits of all lanes. The gaits differ only in numbers, so `ResolveGait` returns the same result
/// for all lanes.
struct GaitSetup {
  std::vector<const GaitSpec*> gaits;
  ResolvedGait resolved;
  double period_s = 0.01;
};

/// Lanes in which this gait is due. Per lane: time of the run, and number of ticks and time since
/// this gait began.
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

  /// Index of the robot's cable, per output.
  const std::vector<int>& cables() const noexcept { return cables_; }
  /// Output i of lane j at the last tick is at [i * lanes + j]; 0 before the first tick.
  const std::vector<double>& signal() const noexcept { return signal_; }

  /// Computes the next tick in the lanes that are due.
  virtual void Tick(const GaitTick& tick, const Observation& seen) = 0;
  /// Sets the parameters of a lane and restarts the gait there.
  virtual void Restart(int lane, const GaitSpec& gait) = 0;
  /// Sets the parameters of a lane from its next tick, without restart and without a jump in phase.
  /// Allocates no memory.
  virtual void Retune(int lane, const GaitSpec& gait) = 0;
  /// Serializes all data of a lane that affect its next ticks.
  virtual void Serialize(LaneState& state) { state.Row(signal_); }
  /// Continues in a lane with the state of another gait's player. Returns false if this is
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

/// Creates a player if the gaits are of its kind, otherwise returns null.
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
