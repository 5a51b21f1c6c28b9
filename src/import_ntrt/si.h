/// From NTRT's units and frame to taut's, as people write them.
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace taut::import_ntrt {

/// y up becomes z up: taut's (x, y, z) is NTRT's (z, x, y).
inline Vec3 ZUp(const Vec3& v) { return {v.z, v.x, v.y}; }
inline Quat ZUp(const Quat& q) { return {q.w, q.z, q.x, q.y}; }

/// With 15 digits, which is what a product of two short numbers is good for: 0.031, where the
/// product 0.31 * 0.1 is 0.031000000000000003.
std::string NumberText(double number);
double Rounded15(double number);

/// Coordinates of something of that size: rounded to 1e-13 of it.
class Grid {
 public:
  explicit Grid(double size_m);
  std::string Text(double x) const;
  std::string Text(const Vec3& v) const;

 private:
  int decimals_ = 13;
};

/// `{axis: z, angle_rad: pi / 2}` where that is what it is, else a quaternion; empty for none.
std::string RotationText(const Quat& q);

/// Letters, digits, _ and -, as taut's names are; a slash becomes -.
std::string NameText(const std::string& ntrt);

/// Items in square brackets behind a key: on its line or, if they need more, below it.
std::string WrappedList(const std::vector<std::string>& items, const std::string& indent);

}  // namespace taut::import_ntrt
