/// The worlds of an environment that share a register, with their episodes.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "env/actions.h"
#include "env/episode.h"
#include "env/judge.h"
#include "env/lane_bodies.h"
#include "env/observer.h"
#include "env/place.h"

namespace taut::env {

/// The rows of one group in what a caller of `Step` gave.
template <class T>
struct GroupRows {
  const T* actions = nullptr;
  T* observations = nullptr;
  T* final_observations = nullptr;  ///< Null: not asked for.
  double* rewards = nullptr;
  std::uint8_t *terminated = nullptr, *truncated = nullptr;
  std::uint8_t* stepped = nullptr;  ///< Whether the world took its action.
  std::uint8_t* begun = nullptr;    ///< Whether `Finish` began an episode, whose first row it is.
};

class Group {
 public:
  /// Its first `count` lanes are worlds from `first_world` on; those behind them do as the first.
  Group(const Plan& plan, const ExperimentSpec& observed, const std::vector<ChannelInfo>& channels,
        int count);

  int count() const noexcept { return count_; }
  int width() const noexcept { return width_; }

  /// Puts a world at the start of an episode. False, and why, if there is none: then it is as it
  /// was. After one or several `Settle` makes them known.
  bool Begin(int lane, std::uint64_t raw_seed, Starts& starts, Place& place, std::string& failed);
  void Settle();

  /// A period: acts, steps, judges, observes.
  template <class T>
  void Step(const GroupRows<T>& rows, Starts& starts, Place& place);
  /// What rewards and ends have become, callbacks included, is booked; episodes begin anew. True if
  /// some did in this step.
  template <class T>
  bool Finish(const GroupRows<T>& rows, Starts& starts, Place& place);
  template <class T>
  void Emit(int lane, T* row) const {
    observer_.Emit(lane, row);
  }

  /// A world with its episode.
  std::vector<std::uint8_t> Save(int lane);
  /// False, and nothing has changed, if the state in it is not one of the model.
  bool Restore(int lane, std::span<const std::uint8_t> saved);

  const EpisodeState& state(int lane) const { return worlds_[Index(lane)].now; }
  const EpisodeState& last(int lane) const { return worlds_[Index(lane)].last; }
  const Episode& episode(int lane) const { return worlds_[Index(lane)].episode; }
  double time_s(int lane) const { return loop_.time_s(lane); }
  const Batch& batch() const noexcept { return batch_; }
  Batch& batch() noexcept { return batch_; }

 private:
  struct Slot {
    Episode episode;
    EpisodeState now, last;
    bool waits = false;       ///< Its episode is over, the next one begins in the next step.
    bool good_action = true;  ///< Of this step.
    bool begins = false;      ///< `Settle` has to know it.
  };

  /// All but the state of the batch.
  void Carry(plant::LaneState& state);

  static std::size_t Index(int lane) noexcept { return static_cast<std::size_t>(lane); }
  void Advance(Place& place);
  void BeginNext(int lane, Starts& starts, Place& place);

  const Plan& plan_;
  int count_, width_;
  Batch batch_;
  std::unique_ptr<Plant> plant_;
  plant::Loop loop_;
  LaneBodies bodies_;
  Actions actions_;
  Judge judge_;
  Observer observer_;
  std::vector<Slot> worlds_;
};

}  // namespace taut::env
