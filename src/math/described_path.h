/// Path of a cable in the described pose, including wrapping around its wheels.
#pragma once

#include <cstddef>
#include <vector>

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "taut/model_def.h"

namespace taut::math {

/// Returns the initial angle [rad] of the wheel (cable_wheel.h) of attachment `i`, as defined by
/// the model.
double StartAngle(const CableDef& cable, std::size_t i);

/// Path in W. A wheel has two points, at which the cable reaches and leaves it.
class DescribedPath {
 public:
  explicit DescribedPath(const CableDef& cable);

  double length_m() const { return length_m_; }
  int count() const { return static_cast<int>(points_.size()); }
  /// Returns the points with positions and directions; `arm` and `v` are zero.
  PathPoint<Vec3>* points() { return points_.data(); }
  const std::vector<Wheel<Vec3>>& wheels() const { return wheels_; }
  /// Returns the index of the attachment of point `i` of the path.
  std::size_t attachment(int i) const { return attachment_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<PathPoint<Vec3>> points_;
  std::vector<Wheel<Vec3>> wheels_;
  std::vector<std::size_t> attachment_;
  double length_m_ = 0;
};

/// Returns the lengths [m] of the spans between attachments with friction.
std::vector<double> SpanLengths(const CableDef& cable);

}  // namespace taut::math
