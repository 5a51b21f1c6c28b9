#include "analysis/coordinate.h"

#include <cmath>

#include "math/vec.h"

namespace taut::analysis {

Placement Moved(const Placement& from, const Eigen::VectorXd& motions) {
  Placement to = from;
  for (std::size_t b = 0; b < to.center_m.size(); ++b) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(b);
    const Vec3 turn = To(motions.segment<3>(at + 3));
    to.center_m[b] = to.center_m[b] + To(motions.segment<3>(at));
    const double angle = std::sqrt(Dot(turn, turn)), half = 0.5 * angle;
    const double share = angle > 0 ? std::sin(half) / angle : 0.5;
    const Quat q =
        Quat{std::cos(half), share * turn.x, share * turn.y, share * turn.z} * to.turn[b];
    const double scale = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    to.turn[b] = {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
  }
  return to;
}

Vec3 ArmOf(const Anchor& anchor, const Placement& at) {
  if (anchor.body < 0) return anchor.at_m;
  return Rotate(at.turn[static_cast<std::size_t>(anchor.body)], anchor.at_m);
}

Vec3 PlaceOf(const Anchor& anchor, const Placement& at) {
  const Vec3 arm = ArmOf(anchor, at);
  return anchor.body < 0 ? arm : at.center_m[static_cast<std::size_t>(anchor.body)] + arm;
}

Eigen::Matrix3d CrossMatrix(const Vec3& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z, a.y, a.z, 0, -a.x, -a.y, a.x, 0;
  return m;
}

Eigen::Matrix3d TurnCurvature(const Vec3& along, const Vec3& arm) {
  const Eigen::Matrix3d product = Of(along) * Of(arm).transpose();
  return 0.5 * (product + product.transpose()) - Dot(along, arm) * Eigen::Matrix3d::Identity();
}

Coordinate PointAlong(const Anchor& point, const Vec3& direction, double offset,
                      const Placement& at) {
  Coordinate c;
  c.value = Dot(direction, PlaceOf(point, at)) - offset;
  if (point.body < 0) return c;
  const Vec3 arm = ArmOf(point, at);
  c.bodies = {point.body};
  c.gradient.resize(6);
  c.gradient << Of(direction), Of(Cross(arm, direction));
  c.hessian = Eigen::MatrixXd::Zero(6, 6);
  c.hessian.bottomRightCorner<3, 3>() = TurnCurvature(direction, arm);
  return c;
}

void Add(const Coordinate& c, double first, double second, Eigen::VectorXd& gradient,
         Eigen::MatrixXd* hessian) {
  for (std::size_t i = 0; i < c.bodies.size(); ++i) {
    const Eigen::Index from = 6 * static_cast<Eigen::Index>(i);
    const Eigen::Index row = 6 * static_cast<Eigen::Index>(c.bodies[i]);
    const auto own = c.gradient.segment<6>(from);
    gradient.segment<6>(row) += first * own;
    if (hessian == nullptr) continue;
    for (std::size_t j = 0; j < c.bodies.size(); ++j) {
      const Eigen::Index other = 6 * static_cast<Eigen::Index>(j);
      hessian->block<6, 6>(row, 6 * static_cast<Eigen::Index>(c.bodies[j])) +=
          first * c.hessian.block<6, 6>(from, other) +
          second * own * c.gradient.segment<6>(other).transpose();
    }
  }
}

}  // namespace taut::analysis
