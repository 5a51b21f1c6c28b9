/// Forces against the statics of a description and against differences of the energy; tangent
/// stiffness against differences of the forces

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/tangent.h"
#include "taut/statics.h"
#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::test {
namespace {

using analysis::Moved;
using analysis::Placement;
using analysis::Structure;

Quat Turn(const Vec3& by) {
  const double angle = std::sqrt(Dot(by, by)), share = std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), share * by.x, share * by.y, share * by.z};
}

/// Four bodies in random poses with one of everything: cables between points, through eyelets and
/// around a wheel, a slack cable, a bar, springs of a ball, a hinge and a guide, loads, weight
class Anything {
 public:
  explicit Anything(unsigned seed) : random_(seed) {
    for (int b = 0; b < 4; ++b) {
      const int index = AddPoint(def_, "body" + std::to_string(b), Any(1), 1.0 + b);
      def_.bodies.back().inertia_kg_m2 = {1, 2, 2.5, 0.1, 0.2, -0.1};
      def_.nodes.push_back({"node" + std::to_string(b), index, At(b)});
      loads_.forces.push_back({2 * b + 1, Any(5)});
    }
    for (int b = 0; b < 4; ++b) {
      Cable({{b, At(b)}, {(b + 1) % 4, At((b + 1) % 4)}}, 0.8);
      Cable({{b, At(b)}, {kWorld, Any(2)}}, 0.8);
    }
    Cable({{0, At(0)}, {1, At(1)}, {2, At(2)}, {0, At(0)}, {kWorld, Any(2)}}, 0.7);
    Cable({{1, At(1)}, {3, At(3)}}, 1.5);  // slack
    const Vec3 middle = At(2);
    WheelDef wheel;
    wheel.axis = Any(1);
    wheel.axis = (1 / std::sqrt(Dot(wheel.axis, wheel.axis))) * wheel.axis;
    wheel.radius_m = 0.03;
    wheel.turns = 1;
    Cable({{3, At(3)}, {2, middle, 0, wheel}, {1, At(1)}}, 0.6);
    AddBar(def_, 1, At(1), 2, At(2), 300, 0.2);
    AddJoint(def_, JointKind::kBall, 0, At(0), 1, At(1)).stiffness = 7;
    def_.joints.back().turned = Turn(Any(1));
    AddJoint(def_, JointKind::kHinge, 1, At(1), 3, At(3), Unit()).stiffness = 11;
    AddJoint(def_, JointKind::kPrismatic, kWorld, Any(1), 2, At(2), Unit()).stiffness = 13;
    AddJoint(def_, JointKind::kLine, 3, At(3), 0, At(0), Unit()).stiffness = 17;
    def_.joints.back().rest = 0.1;
  }
  ModelDef def_;
  LoadCaseSpec loads_;

  Vec3 Any(double size) {
    std::uniform_real_distribution<double> d(-size, size);
    const double x = d(random_), y = d(random_);
    return {x, y, d(random_)};
  }
  Vec3 Unit() {
    const Vec3 a = Any(1);
    return (1 / std::sqrt(Dot(a, a))) * a;
  }

 private:
  Vec3 At(int body) { return def_.bodies[static_cast<std::size_t>(body)].com_m + Any(0.5); }
  void Cable(const std::vector<AttachmentDef>& way, double rest) {
    AddCable(def_, way, 200, 1);
    def_.cables.back().rest_length_m = rest * CableLength(def_.cables.back());
  }
  std::mt19937 random_;
};

/// Returns the gradient of the structure's energy, without constraint rows.
Eigen::VectorXd Slope(const Structure& s, const Placement& at) {
  Eigen::VectorXd gradient;
  s.Energy(at, gradient, nullptr);
  return gradient;
}

TEST(TangentStiffness, ForcesAreThoseOfTheDescription) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Anything any(seed);
    for (JointDef& joint : any.def_.joints) {
      if (!IsBar(joint)) joint.stiffness = 0;  // the statics would include these forces
    }
    std::erase_if(any.def_.joints, [](const JointDef& joint) { return !IsBar(joint); });
    LoadCaseSpec weight;
    const Structure s(any.def_, weight, false);
    const Eigen::VectorXd slope = Slope(s, s.start);
    const auto left = LeftAtStart(any.def_, StartJointLoads(any.def_));
    for (int b = 0; b < 4; ++b) {
      const LeftLoad& load = left[static_cast<std::size_t>(b)];
      EXPECT_LT((slope.segment<3>(6 * b) + analysis::Of(load.force_n)).norm(), 1e-10);
      EXPECT_LT((slope.segment<3>(6 * b + 3) + analysis::Of(load.torque_n_m)).norm(), 1e-10);
    }
  }
}

TEST(TangentStiffness, ForcesAreTheSlopeOfTheEnergy) {
  constexpr double kStep = 1e-5;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Anything any(seed);
    const Structure s(any.def_, any.loads_, false);
    Eigen::VectorXd start(24), unused;
    for (int i = 0; i < 24; ++i) start[i] = any.Any(0.1).x;
    const Placement at = Moved(s.start, start);
    const Eigen::VectorXd slope = Slope(s, at);
    for (int i = 0; i < 24; ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(24, i);
      const double change =
          s.Energy(Moved(at, step), unused, nullptr) - s.Energy(Moved(at, -step), unused, nullptr);
      EXPECT_NEAR(slope[i], change / (2 * kStep), 1e-6 * (1 + slope.norm())) << seed << " " << i;
    }
  }
}

// With rotations as exp(theta), the change of a body's torque contains half the torque itself:
// d(slope_a) / d(theta_b) = H_ab + slope . (a x b) / 2, from the product of two rotations.
TEST(TangentStiffness, IsTheDerivativeOfTheForces) {
  constexpr double kStep = 1e-5;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Anything any(seed);
    const Structure s(any.def_, any.loads_, false);
    Eigen::VectorXd start(24), slope;
    for (int i = 0; i < 24; ++i) start[i] = any.Any(0.1).x;
    const Placement at = Moved(s.start, start);
    Eigen::MatrixXd hessian, difference(24, 24);
    s.Energy(at, slope, &hessian);
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-9 * hessian.norm());
    for (int i = 0; i < 24; ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(24, i);
      difference.col(i) = (Slope(s, Moved(at, step)) - Slope(s, Moved(at, -step))) / (2 * kStep);
    }
    for (int b = 0; b < 4; ++b) {
      const Vec3 torque = analysis::To(slope.segment<3>(6 * b + 3));
      difference.block<3, 3>(6 * b + 3, 6 * b + 3) += 0.5 * analysis::CrossMatrix(torque);
    }
    const double size = hessian.cwiseAbs().maxCoeff();
    EXPECT_LT((hessian - difference).cwiseAbs().maxCoeff(), 1e-7 * size) << seed;
  }
}

TEST(TangentStiffness, SlackCablesAreNamedAndContributeNothing) {
  Anything any(1);
  const Tangent with = FindTangent(any.def_, any.loads_);
  ASSERT_EQ(with.slack_cables, std::vector<int>{9});
  any.def_.cables.erase(any.def_.cables.begin() + 9);
  const Tangent without = FindTangent(any.def_, any.loads_);
  EXPECT_EQ(with.stiffness.values, without.stiffness.values);
}

TEST(TangentStiffness, HeldRowsAreTheWrenchesOfTheirJoint) {
  Anything any(7);
  for (const JointKind kind : {JointKind::kBall, JointKind::kHinge, JointKind::kWeld,
                               JointKind::kPrismatic, JointKind::kCylindrical, JointKind::kPlanar,
                               JointKind::kLine, JointKind::kPlane, JointKind::kDistance}) {
    ModelDef def = any.def_;
    def.joints.clear();
    const Vec3 from = any.Any(1), axis = any.Unit();
    // Displaced along free directions, so that lever arms differ.
    Vec3 to = from;
    if (!ConstrainedMotions(kind).along) to = to + 0.3 * axis;
    if (kind == JointKind::kPlane || kind == JointKind::kPlanar) {
      const Vec3 across = Cross(axis, any.Any(1));
      to = from + across;
    }
    AddJoint(def, kind, 0, from, 1, to, axis);
    const LoadCaseSpec none;
    const Structure s(def, none, false);
    for (std::size_t r = 0; r < s.rows.size(); ++r) {
      const analysis::Coordinate c = s.RowAt(r, s.start);
      const Wrench unit = UnitOf(def.joints[0], s.rows[r].row);
      EXPECT_NEAR(c.value, 0, 1e-14);
      for (int b = 0; b < 2; ++b) {
        const double sign = b == 1 ? 1 : -1;
        const Vec3 arm = to - def.bodies[static_cast<std::size_t>(b)].com_m;
        const Vec3 torque = sign * (unit.torque + Cross(arm, unit.force));
        EXPECT_LT((c.gradient.segment<3>(6 * b) - sign * analysis::Of(unit.force)).norm(), 1e-14);
        EXPECT_LT((c.gradient.segment<3>(6 * b + 3) - analysis::Of(torque)).norm(), 1e-13)
            << static_cast<int>(kind) << " " << r;
      }
    }
  }
}

// Second derivatives of constraint rows, by differences of the first derivatives.
TEST(TangentStiffness, HeldRowsCurveAsTheirSlopesChange) {
  constexpr double kStep = 1e-5;
  Anything any(3);
  AddJoint(any.def_, JointKind::kWeld, 0, any.Any(1), 1, any.Any(1), any.Unit());
  AddJoint(any.def_, JointKind::kPlanar, 2, any.Any(1), 3, any.Any(1), any.Unit());
  AddJoint(any.def_, JointKind::kDistance, 2, any.Any(1), 3, any.Any(1));
  const Structure s(any.def_, any.loads_, false);
  Eigen::VectorXd start(24);
  for (int i = 0; i < 24; ++i) start[i] = any.Any(0.1).x;
  const Placement at = Moved(s.start, start);
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    const auto full = [&](const Placement& where, Eigen::MatrixXd* hessian) {
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(24);
      Add(s.RowAt(r, where), 1, 0, gradient, hessian);
      return gradient;
    };
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(24, 24), difference(24, 24);
    const Eigen::VectorXd slope = full(at, &hessian);
    for (int i = 0; i < 24; ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(24, i);
      difference.col(i) =
          (full(Moved(at, step), nullptr) - full(Moved(at, -step), nullptr)) / (2 * kStep);
    }
    for (int b = 0; b < 4; ++b) {
      const Vec3 torque = analysis::To(slope.segment<3>(6 * b + 3));
      difference.block<3, 3>(6 * b + 3, 6 * b + 3) += 0.5 * analysis::CrossMatrix(torque);
    }
    EXPECT_LT((hessian - difference).cwiseAbs().maxCoeff(), 1e-8) << r;
  }
}

}  // namespace
}  // namespace taut::test
