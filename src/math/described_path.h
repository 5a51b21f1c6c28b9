/// The path of a cable as it is described.
#pragma once

#include <cstddef>
#include <vector>

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "taut/model_def.h"

namespace taut::math {

/// A wheel's angle (cable_wheel.h) as its attachment `i` is described [rad].
double StartAngle(const CableDef& cable, std::size_t i);

/// In W. Points of wheels are those where the cable arrives and leaves.
class DescribedPath {
 public:
  explicit DescribedPath(const CableDef& cable);

  double length_m() const { return length_m_; }
  int count() const { return static_cast<int>(points_.size()); }
  /// With places and directions; arms and velocities are zero.
  PathPoint<Vec3>* points() { return points_.data(); }
  const std::vector<Wheel<Vec3>>& wheels() const { return wheels_; }
  /// Which attachment point `i` of the path belongs to.
  std::size_t attachment(int i) const { return attachment_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<PathPoint<Vec3>> points_;
  std::vector<Wheel<Vec3>> wheels_;
  std::vector<std::size_t> attachment_;
  double length_m_ = 0;
};

/// Lengths of the spans between the places where it may slip: attachments with friction [m].
std::vector<double> SpanLengths(const CableDef& cable);

}  // namespace taut::math
