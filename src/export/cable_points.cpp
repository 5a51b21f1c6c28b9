#include "export/cable_points.h"

#include <cmath>
#include <numbers>

#include "math/described_path.h"
#include "math/vec.h"

namespace taut::exporting {
namespace {

constexpr double kArcStep = std::numbers::pi / 18;

}  // namespace

std::vector<Vec3> CablePoints(const CableDef& cable) {
  math::DescribedPath path(cable);
  std::vector<Vec3> points;
  for (int i = 0; i < path.count(); ++i) {
    points.push_back(path.points()[i].p);
    for (const auto& wheel : path.wheels()) {
      if (wheel.at != i || !(wheel.theta > 0)) continue;
      const Vec3 arrives = path.points()[i].p, leaves = path.points()[i + 1].p;
      const int steps = static_cast<int>(wheel.theta / kArcStep) + 1;
      const double rise = Dot(leaves - arrives, wheel.axis);
      for (int k = 1; k < steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        const double half = 0.5 * share * (wheel.angle < 0 ? -wheel.theta : wheel.theta);
        const Vec3 axis = std::sin(half) * wheel.axis;
        const Quat turn{std::cos(half), axis.x, axis.y, axis.z};
        points.push_back(wheel.center + Rotate(turn, arrives - wheel.center) +
                         (share * rise) * wheel.axis);
      }
    }
  }
  return points;
}

}  // namespace taut::exporting
