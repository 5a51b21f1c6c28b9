#include "analysis/cable_coordinate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/described_path.h"
#include "math/vec.h"

namespace taut::analysis {

CableCoordinate::CableCoordinate(const CableDef& cable, std::vector<Anchor> anchors)
    : anchors_(std::move(anchors)) {
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const int body = anchors_[i].body;
    const auto found = std::find(bodies_.begin(), bodies_.end(), body);
    local_.push_back(body < 0 ? -1 : static_cast<int>(found - bodies_.begin()));
    if (body >= 0 && found == bodies_.end()) bodies_.push_back(body);
    const auto& wheel = cable.attachments[i].wheel;
    if (wheel) wheels_.push_back({i, wheel->axis, wheel->radius_m, math::StartAngle(cable, i)});
  }
}

CableCoordinate::Path CableCoordinate::Lay(const Placement& at) const {
  Path path;
  std::vector<Wheel<Vec3>> wheels;
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const Vec3 arm = local_[i] < 0 ? Vec3{} : ArmOf(anchors_[i], at);
    path.points.push_back({PlaceOf(anchors_[i], at), {}, arm, {}});
    path.attachment.push_back(i);
    if (wheels.size() == wheels_.size() || wheels_[wheels.size()].attachment != i) continue;
    const WheelAt& wheel = wheels_[wheels.size()];
    const Vec3 axis = ArmOf({anchors_[i].body, wheel.axis}, at);
    const int arrives = static_cast<int>(path.points.size()) - 1;
    wheels.push_back({path.points.back().p, axis, wheel.radius, wheel.angle, arrives, 0, 0, 0});
    path.points.push_back(path.points.back());
    path.attachment.push_back(i);
  }
  const int count = static_cast<int>(path.points.size());
  const int wheel_count = static_cast<int>(wheels.size());
  LayOnWheels(path.points.data(), wheel_count, wheels.data());
  for (int w = 0; w < wheel_count; ++w) {  // arms to the points at which the cable reaches and
                                           // leaves the wheel
    for (int i = wheels[static_cast<std::size_t>(w)].at;
         i < wheels[static_cast<std::size_t>(w)].at + 2; ++i) {
      const std::size_t point = static_cast<std::size_t>(i);
      const int body = anchors_[path.attachment[point]].body;
      if (body < 0) continue;
      path.points[point].arm = path.points[point].p - at.center_m[static_cast<std::size_t>(body)];
    }
  }
  path.length = MeasurePath(count, path.points.data(), wheel_count, wheels.data()).l;
  return path;
}

Eigen::VectorXd CableCoordinate::Gradient(const Path& path) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(bodies_.size()));
  const int count = static_cast<int>(path.points.size());
  for (int i = 0; i < count; ++i) {
    const int body = local_[path.attachment[static_cast<std::size_t>(i)]];
    if (body < 0) continue;
    const Vec3 pull = PullAt(count, path.points.data(), i);
    gradient.segment<3>(6 * body) -= Of(pull);
    gradient.segment<3>(6 * body + 3) -=
        Of(Cross(path.points[static_cast<std::size_t>(i)].arm, pull));
  }
  return gradient;
}

// Second derivatives of the length (eq. 9): for each span, a term of the motions perpendicular to
// it; for each point, a term of the rotations of its body. The cross terms of clustered cables (eq.
// 10) are not added here. They follow from the square of the gradient, which is summed over all
// spans.
Eigen::MatrixXd CableCoordinate::ExactHessian(const Path& path) const {
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(bodies_.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  const auto body_of = [&](std::size_t i) { return local_[path.attachment[i]]; };
  const auto moves = [&](std::size_t i) {
    Eigen::Matrix<double, 3, 6> m;
    m << Eigen::Matrix3d::Identity(), -CrossMatrix(path.points[i].arm);
    return m;
  };
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const Vec3 way = path.points[i].p - path.points[i - 1].p;
    const double length = std::max(std::sqrt(Dot(way, way)), 1e-12);
    const Eigen::Vector3d u = Of(path.points[i].u);
    const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - u * u.transpose()) / length;
    for (const std::size_t p : {i - 1, i}) {
      if (body_of(p) < 0) continue;
      const double sign = p == i ? 1 : -1;
      hessian.block<3, 3>(6 * body_of(p) + 3, 6 * body_of(p) + 3) +=
          TurnCurvature(sign * path.points[i].u, path.points[p].arm);
      for (const std::size_t q : {i - 1, i}) {
        if (body_of(q) < 0) continue;
        hessian.block<6, 6>(6 * body_of(p), 6 * body_of(q)) +=
            (p == q ? 1.0 : -1.0) * moves(p).transpose() * across * moves(q);
      }
    }
  }
  return hessian;
}

// Central differences with a relative error of about 1e-10. The differences have an antisymmetric
// part, because the axes rotate with the body. The Hessian in the chart exp(theta) has no such part
// (eq. 3); symmetrizing removes it.
Eigen::MatrixXd CableCoordinate::DifferenceHessian(const Placement& at) const {
  constexpr double kStep = 1e-5;
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(bodies_.size());
  Eigen::MatrixXd columns(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    Eigen::VectorXd motions = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(at.turn.size()));
    double& motion = motions[6 * bodies_[static_cast<std::size_t>(i / 6)] + i % 6];
    motion = kStep;
    const Eigen::VectorXd ahead = Gradient(Lay(Moved(at, motions)));
    motion = -kStep;
    columns.col(i) = (ahead - Gradient(Lay(Moved(at, motions)))) / (2 * kStep);
  }
  return 0.5 * (columns + columns.transpose());
}

Coordinate CableCoordinate::At(const Placement& at, bool with_hessian) const {
  const Path path = Lay(at);
  Coordinate c;
  c.value = path.length;
  c.bodies = bodies_;
  c.gradient = Gradient(path);
  if (with_hessian) c.hessian = has_wheels() ? DifferenceHessian(at) : ExactHessian(path);
  return c;
}

std::vector<double> CableCoordinate::SpansAt(const Placement& at) const {
  std::vector<double> spans;
  for (std::size_t i = 1; i < anchors_.size(); ++i) {
    const Vec3 way = PlaceOf(anchors_[i], at) - PlaceOf(anchors_[i - 1], at);
    spans.push_back(std::sqrt(Dot(way, way)));
  }
  return spans;
}

}  // namespace taut::analysis
