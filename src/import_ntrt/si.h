/// Conversion from NTRT's units and frame to taut's, and readable number texts.
#pragma once

#include <string>
#include <vector>

#include "math/vec.h"

namespace taut::import_ntrt {

/// Converts y up to z up: taut's (x, y, z) is NTRT's (z, x, y).
inline Vec3 ZUp(const Vec3& v) { return {v.z, v.x, v.y}; }
inline Quat ZUp(const Quat& q) { return {q.w, q.z, q.x, q.y}; }

/// Returns a number with 15 digits, to hide rounding errors: 0.31 * 0.1 is 0.031000000000000003,
/// but is written as 0.031.
std::string NumberText(double number);
double Rounded15(double number);

/// Writer of coordinates. Rounds them to 1e-13 of the object's size.
class Grid {
 public:
  explicit Grid(double size_m);
  std::string Text(double x) const;
  std::string Text(const Vec3& v) const;

 private:
  int decimals_ = 13;
};

/// Returns `{axis: z, angle_rad: pi / 2}` if the rotation has this form, otherwise a quaternion.
/// Returns an empty text for the identity.
std::string RotationText(const Quat& q);

/// Converts an NTRT name to a valid name of taut with letters, digits, _ and -. A slash becomes -.
std::string NameText(const std::string& ntrt);

/// Returns a list in square brackets, in the line of its key or, if too long, below it.
std::string WrappedList(const std::vector<std::string>& items, const std::string& indent);

}  // namespace taut::import_ntrt
