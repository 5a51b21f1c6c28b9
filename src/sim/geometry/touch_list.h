/// Helpers of the narrow phase (shape_contacts.h). The helpers use compiler builtins, because a
/// step uses no standard library.
#pragma once

#include "math/scalar.h"
#include "math/vec.h"
#include "sim/geometry/shape_contacts.h"

namespace taut::sim {

inline Vec3 Load(const double* p) noexcept { return {p[0], p[1], p[2]}; }
inline Vec3 AxisOf(const BoxShape& box, int axis) noexcept { return Load(box.axes + 3 * axis); }
inline double Norm(const Vec3& a) noexcept { return Sqrt(Dot(a, a)); }
inline double Larger(double a, double b) noexcept { return a > b ? a : b; }
inline double Smaller(double a, double b) noexcept { return a < b ? a : b; }
inline double Clamp(double x, double low, double high) noexcept {
  return x < low ? low : x > high ? high : x;
}

/// Returns half the width of a box along a unit direction.
inline double Reach(const BoxShape& box, const Vec3& direction) noexcept {
  double reach = 0.0;
  for (int i = 0; i < 3; ++i) reach += box.half_m[i] * Abs(Dot(AxisOf(box, i), direction));
  return reach;
}
/// Returns whether a point is in a box enlarged by `more_m` on all sides.
inline bool IsIn(const BoxShape& box, const Vec3& p, double more_m) noexcept {
  const Vec3 d = p - Load(box.center);
  for (int axis = 0; axis < 3; ++axis) {
    if (Abs(Dot(d, AxisOf(box, axis))) > box.half_m[axis] + more_m) return false;
  }
  return true;
}

/// Contact points found so far, with a gap below the margin.
class TouchList {
 public:
  TouchList(TouchPoint* out, double margin_m) noexcept : out_(out), margin_m_(margin_m) {}

  void Add(const Vec3& point, const Vec3& normal, double gap_m, int feature) noexcept {
    if (!(gap_m < margin_m_)) return;
    least_gap_m_ = Smaller(least_gap_m_, gap_m);
    out_[count_++] = {
        {point.x, point.y, point.z}, {normal.x, normal.y, normal.z}, gap_m, feature, 0.0};
  }
  int count() const noexcept { return count_; }
  double margin_m() const noexcept { return margin_m_; }
  double least_gap_m() const noexcept { return least_gap_m_; }

 private:
  TouchPoint* out_;
  double margin_m_, least_gap_m_ = 1e300;
  int count_ = 0;
};

}  // namespace taut::sim
