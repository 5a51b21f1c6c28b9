/// Pose of the principal frame of each body in W, during the compilation of a model.
#pragma once

#include <cmath>

#include "taut/types.h"

namespace taut::sim {

struct Frame {
  double r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Rotation R_WP from frame P to W, row by row.
  double origin[3] = {};
};

inline void ToBody(const Frame& f, const Vec3& p, double out[3]) {
  const double d[3] = {p.x - f.origin[0], p.y - f.origin[1], p.z - f.origin[2]};
  for (int i = 0; i < 3; ++i) out[i] = f.r[i] * d[0] + f.r[3 + i] * d[1] + f.r[6 + i] * d[2];
}

inline double Length(const double p[3]) {
  return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

}  // namespace taut::sim
