/// An experiment in the worlds of one group of lanes: what plant::Stepper is for one world.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "plant/lane_controllers.h"
#include "plant/schedule.h"
#include "plant/sensors.h"
#include "plant/timeline.h"
#include "taut/batch.h"
#include "taut/rollout.h"

namespace taut::rollout {

class LaneStepper {
 public:
  /// One variant a lane; all outlive the stepper. The batch has one group, at the start.
  LaneStepper(const ExperimentSpec& experiment, std::span<const RolloutWorld* const> lanes,
              Batch& batch);

  void Step();

  double time_s() const noexcept { return schedule_.time_s(); }
  double step_s() const noexcept { return schedule_.step_s(); }

  /// Of the state after the last step.
  const ReadingRows& readings() const noexcept { return cables_; }
  const std::vector<double>& set_point_n() const noexcept { return set_point_n_; }
  /// Cables that have set points, ascending.
  const std::vector<int>& driven() const noexcept { return driven_; }

 private:
  void Prepare();
  double NextBoundary() const;

  Batch& batch_;
  plant::Schedule schedule_;
  std::vector<plant::Timeline> timelines_;  ///< A lane; none if nothing ever happens.
  std::vector<plant::LaneController> controllers_;
  std::optional<plant::Sensors> sensors_;
  CableRows cables_;
  std::vector<double> set_point_n_;
  std::vector<int> driven_;
};

}  // namespace taut::rollout
