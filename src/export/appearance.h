/// Colors of shapes in exported files, the same as in the viewer.
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>

#include "taut/shape_mesh.h"

namespace taut::exporting {

struct Appearance {
  ShapeMesh::Kind kind;
  const char* name;
  int rgb;  ///< sRGB color.

  /// Returns the red, green or blue component (`which` = 0, 1, 2) in sRGB, from 0 to 1.
  double Screen(int which) const { return (rgb >> (16 - 8 * which) & 0xff) / 255.0; }
  /// Returns a component as linear intensity (IEC 61966-2-1).
  double Light(int which) const {
    const double x = Screen(which);
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  }
};
inline constexpr Appearance kPalette[] = {{ShapeMesh::Kind::kRod, "rod", 0x39414b},
                                          {ShapeMesh::Kind::kSphere, "sphere", 0x5c6773},
                                          {ShapeMesh::Kind::kBox, "box", 0x8b97a3},
                                          {ShapeMesh::Kind::kHull, "hull", 0x8b97a3},
                                          {ShapeMesh::Kind::kCable, "cable", 0x3882cd},
                                          {ShapeMesh::Kind::kSlackCable, "cable_slack", 0x6d7781}};

inline const Appearance& AppearanceOf(ShapeMesh::Kind kind) {
  return *std::find_if(std::begin(kPalette), std::end(kPalette),
                       [&](const Appearance& one) { return one.kind == kind; });
}

}  // namespace taut::exporting
