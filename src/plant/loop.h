/// Control loop of an experiment: steps a plant, with sensors, controllers and timeline on their
/// clocks. Each lane has separate clocks. The caller decides when to record, display and stop.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "plant/finite_check.h"
#include "plant/lane_clock.h"
#include "plant/many_steps.h"
#include "plant/schedule.h"
#include "plant/timeline.h"
#include "taut/plant.h"

namespace taut::plant {

class Loop {
 public:
  /// `lanes`: one variant of the experiment per lane. Other lanes of the plant copy the first one,
  /// and their results are not used. The plant must be at the experiment's start. Experiment and
  /// plant must outlive the loop. `first_world`: world number of the first lane, for custom
  /// controllers.
  Loop(const ExperimentSpec& experiment, std::span<const RolloutWorld* const> lanes, Plant& plant,
       const Extensions& extensions, int first_world = 0);
  /// Creates the loop of one lane for the unchanged experiment.
  Loop(const ExperimentSpec& experiment, Plant& plant, const Extensions& extensions = {})
      : Loop(experiment, plant, extensions, WorldOf(experiment)) {}

  /// Samples the sensors that are due, so that observations are current before controllers act.
  void Sense() { Sense(AllLanes(plant_lanes_)); }

  /// Runs the sensors and controllers that are due. `Step` also calls it. Call it before recording
  /// the first row, so that this row contains the first commands.
  void Prepare() { Prepare(AllLanes(plant_lanes_)); }

  /// Steps each lane once. Steps end at ticks of sensors and controllers, at corners of the
  /// timeline, and at the experiment's end. Stepping may continue after the end.
  void Step() { Step(AllLanes(plant_lanes_)); }
  /// Steps the lanes in `active` only.
  void Step(Lanes active);

  /// Takes up to `most` steps without a tick or event between them, at least one. Returns the
  /// number of steps.
  int Steps(int most);

  /// Restarts a lane with a variant. The caller must have set the plant's lane to its start.
  void Restart(int lane, const RolloutWorld& world);

  /// Changes the parameters of the controllers in a lane and continues.
  void Retune(int lane, const std::vector<ControllerSpec>& controllers);

  /// Serializes the state of a lane: controllers, sensors, clocks, timeline and commands. Before
  /// restoring, restart the lane, retune it if it was retuned, and restore the plant's state.
  void Serialize(LaneState& state);

  double time_s(int lane = 0) const noexcept { return ScheduleOf(lane).time_s(); }
  /// Returns the length of the last step of each lane.
  const double* step_s() const noexcept { return step_s_.data(); }
  bool IsRunning(int lane = 0) const {
    return plant_.IsRunning(lane) && check_.refused(lane).empty();
  }
  /// Returns a message about the first command or reading of a lane that was rejected because it is
  /// not finite. Empty if there is none. A rejected command keeps its previous value.
  const std::string& refused(int lane = 0) const noexcept { return check_.refused(lane); }
  int lanes() const noexcept { return count_; }

  Plant& plant() const noexcept { return plant_; }
  /// `exact`: state of the plant. `seen`: observation of the controllers at their last tick.
  const Observation& exact() const { return plant_.Observe(); }
  const Observation& seen() const {
    return sensors_.empty() ? exact() : sensors_.back().model->seen();
  }
  const Commands& commands() const { return plant_.commands(); }
  const Timeline& timeline(int lane = 0) const {
    return timelines_[static_cast<std::size_t>(lane)];
  }

  /// Returns a text about faults that controllers of a lane have detected; empty if there are none.
  std::string Faults(int lane = 0) const;

  // --- interactive changes -----------------------------------------------------------------------
  std::optional<ImpedanceGains> Gains(int lane, int cable) const;
  bool SetGains(int lane, const ImpedanceGains& gains);
  /// Checks the commands before each step from now on, because the caller writes to
  /// `Plant::commands`.
  void WatchCommands();
  /// Checks numbers that a program sets in a lane. Returns false and sets `refused` if one is not
  /// finite.
  bool Accepts(int lane, const char* kind, const std::string& name,
               std::span<const FiniteCheck::Named> numbers) {
    return check_.Accepts(lane, time_s(lane), kind, name, numbers);
  }
  /// Commands a rest length. The command holds until a controller that drives the cable changes it.
  void SetRestLength(int lane, int cable, double rest_length_m);
  /// Sets forces by a user's hand or a program, in addition to the events of the experiment.
  void SetHandForces(int lane, std::vector<ExternalForce> forces);

 private:
  Loop(const ExperimentSpec& experiment, Plant& plant, const Extensions& extensions,
       const RolloutWorld& world)
      : Loop(experiment, std::array{&world}, plant, extensions) {}

  struct Sensor {
    std::unique_ptr<SensorModel> model;
    LaneClock clock;
  };
  struct Law {
    std::unique_ptr<Controller> controller;
    LaneClock clock;
    /// Subject and verb of messages, such as "custom controller 0 sets". Empty: not custom.
    std::string custom;
  };

  const std::string& CableName(int cable) const noexcept {
    return experiment_.robot.def.cables[static_cast<std::size_t>(cable)].name;
  }
  const Schedule& ScheduleOf(int lane) const noexcept {
    return schedules_[schedules_.size() == 1 ? 0 : static_cast<std::size_t>(lane)];
  }
  Lanes AtBoundary() const;
  void Sense(Lanes among);
  void Prepare(Lanes among);
  /// Creates a separate schedule for each lane.
  void SplitSchedules();
  void AdvanceSchedules(int count);
  void Push(Lanes active);
  double NextBoundary(int lane) const;

  const ExperimentSpec& experiment_;
  Plant& plant_;
  ManySteps* many_;  ///< The plant; null if it can only take one step at a time.
  int count_;        ///< Number of lanes with results.
  int plant_lanes_;
  bool has_forces_ = false;  ///< Whether any lane has, or had, a push, a drag or a hand force.
  std::vector<Schedule> schedules_;  ///< One for all lanes; after the first restart, one per lane.
  std::vector<Timeline> timelines_;
  std::vector<Sensor> sensors_;  ///< Each sensor receives the output of the previous one.
  std::vector<Law> laws_;
  std::vector<double> step_s_, to_s_;
  FiniteCheck check_;
  bool watches_commands_ = false;
  /// Whether to check readings, because the plant is not a simulation of taut.
  bool watches_readings_;
};

}  // namespace taut::plant
