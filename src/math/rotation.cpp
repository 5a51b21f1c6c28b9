#include "math/rotation.h"

#include <algorithm>
#include <cmath>

namespace taut {

Quat QuatOf(const double r[9]) noexcept {
  const double t[4] = {1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8],
                       1 - r[0] - r[4] + r[8]};
  const int best = static_cast<int>(std::max_element(t, t + 4) - t);
  const double s = 0.5 / std::sqrt(t[best]), d = 0.5 * std::sqrt(t[best]);
  const double x = r[7] - r[5], y = r[2] - r[6], z = r[3] - r[1];
  switch (best) {
    case 0:
      return {d, x * s, y * s, z * s};
    case 1:
      return {x * s, d, (r[1] + r[3]) * s, (r[2] + r[6]) * s};
    case 2:
      return {y * s, (r[1] + r[3]) * s, d, (r[5] + r[7]) * s};
    default:
      return {z * s, (r[2] + r[6]) * s, (r[5] + r[7]) * s, d};
  }
}

void MatrixOf(const Quat& q, double r[9]) noexcept {
  const double n = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double w = q.w * n, x = q.x * n, y = q.y * n, z = q.z * n;
  const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                       2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                       2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  std::copy(m, m + 9, r);
}

}  // namespace taut
