#include "math/principal_axes.h"

#include <algorithm>
#include <cmath>

namespace taut {

// Cyclic Jacobi rotations; only + - * / sqrt.
void PrincipalAxes(const Inertia& i, double r[9], double moments[3]) noexcept {
  double a[3][3] = {{i.xx, i.xy, i.xz}, {i.xy, i.yy, i.yz}, {i.xz, i.yz, i.zz}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double scale = std::fabs(i.xx) + std::fabs(i.yy) + std::fabs(i.zz);
  for (int sweep = 0; sweep < 60; ++sweep) {
    const double off = std::fabs(a[0][1]) + std::fabs(a[0][2]) + std::fabs(a[1][2]);
    if (!(off > 1e-17 * scale)) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (!(std::fabs(a[p][q]) > 0)) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t =
            (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double akp = a[k][p], akq = a[k][q];
          a[k][p] = c * akp - s * akq;
          a[k][q] = s * akp + c * akq;
        }
        for (int k = 0; k < 3; ++k) {
          const double apk = a[p][k], aqk = a[q][k];
          a[p][k] = c * apk - s * aqk;
          a[q][k] = s * apk + c * aqk;
        }
        for (int k = 0; k < 3; ++k) {
          const double vkp = v[k][p], vkq = v[k][q];
          v[k][p] = c * vkp - s * vkq;
          v[k][q] = s * vkp + c * vkq;
        }
      }
    }
  }
  for (int k = 0; k < 3; ++k) {
    moments[k] = a[k][k];
    for (int j = 0; j < 3; ++j) r[3 * k + j] = v[k][j];
  }
}

void SymmetryAxisLast(double r[9], double moments[3]) noexcept {
  constexpr double kEqual = 2e-15;
  const auto unlike = [&](int a, int b) {
    return std::fabs(moments[a] - moments[b]) / (moments[a] + moments[b]);
  };
  int z = 2;
  for (const int axis : {1, 0}) {
    const double now = unlike((axis + 1) % 3, (axis + 2) % 3);
    if (now < unlike((z + 1) % 3, (z + 2) % 3)) z = axis;
  }
  const int x = (z + 1) % 3;
  std::rotate(moments, moments + x, moments + 3);
  for (int row = 0; row < 3; ++row) std::rotate(r + 3 * row, r + 3 * row + x, r + 3 * row + 3);
  if (unlike(0, 1) < kEqual) moments[0] = moments[1] = 0.5 * (moments[0] + moments[1]);
}

}  // namespace taut
