/// Worlds of an environment that share a SIMD register, with episodes, rewards and resets.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "env/actions.h"
#include "env/deadline.h"
#include "env/episode.h"
#include "env/lane_bodies.h"
#include "env/observer.h"
#include "env/place.h"
#include "env/rewards.h"

namespace taut::env {

/// Rows of a group in the arrays passed to `Step`.
template <class T>
struct GroupRows {
  const T* actions = nullptr;
  T* observations = nullptr;
  T* final_observations = nullptr;  ///< Null if not requested.
  double* rewards = nullptr;
  std::uint8_t *terminated = nullptr, *truncated = nullptr;
  std::uint8_t* stepped = nullptr;  ///< Whether the world performed its action.
  /// Whether `Finish` began an episode, so that the observation belongs to the new episode.
  std::uint8_t* begun = nullptr;
};

class Group {
 public:
  /// `count`: number of worlds. Unused lanes repeat the first world.
  Group(const Plan& plan, const ExperimentSpec& observed, const std::vector<ChannelInfo>& channels,
        int count);

  int count() const noexcept { return count_; }
  int width() const noexcept { return width_; }

  /// Resets a world to the start of an episode. If there is no such start, returns false, sets
  /// `failed` and leaves the world unchanged. Call `Settle` after one or several resets.
  bool Begin(int lane, std::uint64_t raw_seed, Starts& starts, Place& place, std::string& failed);
  void Settle();

  /// Simulates a period: actions, steps, rewards, termination, observations. Returns false if the
  /// period paused at the deadline. The next call then continues the period.
  template <class T>
  bool Step(const GroupRows<T>& rows, Starts& starts, Place& place, const Deadline& deadline);
  /// Abandons a paused period. Call this before resetting all worlds.
  void Abandon() noexcept { steps_left_ = 0; }
  /// Adds up rewards and ends episodes, including changes by callbacks, and begins new episodes.
  /// Returns whether an episode began.
  template <class T>
  bool Finish(const GroupRows<T>& rows, Starts& starts, Place& place);
  template <class T>
  void Emit(int lane, T* row) const {
    observer_.Emit(lane, row);
  }

  /// Serializes a world and its episode.
  std::vector<std::uint8_t> Save(int lane);
  /// Restores a world. Returns false and changes nothing if the state does not fit the model.
  bool Restore(int lane, std::span<const std::uint8_t> saved);

  const EpisodeState& state(int lane) const { return worlds_[Index(lane)].now; }
  const EpisodeState& last(int lane) const { return worlds_[Index(lane)].last; }
  const Episode& episode(int lane) const { return worlds_[Index(lane)].episode; }
  double time_s(int lane) const { return loop_.time_s(lane); }
  const WorldBatch& batch() const noexcept { return batch_; }
  WorldBatch& batch() noexcept { return batch_; }

 private:
  struct Slot {
    Episode episode;
    EpisodeState now, last;
    bool waits = false;       ///< Whether its episode has ended and the next step begins a new one.
    bool good_action = true;  ///< Whether all values of this step's action were finite.
    bool begins = false;      ///< Whether `Settle` must initialize the lane.
  };

  /// Serializes all data except the state of the batch.
  void Serialize(plant::LaneState& state);

  static std::size_t Index(int lane) noexcept { return static_cast<std::size_t>(lane); }
  /// Steps until the end of the period or the deadline.
  void Advance(Place& place, const Deadline& deadline);
  void BeginNext(int lane, Starts& starts, Place& place);

  const Plan& plan_;
  int count_, width_;
  WorldBatch batch_;
  std::unique_ptr<Plant> plant_;
  plant::Loop loop_;
  LaneBodies bodies_;
  Actions actions_;
  RewardAndTermination reward_and_termination_;
  Observer observer_;
  std::vector<Slot> worlds_;
  std::int64_t steps_left_ = 0;  ///< Remaining steps of a paused period.
};

}  // namespace taut::env
