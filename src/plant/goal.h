/// Goal of an experiment, and sensor of its direction.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

/// Returns the random horizontal offset of the start for a seed [m].
Vec3 PlaceOf(const StartNoise& noise, std::uint64_t seed);

/// Returns the goal in W, including the start noise of a seed.
Vec3 GoalOf(const GoalSpec& goal, const StartNoise& noise, std::uint64_t seed);

/// Returns the horizontal distance of a body's center of mass from the goal [m].
double DistanceToGoal(const Vec3& goal_m, const Vec3& body_m);

/// Sensor of the direction to the goal of each lane: a compass, or a camera that sees a beacon
/// (docs/theory/sensors.md). If the plant observes the direction itself, the sensor returns that
/// value. Returns (0, 0) if neither the bodies nor the direction are observed.
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
  std::vector<Vec3> at_m_;  ///< Position of the goal, per lane.
  std::vector<double> rows_;
  Observation shown_;
};

}  // namespace taut::plant
