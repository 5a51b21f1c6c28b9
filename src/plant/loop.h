/// Control loop of an experiment: steps a plant with sensors, controllers and timeline on their
/// clocks. Each lane has separate clocks. The caller decides when to record, to show and to stop.
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
  /// `lanes`: one variant of the experiment per lane. Further lanes of the plant run as the first
  /// does; their results are not used. The plant must be at the experiment's start. Experiment and
  /// plant must outlive the loop.
  /// `first_world`: number of the first lane's world, for custom controllers.
  Loop(const ExperimentSpec& experiment, std::span<const RolloutWorld* const> lanes, Plant& plant,
       const Extensions& extensions, int first_world = 0);
  /// Creates the loop of one lane under the unchanged experiment.
  Loop(const ExperimentSpec& experiment, Plant& plant, const Extensions& extensions = {})
      : Loop(experiment, plant, extensions, WorldOf(experiment)) {}

  /// Samples the sensors that are due, before their controllers act, so that observations are
  /// current.
  void Sense() { Sense(AllLanes(plant_lanes_)); }

  /// Runs the sensors and controllers that are due. `Step` calls it too; call it before recording a
  /// row at the start, which contains their first commands.
  void Prepare() { Prepare(AllLanes(plant_lanes_)); }

  /// Steps each lane once. Steps end at the ticks of sensors and controllers, at the corners of the
  /// timeline and at the experiment's end; stepping continues after the end.
  void Step() { Step(AllLanes(plant_lanes_)); }
  /// Steps the lanes in `active`; the others wait.
  void Step(Lanes active);

  /// Takes one step, or up to `most` steps where no tick and no event lies between them. Returns
  /// their number.
  int Steps(int most);

  /// Restarts a lane as this variant. The caller has set the plant to its start there.
  void Restart(int lane, const RolloutWorld& world);

  /// Continues with these parameters of the controllers in a lane.
  void Retune(int lane, const std::vector<ControllerSpec>& controllers);

  /// Serializes the state of a lane: controllers, sensors, clocks, timeline and commands. To
  /// restore, first restart the lane, retune it if it was retuned, and restore the plant's state.
  void Serialize(LaneState& state);

  double time_s(int lane = 0) const noexcept { return ScheduleOf(lane).time_s(); }
  /// Length of the last step of each lane.
  const double* step_s() const noexcept { return step_s_.data(); }
  bool IsRunning(int lane = 0) const {
    return plant_.IsRunning(lane) && check_.refused(lane).empty();
  }
  /// Returns a sentence about the first command or reading of a lane that was refused because it is
  /// not finite; empty: none. Refused commands keep their previous value.
  const std::string& refused(int lane = 0) const noexcept { return check_.refused(lane); }
  int lanes() const noexcept { return count_; }

  Plant& plant() const noexcept { return plant_; }
  /// `exact`: the state of the plant. `seen`: the observation of the controllers at their last
  /// tick.
  const Observation& exact() const { return plant_.Observe(); }
  const Observation& seen() const {
    return sensors_.empty() ? exact() : sensors_.back().model->seen();
  }
  const Commands& commands() const { return plant_.commands(); }
  const Timeline& timeline(int lane = 0) const {
    return timelines_[static_cast<std::size_t>(lane)];
  }

  // --- interactive changes -----------------------------------------------------------------------
  std::optional<ImpedanceGains> Gains(int lane, int cable) const;
  bool SetGains(int lane, const ImpedanceGains& gains);
  /// From now on, checks the commands before each step: the caller writes to `Plant::commands`.
  void WatchCommands();
  /// Refuses numbers of a lane if one is not finite (`refused`). Returns whether all are finite.
  bool Accepts(int lane, const char* kind, const std::string& name,
               std::span<const FiniteCheck::Named> numbers) {
    return check_.Accepts(lane, time_s(lane), kind, name, numbers);
  }
  /// Commands a cable's rest length; it holds until a controller that drives the cable changes it.
  void SetRestLength(int lane, int cable, double rest_length_m);
  /// Sets forces by a person's hand or a program, in addition to the experiment's events.
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
    std::string custom;  ///< "custom controller 0 sets"; empty: not custom.
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
  /// Gives each lane a schedule of its own.
  void SplitSchedules();
  void AdvanceSchedules(int count);
  void Push(Lanes active);
  double NextBoundary(int lane) const;

  const ExperimentSpec& experiment_;
  Plant& plant_;
  ManySteps* many_;  ///< The plant; null if it takes one step at a time.
  int count_;        ///< Lanes with results.
  int plant_lanes_;
  bool has_forces_ = false;  ///< Whether any lane has, or had, a push, a drag or a hand force.
  std::vector<Schedule> schedules_;  ///< One for all lanes; one per lane after the first restart.
  std::vector<Timeline> timelines_;
  std::vector<Sensor> sensors_;  ///< Each receives the output of the previous one.
  std::vector<Law> laws_;
  std::vector<double> step_s_, to_s_;
  FiniteCheck check_;
  bool watches_commands_ = false;
  bool watches_readings_;  ///< Readings that taut does not compute.
};

}  // namespace taut::plant
