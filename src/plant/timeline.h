/// Timeline: external forces on the robot by pushes and drags.
#pragma once

#include <cstdint>
#include <vector>

#include "taut/lane_state.h"
#include "taut/plant.h"

namespace taut::plant {

/// Returns the value of a piecewise linear profile, zero outside its points.
double ProfileAt(const std::vector<std::pair<double, double>>& points, double time_s);

/// The external forces of an experiment.
class Timeline {
 public:
  explicit Timeline(const ExperimentSpec& experiment);

  /// Returns true if there is never a push or drag.
  bool idle() const noexcept { return nodes_.empty(); }

  /// Returns the next time after `time_s` at which a profile has a corner; infinity if there is
  /// none.
  double NextCorner(double time_s) const;

  /// Sets the node forces for the step from `time_s` to `time_s + step_s`: values of pushes in its
  /// middle.
  void Apply(World& world, int lane, double time_s, double step_s);

  /// Restarts from the beginning, without hand forces.
  void Restart();
  /// Serializes the state, except hand forces.
  void Serialize(LaneState& state);

  /// Sets forces by a person's hand, outside the experiment, until the next call. They add to its
  /// pushes and drags.
  void SetHandForces(std::vector<ExternalForce> forces);

  /// Returns the forces of the last Apply by pushes and drags, without zeros.
  std::vector<ExternalForce> EventForces() const;

  /// Forces of the last Apply [N]: along the push's direction, and along the drag's.
  const std::vector<double>& push_n() const noexcept { return push_n_; }
  const std::vector<double>& drag_n() const noexcept { return drag_n_; }

 private:
  /// Adds a node to the nodes whose forces are set.
  void AddNode(int node);
  Vec3 DragForce(const Bodies& bodies, int lane, std::size_t drag, double time_s);

  const ExperimentSpec& experiment_;
  std::vector<double> corners_;
  std::vector<int> nodes_;   ///< All nodes that are ever pushed or dragged, in ascending order.
  std::vector<Vec3> set_n_;  ///< Forces last set in the world; NaN: none set yet.
  std::vector<double> push_n_, drag_n_;
  std::vector<ExternalForce> hand_;
  std::vector<Vec3> drag_start_m_;
  std::vector<std::uint8_t> dragging_;
};

}  // namespace taut::plant
