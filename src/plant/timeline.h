/// Timeline: external forces on the robot due to pushes and drags.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

/// Returns the value of a piecewise linear profile; zero before the first and after the last point.
double ProfileAt(const std::vector<std::pair<double, double>>& points, double time_s);

/// External forces of an experiment.
class Timeline {
 public:
  explicit Timeline(const ExperimentSpec& experiment);

  /// Returns whether there are no pushes, drags or hand forces.
  bool idle() const noexcept { return nodes_.empty(); }

  /// Returns the time of the next corner of a profile after `time_s`; infinity if there is none.
  double NextCorner(double time_s) const;

  /// Sets the node forces for the step from `time_s` to `time_s + step_s`. Pushes have their value
  /// in the middle of the step.
  void Apply(World& world, int lane, double time_s, double step_s);

  /// Restarts the timeline and removes hand forces.
  void Restart();
  /// Serializes the state, without hand forces.
  void Serialize(LaneState& state);

  /// Sets forces by a user's hand until the next call, in addition to the experiment's pushes and
  /// drags.
  void SetHandForces(std::vector<ExternalForce> forces);

  /// Returns the nonzero forces of pushes and drags at the last call of `Apply`.
  std::vector<ExternalForce> EventForces() const;

  /// Returns the forces at the last call of `Apply` [N]: along each push's and each drag's
  /// direction.
  const std::vector<double>& push_n() const noexcept { return push_n_; }
  const std::vector<double>& drag_n() const noexcept { return drag_n_; }

 private:
  /// Adds a node whose force is set at each step.
  void AddNode(int node);
  Vec3 DragForce(const Bodies& bodies, int lane, std::size_t drag, double time_s);

  const ExperimentSpec& experiment_;
  std::vector<double> corners_;
  std::vector<int> nodes_;   ///< All nodes with pushes, drags or hand forces, in ascending order.
  std::vector<Vec3> set_n_;  ///< Forces last set in the world; NaN: not set yet.
  std::vector<double> push_n_, drag_n_;
  std::vector<ExternalForce> hand_;
  std::vector<Vec3> drag_start_m_;
  std::vector<std::uint8_t> dragging_;
};

}  // namespace taut::plant
