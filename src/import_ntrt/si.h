/// Conversion from NTRT's units and frame to taut's, with readable numbers.
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace taut::import_ntrt {

/// y up becomes z up: taut's (x, y, z) is NTRT's (z, x, y).
inline Vec3 ZUp(const Vec3& v) { return {v.z, v.x, v.y}; }
inline Quat ZUp(const Quat& q) { return {q.w, q.z, q.x, q.y}; }

/// Returns a number with 15 digits, the accuracy of a product of two short numbers: 0.031, where
/// the product 0.31 * 0.1 is 0.031000000000000003.
std::string NumberText(double number);
double Rounded15(double number);

/// Text of coordinates of an object of a given size: rounded to 1e-13 of it.
class Grid {
 public:
  explicit Grid(double size_m);
  std::string Text(double x) const;
  std::string Text(const Vec3& v) const;

 private:
  int decimals_ = 13;
};

/// Returns `{axis: z, angle_rad: pi / 2}` if the rotation has this form, else a quaternion; empty
/// for none.
std::string RotationText(const Quat& q);

/// Returns a valid name of taut: letters, digits, _ and -; a slash becomes -.
std::string NameText(const std::string& ntrt);

/// Returns items in square brackets after a key: on its line or, if they are too long, below it.
std::string WrappedList(const std::vector<std::string>& items, const std::string& indent);

}  // namespace taut::import_ntrt
