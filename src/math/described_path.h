/// Path of a cable in the described pose, with cable wrapping around its wheels.
#pragma once

#include <cstddef>
#include <vector>

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "taut/model_def.h"

namespace taut::math {

/// Returns the initial angle of a wheel (cable_wheel.h), from the description of its attachment `i`
/// [rad].
double StartAngle(const CableDef& cable, std::size_t i);

/// Path in W. A wheel has two points, where the cable arrives and leaves.
class DescribedPath {
 public:
  explicit DescribedPath(const CableDef& cable);

  double length_m() const { return length_m_; }
  int count() const { return static_cast<int>(points_.size()); }
  /// Returns points with positions and directions; arms and velocities are zero.
  PathPoint<Vec3>* points() { return points_.data(); }
  const std::vector<Wheel<Vec3>>& wheels() const { return wheels_; }
  /// Returns the attachment that point `i` of the path belongs to.
  std::size_t attachment(int i) const { return attachment_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<PathPoint<Vec3>> points_;
  std::vector<Wheel<Vec3>> wheels_;
  std::vector<std::size_t> attachment_;
  double length_m_ = 0;
};

/// Returns the lengths of the spans between slip places, i.e. attachments with friction [m].
std::vector<double> SpanLengths(const CableDef& cable);

}  // namespace taut::math
