// Ball joints (ball_joint.h) as an example of a new kind of constraint: they satisfy the tests of
// laws, swing like rods, and carry loads together with contacts and cables.
#include "tests/solver/ball_joint.h"

#include <gtest/gtest.h>

namespace taut::test {
namespace {

constexpr double kMass = 0.5, kLength = 0.4, kGravity = 9.81, kStep_s = 1e-3;
const Vec3 kKick = {0, 0, -kStep_s* kGravity};
using JointIsland = OwnIsland<Joint, Contact2, Cable>;

/// Returns the inverse inertia of a thin rod in the plane of x and z, with next to no inertia about
/// its axis.
Inertia InverseInertia(const Vec3& a) {
  const double across = 12 / (kMass * kLength * kLength), more = 1e3 * across;
  const double xz = more * a.x * a.z;
  return {{{across + more * a.x * a.x, 0, xz}, {0, across, 0}, {xz, 0, across + more * a.z * a.z}}};
}

TEST(BallJointLaw, IsALaw) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    math::Random random(18, 0, i);
    const auto vector = [&] { return Vec3{random.Normal(), random.Normal(), random.Normal()}; };
    JointIsland island;
    for (int b = 0; b < 2; ++b) island.AddBody(1, {{{1, 0.2, 0}, {0.2, 2, 0}, {0, 0, 3}}}, {}, {});
    const Joint& j = AddJoint(island, 0, vector(), i % 2 ? 1 : -1, vector(), vector());
    const Rows<3> rest = {-j.bias[0][0], -j.bias[1][0], -j.bias[2][0]};
    const Rows<3> u = RandomRows<3>(random), v = RandomRows<3>(random), l = RandomRows<3>(random);
    ExpectSolution(j, rest, l);
    ExpectNoSolution(j, {rest[0], rest[1] + 0.1, rest[2]}, l);
    ExpectResidualIsNewtons(j, u, l);
    for (const double e : {1.0, 1e-2}) {
      EXPECT_TRUE(CheckDerivative(j, u, l, e) && CheckLinearize(j, u, l, e));
      ExpectFrozenPushesBack(j, u, v, l, l, e);
    }
    const auto [after, with] = SolvedAlone(j, u, l);
    EXPECT_LT(Violation(j, after, with), 1e-13 * (1 + Largest(with)));
    EXPECT_EQ(Clamped(j, l), l);
  }
}

struct Rod {
  Vec3 p, v, w;
  double angle;  ///< Rotation about y, from hanging down.
  Vec3 Axis() const { return {-std::sin(angle), 0, -std::cos(angle)}; }
  Vec3 End(double sign) const { return (sign * kLength / 2) * Axis(); }  ///< -1: the upper end,
  Vec3 Point(double sign) const { return p + End(sign); }                ///< as a position.
};

/// Two rods in a chain below the origin.
struct DoublePendulum {
  Rod rods[2];
  double gap = 0;  ///< Largest gap of the joints [m], and their impulses in the last step.
  std::vector<double> l;
  DoublePendulum(double first, double second) : rods{} {
    rods[0].angle = first, rods[1].angle = second;
    rods[0].p = rods[0].End(1);
    rods[1].p = 2.0 * rods[0].p + rods[1].End(1);
  }
  /// Kick, joints that close their gaps by the step's end, drift; in a plane, so without gyroscopic
  /// terms.
  void Step() {
    JointIsland island;
    for (const Rod& r : rods) island.AddBody(1 / kMass, InverseInertia(r.Axis()), r.v + kKick, r.w);
    const Vec3 gaps[] = {rods[0].Point(-1), rods[1].Point(-1) - rods[0].Point(1)};
    AddJoint(island, 0, rods[0].End(-1), -1, {}, (1 / kStep_s) * gaps[0]);
    AddJoint(island, 1, rods[1].End(-1), 0, rods[0].End(1), (1 / kStep_s) * gaps[1]);
    gap = std::max(std::sqrt(Dot(gaps[0], gaps[0])), std::sqrt(Dot(gaps[1], gaps[1])));
    island.Start();
    sim::SolverWork work{0, 100};
    EXPECT_LT(island.Solve(work), 1e-10);
    EXPECT_LE(work.linear_solves, 3) << "the equations are linear";
    l = island.Impulses();
    for (int i = 0; i < 2; ++i) {
      rods[i].v = island.VelocityOf(i), rods[i].w = island.SpinOf(i);
      rods[i].p = rods[i].p + kStep_s * rods[i].v, rods[i].angle += kStep_s * rods[i].w.y;
    }
  }
};

TEST(BallJoint, HangingAtRestCarriesTheWeightBelow) {
  DoublePendulum chain(0, 0);
  chain.Step();
  const double weight = kStep_s * kMass * kGravity, wanted[] = {0, 0, 2 * weight, 0, 0, weight};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(chain.l[i], wanted[i], 1e-12);
}

TEST(BallJoint, ADoublePendulumSwingsInItsTwoModes) {
  // Rods of equal length: w^2 = (3 -+ 6 / sqrt 7) g / L, the angles as 1 : (3 - 8/3 x) / x with x =
  // w^2 L / g. With kick and drift the motion is cos(n b) - tan(b / 2) sin(n b), cos b = 1 - (w
  // h)^2 / 2.
  const double amplitude = 1e-4;
  for (const double x : {3 - 6 / std::sqrt(7.0), 3 + 6 / std::sqrt(7.0)}) {
    const double ratio = (3 - 8.0 / 3 * x) / x;
    const double wh2 = x * kGravity / kLength * kStep_s * kStep_s, b = std::acos(1 - wh2 / 2);
    double worst = 0;
    DoublePendulum chain(amplitude, ratio * amplitude);
    for (int n = 1; n <= 2000; ++n) {
      chain.Step();
      const double wanted = amplitude * (std::cos(n * b) - std::tan(b / 2) * std::sin(n * b));
      worst = std::max({worst, std::abs(chain.rods[0].angle - wanted),
                        std::abs(chain.rods[1].angle - ratio * wanted)});
    }
    // Larger angles swing slower: the difference is 161 amplitude^3 from 1e-5 to 1e-3.
    EXPECT_LT(worst, 200 * amplitude * amplitude * amplitude);
  }
}

TEST(BallJoint, GapsStayOfSecondOrderInTheStep) {
  // A step closes the gap except for the curvature of the arms' paths: (h w)^2 / 2 of each arm.
  DoublePendulum chain(1.5, 1.5);
  for (int n = 0; n < 2000; ++n) {
    const double w0 = chain.rods[0].w.y, w1 = chain.rods[1].w.y;
    chain.Step();
    EXPECT_LE(chain.gap, kStep_s * kStep_s / 4 * kLength * (w0 * w0 + w1 * w1) + 1e-12) << n;
  }
  EXPECT_GT(std::abs(chain.rods[0].w.y), 0.1) << "it still swings";
}

TEST(BallJoint, TwoRodsLeanOnEachOtherHeldByFrictionOrByACable) {
  // Each rod pushes its foot outwards by half its weight times the tangent of its angle.
  const double angle = 0.5, weight = kStep_s * kMass * kGravity,
               push = weight / 2 * std::tan(angle);
  for (const bool friction : {true, false}) {
    JointIsland island;
    const Rod rods[2] = {{{}, {}, {}, angle}, {{}, {}, {}, -angle}};
    for (const Rod& r : rods) island.AddBody(1 / kMass, InverseInertia(r.Axis()), kKick, {});
    AddJoint(island, 0, rods[0].End(-1), 1, rods[1].End(-1), {});
    const Vec3 directions[3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    for (int i = 0; i < 2; ++i) {
      auto& c = island.Add<Contact2>();
      c.live = Num::Splat(1.0), c.mu = Num::Splat(friction ? 0.5 : 0.0), c.link_count = 1;
      for (int r = 0; r < 3; ++r) {
        island.SetRow(c.links[0], r, i, directions[r], Cross(rods[i].End(1), directions[r]));
      }
      c.FinishMasses();
    }
    if (!friction) {
      auto& cable = island.Add<Cable>();
      cable.live = Num::Splat(1.0), cable.SetLine(Num::Splat(push), Num::Splat(2.0));
      cable.upper = Num::Splat(1.0), cable.link_count = 2, cable.links = island.Links(2);
      for (int i = 0; i < 2; ++i) {
        const Vec3 pull = {i == 0 ? 1.0 : -1.0, 0, 0};
        island.SetRow(cable.links[i], 0, i, pull, Cross(rods[i].End(1), pull));
      }
      cable.FinishMasses();
    }
    island.Start();
    sim::SolverWork work{0, 100};
    EXPECT_LT(island.Solve(work), 1e-10);
    for (int i = 0; i < 2; ++i) {
      const Vec3 v = island.VelocityOf(i), w = island.SpinOf(i);
      EXPECT_LT(Dot(v, v) + Dot(w, w), 1e-18) << "at rest";
    }
    const double f = friction ? push : 0;
    const double wanted[] = {-push, 0, 0, weight, f, 0, weight, -f, 0, push};
    const std::vector<double> l = island.Impulses();
    for (std::size_t i = 0; i < l.size(); ++i) EXPECT_NEAR(l[i], wanted[i], 1e-11) << i;
  }
}

}  // namespace
}  // namespace taut::test
