/// Least stiffness by second differences of the potential energy. Used by tests only; shares no
/// code with src/analysis.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"
#include "taut/model_def.h"

namespace taut::mechanics {

/// Energy of a model of points and straight rods in the oracle's coordinates: points move along the
/// free directions of their joint with the world, rods by five coordinates, or by two about a ball
/// joint with the world.
class EnergyOracle {
 public:
  /// `step_m` must be so short that no taut cable becomes slack.
  explicit EnergyOracle(const ModelDef& def, double step_m = 1e-3) : def_(def), step_(step_m) {
    for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) AddBody(b);
  }

  /// Returns the smallest eigenvalue of the energy's second derivative over the squared
  /// displacements of all places [N/m], without the `zeros` eigenvalues next to zero.
  double LeastStiffness(int zeros) const {
    const Eigen::MatrixXd moves = Jacobian();
    const Eigen::MatrixXd metric = moves.transpose() * moves;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(Hessian(), metric);
    std::vector<double> values(solver.eigenvalues().data(),
                               solver.eigenvalues().data() + solver.eigenvalues().size());
    std::sort(values.begin(), values.end(),
              [](double a, double b) { return std::fabs(a) < std::fabs(b); });
    values.erase(values.begin(), values.begin() + zeros);
    return *std::min_element(values.begin(), values.end());
  }

 private:
  struct Body {
    Vec3 origin, direction;  ///< Axis of a rod; `direction` is zero for points. `direction` is zero
                             ///< for points.
    Vec3 across[2];
    std::vector<Vec3> slides;  ///< Unit vectors along which the origin moves.
    int first = 0;             ///< Index of the first coordinate.
  };
  struct Place {
    int body;
    double along;  ///< Distance from the origin along the direction.
  };

  void AddBody(int b) {
    std::vector<Vec3> points;
    const auto add = [&](int body, const Vec3& at) {
      const bool known = std::any_of(points.begin(), points.end(),
                                     [&](const Vec3& p) { return Length(p - at) < 1e-9; });
      if (body == b && !known) points.push_back(at);
    };
    for (const CableDef& cable : def_.cables) {
      for (const AttachmentDef& at : cable.attachments) add(at.body, at.position_m);
    }
    const JointDef* support = nullptr;
    for (const JointDef& joint : def_.joints) {
      add(joint.body_a, joint.from_m), add(joint.body_b, joint.to_m);
      if (joint.body_a == kWorld && joint.body_b == b) support = &joint;
    }
    Body body;
    body.first = count_;
    body.origin =
        support != nullptr ? support->to_m : def_.bodies[static_cast<std::size_t>(b)].com_m;
    body.slides = Slides(support);
    if (points.size() > 1) {
      body.direction = points[1] - points[0];
      body.direction = (1 / Length(body.direction)) * body.direction;
      const Vec3 other = std::fabs(body.direction.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      body.across[0] = Cross(body.direction, other);
      body.across[0] = (1 / Length(body.across[0])) * body.across[0];
      body.across[1] = Cross(body.direction, body.across[0]);
    }
    count_ += static_cast<int>(body.slides.size()) + (points.size() > 1 ? 2 : 0);
    for (const Vec3& p : points) places_.push_back({b, Dot(p - body.origin, body.direction)});
    bodies_.push_back(body);
  }
  static std::vector<Vec3> Slides(const JointDef* support) {
    std::vector<Vec3> all;
    for (const Vec3& unit : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      const bool along = support != nullptr && std::fabs(Dot(unit, support->axis)) > 0.5;
      const bool held = support != nullptr && (support->kind == JointKind::kBall ||
                                               (support->kind == JointKind::kLine && !along) ||
                                               (support->kind == JointKind::kPlane && along));
      if (!held) all.push_back(unit);
    }
    return all;
  }

  Vec3 Moved(int body, double along, const Eigen::VectorXd& q) const {
    const Body& b = bodies_[static_cast<std::size_t>(body)];
    Vec3 at = b.origin;
    int i = b.first;
    for (const Vec3& slide : b.slides) at = at + q[i++] * slide;
    if (Length(b.direction) == 0) return at;
    Vec3 direction = b.direction + q[i] * b.across[0] + q[i + 1] * b.across[1];
    return at + (along / Length(direction)) * direction;
  }
  Vec3 Moved(int body, const Vec3& place, const Eigen::VectorXd& q) const {
    if (body == kWorld) return place;
    const Body& b = bodies_[static_cast<std::size_t>(body)];
    return Moved(body, Dot(place - b.origin, b.direction), q);
  }
  double Energy(const Eigen::VectorXd& q) const {
    double energy = 0;
    for (const CableDef& cable : def_.cables) {
      double length = 0;
      for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
        const AttachmentDef &a = cable.attachments[i - 1], &b = cable.attachments[i];
        length += Length(Moved(b.body, b.position_m, q) - Moved(a.body, a.position_m, q));
      }
      const double longer = std::max(0.0, length - cable.rest_length_m);
      energy += 0.5 * cable.stiffness_n_per_m * longer * longer;
    }
    for (const JointDef& bar : def_.joints) {
      if (bar.kind != JointKind::kDistance) continue;
      const double longer =
          Length(Moved(bar.body_b, bar.to_m, q) - Moved(bar.body_a, bar.from_m, q)) - bar.rest;
      energy += 0.5 * bar.stiffness * longer * longer;
    }
    for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
      const BodyDef& body = def_.bodies[static_cast<std::size_t>(b)];
      energy -= body.mass_kg * Dot(def_.gravity_m_per_s2, Moved(b, body.com_m, q));
    }
    return energy;
  }

  /// Returns the second difference along `by`, of order 4 in the step.
  double Second(const Eigen::VectorXd& by) const {
    return (-Energy(2 * by) + 16 * Energy(by) - 30 * Energy(0 * by) + 16 * Energy(-by) -
            Energy(-2 * by)) /
           12;
  }
  Eigen::MatrixXd Hessian() const {
    Eigen::MatrixXd h(count_, count_);
    for (int i = 0; i < count_; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Eigen::VectorXd a = step_ * Eigen::VectorXd::Unit(count_, i),
                              b = step_ * Eigen::VectorXd::Unit(count_, j);
        h(i, j) = h(j, i) =
            (i == j ? Second(a) : 0.25 * (Second(a + b) - Second(a - b))) / (step_ * step_);
      }
    }
    return h;
  }
  Eigen::MatrixXd Jacobian() const {
    const double step = 1e-4;
    Eigen::MatrixXd moves(3 * static_cast<Eigen::Index>(places_.size()), count_);
    for (int i = 0; i < count_; ++i) {
      const Eigen::VectorXd by = step * Eigen::VectorXd::Unit(count_, i);
      for (std::size_t p = 0; p < places_.size(); ++p) {
        const auto [body, along] = places_[p];
        const Vec3 way = Moved(body, along, by) - Moved(body, along, -by);
        moves.block<3, 1>(3 * static_cast<Eigen::Index>(p), i) << way.x, way.y, way.z;
      }
    }
    return moves / (2 * step);
  }

  const ModelDef def_;
  const double step_;
  std::vector<Body> bodies_;
  std::vector<Place> places_;
  int count_ = 0;
};

}  // namespace taut::mechanics
