/// Where the goal is, and the sensor that says in which direction.
#pragma once

#include <cstdint>
#include <vector>

#include "plant/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

/// By how much a start of this seed is beside the one described, horizontally [m].
Vec3 PlaceOf(const StartNoise& noise, std::uint64_t seed);

/// The goal in W, with the noise of a start of this seed.
Vec3 GoalOf(const GoalSpec& goal, const StartNoise& noise, std::uint64_t seed);

/// How far a body's centre of mass is from the goal, horizontally [m].
double DistanceToGoal(const Vec3& goal_m, const Vec3& body_m);

/// A compass, or a camera that sees a beacon, at the goal of each lane (docs/theory/sensors.md).
/// Where the plant says itself where the goal is, as a robot with such a sensor does, that is
/// shown. Where neither bodies nor the goal are known it says (0, 0).
class GoalSensor final : public SensorModel {
 public:
  explicit GoalSensor(const ControlSetup& setup);

  ClockSpec clock() const override { return {goal_.period_s, 0.0}; }
  void Sample(const Tick& tick, const Observation& exact) override;
  const Observation& seen() const override { return shown_; }
  void Restart(int lane, const RolloutWorld& world) override;
  void Carry(LaneState& state) override { state.Row(rows_); }

 private:
  GoalSpec goal_;
  std::vector<Vec3> at_m_;  ///< Per lane.
  std::vector<double> rows_;
  Observation shown_;
};

}  // namespace taut::plant
