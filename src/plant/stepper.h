/// An experiment's world, controllers and timeline, advanced step by step. Who calls decides when
/// to record, to show and to stop.
#pragma once

#include <optional>
#include <vector>

#include "plant/controllers.h"
#include "plant/schedule.h"
#include "plant/sensors.h"
#include "plant/timeline.h"
#include "taut/batch.h"
#include "taut/spec.h"

namespace taut::plant {

class Stepper {
 public:
  /// Both outlive the stepper. The batch is at the experiment's start.
  Stepper(const ExperimentSpec& experiment, Batch& batch);

  /// Lets the controllers act if one is due. The next Step does so, too; a row that is recorded at
  /// the start wants their first commands.
  void Prepare();

  /// One step. Steps land on the ticks of controllers, the corners of the timeline and the
  /// experiment's end, and go on after it.
  void Step();

  double time_s() const noexcept { return schedule_.time_s(); }
  double step_s() const noexcept { return schedule_.step_s(); }  ///< Of the last step.
  bool finite() const noexcept;

  /// As it is; and what the controllers saw of it at their last tick.
  const std::vector<CableState>& readings() const noexcept { return readings_; }
  const std::vector<CableState>& sensed() const noexcept { return sensors_ ? sensed_ : readings_; }
  const CableCommands& commands() const noexcept { return commands_; }
  const std::vector<double>& set_point_n() const noexcept { return commands_.set_point_n; }
  Timeline& timeline() noexcept { return timeline_; }
  const Timeline& timeline() const noexcept { return timeline_; }
  std::vector<Controller>& controllers() noexcept { return controllers_; }
  const std::vector<Controller>& controllers() const noexcept { return controllers_; }

  /// Commands a cable that no controller drives.
  void SetTarget(int cable, double rest_length_m);

 private:
  void Observe();
  void Sense();
  double NextBoundary() const;

  Batch& batch_;
  Schedule schedule_;
  Timeline timeline_;
  std::vector<Controller> controllers_;
  std::optional<Sensors> sensors_;
  std::vector<CableState> readings_, sensed_;
  CableReadings<std::vector<double>> exact_;  ///< `readings_` as the sensors want them.
  CableCommands commands_;
};

}  // namespace taut::plant
