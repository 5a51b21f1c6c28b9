/// Goal of an experiment, and the sensor of its direction.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

/// Returns the random horizontal offset of the start for a seed [m].
Vec3 PlaceOf(const StartNoise& noise, std::uint64_t seed);

/// Returns the goal in W, with the start noise of a seed.
Vec3 GoalOf(const GoalSpec& goal, const StartNoise& noise, std::uint64_t seed);

/// Returns the horizontal distance of a body's center of mass from the goal [m].
double DistanceToGoal(const Vec3& goal_m, const Vec3& body_m);

/// Compass, or camera that sees a beacon, at the goal of each lane (docs/theory/sensors.md). If the
/// plant observes the goal's direction, as a robot with such a sensor does, that direction is used.
/// Returns (0, 0) where neither bodies nor the goal are observed.
class GoalSensor final : public SensorModel {
 public:
  explicit GoalSensor(const ControlSetup& setup);

  ClockSpec clock() const override { return {goal_.period_s, 0.0}; }
  void Sample(const Tick& tick, const Observation& exact) override;
  const Observation& seen() const override { return shown_; }
  void Restart(int lane, const RolloutWorld& world) override;
  void Serialize(LaneState& state) override { state.Row(rows_); }

 private:
  GoalSpec goal_;
  std::vector<Vec3> at_m_;  ///< Per lane.
  std::vector<double> rows_;
  Observation shown_;
};

}  // namespace taut::plant
