/// An experiment at work on a plant: sensors, controllers and timeline on their clocks, step by
/// step. Each lane has clocks of its own. Who calls decides when to record, to show and to stop.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "plant/lane_clock.h"
#include "plant/many_steps.h"
#include "plant/schedule.h"
#include "plant/timeline.h"
#include "taut/plant.h"

namespace taut::plant {

class Loop {
 public:
  /// A variant of the experiment a lane; lanes of the plant beyond them are worked as the first is,
  /// and nobody looks at them. The plant is at the experiment's start. Experiment and plant outlive
  /// the loop.
  Loop(const ExperimentSpec& experiment, std::span<const RolloutWorld* const> lanes, Plant& plant,
       const Brought& brought);
  /// One lane, under the experiment as it is.
  Loop(const ExperimentSpec& experiment, Plant& plant, const Brought& brought = {})
      : Loop(experiment, plant, brought, WorldOf(experiment)) {}

  /// Lets sensors sample where they are due, before their controllers act: what is seen is of now.
  void Sense();

  /// Lets sensors and controllers act where they are due. The next Step does so, too; a row that is
  /// recorded at the start wants their first commands.
  void Prepare();

  /// One step of each lane. Steps land on the ticks of sensors and controllers, the corners of the
  /// timeline and the experiment's end, and go on after it.
  void Step();

  /// One step or, where nobody acts or pushes in between, several: `most` at most. How many.
  int Steps(int most);

  /// A lane begins anew as this variant; the plant has been brought to its start there.
  void Restart(int lane, const RolloutWorld& world);

  /// The controllers of a lane go on with these numbers.
  void Retune(int lane, const std::vector<ControllerSpec>& controllers);

  /// All that a lane remembers, controllers, sensors, clocks and the plant's commands. Into a lane
  /// that has been restarted, and retuned if it was, as it was when it was written; the plant has
  /// been brought to its state.
  void Carry(LaneState& state);

  double time_s(int lane = 0) const noexcept { return ScheduleOf(lane).time_s(); }
  /// Of the last step.
  const double* step_s() const noexcept { return step_s_.data(); }
  bool Goes(int lane = 0) const { return plant_.Goes(lane); }
  int lanes() const noexcept { return count_; }

  Plant& plant() const noexcept { return plant_; }
  /// The plant as it is; and what controllers saw of it at their last tick.
  const Observation& exact() const { return plant_.Observe(); }
  const Observation& seen() const {
    return sensors_.empty() ? exact() : sensors_.back().model->seen();
  }
  const Commands& commands() const { return plant_.commands(); }
  Timeline& timeline(int lane = 0) { return timelines_[static_cast<std::size_t>(lane)]; }
  const Timeline& timeline(int lane = 0) const {
    return timelines_[static_cast<std::size_t>(lane)];
  }

  // --- for a person, in lane 0 -------------------------------------------------------------------
  std::optional<ImpedanceGains> Gains(int cable) const;
  bool SetGains(const ImpedanceGains& gains);
  /// Commands a cable; for good, unless a controller with other ideas drives it.
  void SetRestLength(int cable, double rest_length_m);

 private:
  Loop(const ExperimentSpec& experiment, Plant& plant, const Brought& brought,
       const RolloutWorld& world)
      : Loop(experiment, std::array{&world}, plant, brought) {}

  struct Sensor {
    std::unique_ptr<SensorModel> model;
    LaneClock clock;
  };
  struct Law {
    std::unique_ptr<Controller> controller;
    LaneClock clock;
  };

  const Schedule& ScheduleOf(int lane) const noexcept {
    return schedules_[schedules_.size() == 1 ? 0 : static_cast<std::size_t>(lane)];
  }
  Lanes AtBoundary() const;
  void AdvanceSchedules(int count);
  void Push();
  double NextBoundary(int lane) const;

  const ExperimentSpec& experiment_;
  Plant& plant_;
  ManySteps* many_;  ///< The plant; null if it takes one step at a time.
  int count_;        ///< Lanes that somebody looks at.
  int plant_lanes_;
  std::vector<Schedule> schedules_;  ///< One for all, until a lane begins anew: then one a lane.
  std::vector<Timeline> timelines_;
  std::vector<Sensor> sensors_;  ///< Each sees what the one before shows.
  std::vector<Law> laws_;
  std::vector<double> step_s_, to_s_;
};

}  // namespace taut::plant
