#include "math/align.h"

#include <cmath>
#include <cstddef>

#include "base/assert.h"
#include "math/vec.h"

namespace taut {
namespace {

/// Computes eigenvalues and eigenvectors by cyclic Jacobi rotations. Results: the eigenvalues on
/// the diagonal of `a`, the eigenvectors in the columns of `v`.
void Diagonalize(double a[4][4], double v[4][4]) {
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) v[i][j] = i == j ? 1.0 : 0.0;
  }
  for (int sweep = 0; sweep < 60; ++sweep) {
    double off = 0, scale = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) (i == j ? scale : off) += std::fabs(a[i][j]);
    }
    if (!(off > 1e-17 * scale)) return;
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) {
        if (!(std::fabs(a[p][q]) > 0)) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t =
            (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        const auto turn = [c, s](double& x, double& y) {
          const double before = x;
          x = c * before - s * y;
          y = s * before + c * y;
        };
        for (int k = 0; k < 4; ++k) turn(a[k][p], a[k][q]);
        for (int k = 0; k < 4; ++k) turn(a[p][k], a[q][k]);
        for (int k = 0; k < 4; ++k) turn(v[k][p], v[k][q]);
      }
    }
  }
}

Vec3 Mean(std::span<const Vec3> points) {
  Vec3 sum;
  for (const Vec3& p : points) sum = sum + p;
  return points.empty() ? sum : (1.0 / static_cast<double>(points.size())) * sum;
}

}  // namespace

Vec3 RigidMotion::Of(const Vec3& point_m) const noexcept {
  return to_center_m + Rotate(turn, point_m - from_center_m);
}

// B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, J. Opt. Soc.
// Am. A 4 (1987), section 4: the rotation is the eigenvector with the largest eigenvalue of N. The
// elements of N are combinations of the sums S_xy of products of coordinates.
RigidMotion Align(std::span<const Vec3> from_m, std::span<const Vec3> to_m) {
  TAUT_ASSERT(from_m.size() == to_m.size());
  RigidMotion motion{Mean(from_m), Mean(to_m), {}};
  double s[3][3] = {};
  for (std::size_t i = 0; i < from_m.size(); ++i) {
    const Vec3 a = from_m[i] - motion.from_center_m, b = to_m[i] - motion.to_center_m;
    const double l[] = {a.x, a.y, a.z}, r[] = {b.x, b.y, b.z};
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) s[j][k] += l[j] * r[k];
    }
  }
  const double yz = s[1][2] - s[2][1], zx = s[2][0] - s[0][2], xy = s[0][1] - s[1][0];
  double n[4][4] = {{s[0][0] + s[1][1] + s[2][2], yz, zx, xy},
                    {yz, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
                    {zx, s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
                    {xy, s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}};
  double v[4][4];
  Diagonalize(n, v);
  int best = 0;
  for (int i = 1; i < 4; ++i) {
    if (n[i][i] > n[best][best]) best = i;
  }
  motion.turn = {v[0][best], v[1][best], v[2][best], v[3][best]};
  return motion;
}

}  // namespace taut
