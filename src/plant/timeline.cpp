#include "plant/timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec.h"

namespace taut::plant {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Vec3 kNothingYet{kNan, kNan, kNan};

}  // namespace

double ProfileAt(const std::vector<std::pair<double, double>>& points, double time_s) {
  if (points.empty() || time_s < points.front().first || time_s > points.back().first) return 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [t0, f0] = points[i - 1];
    const auto& [t1, f1] = points[i];
    if (time_s <= t1) return f0 + (f1 - f0) * ((time_s - t0) / (t1 - t0));
  }
  return points.back().second;
}

Timeline::Timeline(const ExperimentSpec& experiment)
    : experiment_(experiment),
      push_n_(experiment.pushes.size()),
      drag_n_(experiment.drags.size()),
      drag_start_m_(experiment.drags.size()),
      dragging_(experiment.drags.size()) {
  for (const PushSpec& push : experiment.pushes) {
    nodes_.push_back(push.node);
    for (const auto& point : push.force_n) corners_.push_back(point.first);
  }
  for (const DragSpec& drag : experiment.drags) {
    nodes_.push_back(drag.node);
    corners_.insert(corners_.end(), {drag.from_s, drag.to_s});
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  std::sort(corners_.begin(), corners_.end());
  set_n_.assign(nodes_.size(), kNothingYet);
}

double Timeline::NextCorner(double time_s) const {
  const auto next = std::upper_bound(corners_.begin(), corners_.end(), time_s);
  return next == corners_.end() ? std::numeric_limits<double>::infinity() : *next;
}

Vec3 Timeline::DragForce(const Bodies& bodies, int lane, std::size_t drag, double time_s) {
  const DragSpec& spec = experiment_.drags[drag];
  drag_n_[drag] = 0;
  if (time_s < spec.from_s || time_s > spec.to_s) return {};
  const Vec3 node = bodies.NodePosition(lane, spec.node);
  if (dragging_[drag] == 0) {
    dragging_[drag] = 1;
    drag_start_m_[drag] = node;
  }
  const Vec3 hand = drag_start_m_[drag] + (time_s - spec.from_s) * spec.velocity_m_per_s;
  const Vec3 slip = spec.velocity_m_per_s - bodies.NodeVelocity(lane, spec.node);
  const Vec3 force = spec.stiffness_n_per_m * (hand - node) + spec.damping_n_s_per_m * slip;
  const double speed = std::sqrt(Dot(spec.velocity_m_per_s, spec.velocity_m_per_s));
  drag_n_[drag] = speed > 0 ? Dot(force, spec.velocity_m_per_s) / speed : 0;
  return force;
}

void Timeline::Apply(World& world, int lane, double time_s, double step_s) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int node = nodes_[n];
    Vec3 force;
    for (std::size_t i = 0; i < experiment_.pushes.size(); ++i) {
      const PushSpec& push = experiment_.pushes[i];
      if (push.node != node) continue;
      push_n_[i] = push.scale * ProfileAt(push.force_n, time_s + 0.5 * step_s);
      force = force + push_n_[i] * push.direction;
    }
    for (std::size_t i = 0; i < experiment_.drags.size(); ++i) {
      if (experiment_.drags[i].node != node) continue;
      force = force + DragForce(world, lane, i, time_s);
    }
    for (const ExternalForce& hand : hand_) {
      if (hand.node == node) force = force + hand.force_n;
    }
    Vec3& set = set_n_[n];
    if (force.x == set.x && force.y == set.y && force.z == set.z) continue;
    set = force;
    world.SetNodeForce(lane, node, force);
  }
}

void Timeline::Restart() {
  std::fill(push_n_.begin(), push_n_.end(), 0.0);
  std::fill(drag_n_.begin(), drag_n_.end(), 0.0);
  dragging_.assign(dragging_.size(), 0);
  hand_.clear();
  set_n_.assign(nodes_.size(), kNothingYet);
}

void Timeline::Serialize(LaneState& state) {
  const auto all = [&state](auto& list) {
    for (auto& x : list) state.Value(x);
  };
  all(push_n_), all(drag_n_), all(drag_start_m_), all(dragging_);
  // Includes all nodes that a program has pushed, so that their forces are reset to zero.
  std::uint64_t count = nodes_.size();
  state.Value(count);
  if (!state.reads()) return all(nodes_);
  for (std::uint64_t i = 0; i < count && !state.failed(); ++i) {
    int node = 0;
    state.Value(node);
    AddNode(node);
  }
  // Set all forces again. The world's snapshot contains its current forces, but not the changes
  // that the timeline still has to make.
  set_n_.assign(nodes_.size(), kNothingYet);
}

void Timeline::AddNode(int node) {
  const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node);
  if (at != nodes_.end() && *at == node) return;
  set_n_.insert(set_n_.begin() + (at - nodes_.begin()), kNothingYet);
  nodes_.insert(at, node);
}

std::vector<ExternalForce> Timeline::EventForces() const {
  std::vector<ExternalForce> forces;
  const auto add = [&](int node, const Vec3& force) {
    if (Dot(force, force) > 0) forces.push_back({node, force});
  };
  for (std::size_t i = 0; i < experiment_.pushes.size(); ++i) {
    const PushSpec& push = experiment_.pushes[i];
    add(push.node, push_n_[i] * push.direction);
  }
  for (std::size_t i = 0; i < experiment_.drags.size(); ++i) {
    const DragSpec& drag = experiment_.drags[i];
    const double speed = std::sqrt(Dot(drag.velocity_m_per_s, drag.velocity_m_per_s));
    if (speed > 0) add(drag.node, (drag_n_[i] / speed) * drag.velocity_m_per_s);
  }
  return forces;
}

void Timeline::SetHandForces(std::vector<ExternalForce> forces) {
  hand_ = std::move(forces);
  // Nodes remain in the list after release, so that their forces are reset to zero.
  for (const ExternalForce& hand : hand_) AddNode(hand.node);
}

}  // namespace taut::plant
