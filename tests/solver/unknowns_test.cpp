// Islands with unknowns other than bodies: a rotor that winds a cable, a point mass, and a
// prescribed body, connected by a ball joint, a cable and a contact. Where no law changes its
// branch the equations are linear, and a dense matrix of all of them is the reference.
#include <gtest/gtest.h>

#include "tests/solver/dense_solve.h"
#include "tests/solver/machine.h"

namespace taut::test {
namespace {

/// All equations in one matrix: M v - J^T l = M v_free, J v + C l = r, for the columns that are not
/// prescribed. `C`: compliance and other relations between a row's impulses.
struct ReferenceEquations {
  Dense a;
  std::vector<double> b;
  std::vector<int> first;  ///< Column of each unknown by its place, or -1.
};

ReferenceEquations Equations(const Machine& machine, bool slides, const double (&s)[2]) {
  ReferenceEquations out;
  const auto& island = machine.island.island;
  int columns = 0;
  for (int k = 0; k < island.body_count; ++k) {
    const bool given = k >= island.pattern.count;
    out.first.push_back(given ? -1 : columns);
    columns += given ? 0 : island.bodies[k].size;
  }
  const std::size_t n = At(columns + island.rows);
  out.a.assign(n, std::vector<double>(n)), out.b.assign(n, 0);
  for (int k = 0; k < island.pattern.count; ++k) {
    const sim::Unknown<Num>& body = island.bodies[k];
    Num free[6], unit[6], column[6];
    island.Store(body.free, free);
    for (int i = 0; i < body.size; ++i) {
      for (int j = 0; j < 6; ++j) unit[j] = Num::Splat(i == j);
      island.TimesMass(body, unit, column);
      for (int j = 0; j < body.size; ++j) {
        out.a[At(out.first[At(k)] + j)][At(out.first[At(k)] + i)] = column[j][0];
        out.b[At(out.first[At(k)] + j)] += column[j][0] * free[i][0];
      }
    }
  }
  island.pools.ForEach([&](auto& law, auto&, int row, int) {
    for (int i = 0; i < law.link_count; ++i) {
      const auto& link = law.links[i];
      Num free[6];
      island.Store(island.bodies[link.body].free, free);
      for (int r = 0; r < sim::LawOf<decltype(law)>::kRows; ++r) {
        const std::size_t at = At(columns + row + r);
        const Num j[6] = {link.lin[r].x, link.lin[r].y, link.lin[r].z,
                          link.ang[r].x, link.ang[r].y, link.ang[r].z};
        for (int c = 0; c < island.bodies[link.body].size; ++c) {
          const int column = out.first[At(link.body)];
          if (column < 0) {
            out.b[at] -= j[c][0] * free[c][0];  // known: right-hand side
          } else {
            out.a[at][At(column + c)] += j[c][0];
            out.a[At(column + c)][at] -= j[c][0];
          }
        }
      }
    }
  });
  // Joint: u = -bias. Contact: the same, or friction mu ln s. Cable: l + gain u = base.
  const std::size_t joint = At(columns), foot = joint + 3, cable = joint + 6;
  out.b[joint] -= 0.01;
  out.b[foot] -= 0.03;
  for (std::size_t r = 1; slides && r < 3; ++r) {
    out.a[foot + r].assign(n, 0), out.b[foot + r] = 0;
    out.a[foot + r][foot + r] = 1, out.a[foot + r][foot] = -kMu * s[r - 1];
  }
  for (double& x : out.a[cable]) x *= kGain;
  out.a[cable][cable] += 1, out.b[cable] = kGain * out.b[cable] + kBase;
  return out;
}

TEST(Unknowns, ARotorAPointMassAndADrivenBeltMoveAsADenseMatrixSays) {
  for (const bool slides : {false, true}) {
    Machine machine;
    Build(machine, slides ? kMu : 5.0);
    sim::SolverWork work{0, 200};
    EXPECT_LT(machine.island.Solve(work), 1e-10);
    EXPECT_LE(work.linear_solves, 6) << "later stages get there with a wrong matrix, too";
    const auto& island = machine.island.island;
    const std::vector<double> l = machine.island.Impulses();
    const double across = std::hypot(l[4], l[5]);
    const double s[2] = {l[4] / across, l[5] / across};
    const ReferenceEquations wanted = Equations(machine, slides, s);
    const std::vector<double> x = DenseSolve(wanted.a, wanted.b);
    for (int k = 0; k < island.body_count; ++k) {
      Num free[6];
      island.Store(island.bodies[k].free, free);
      const int first = wanted.first[At(k)];
      for (int i = 0; i < 6; ++i) {
        const bool solved = first >= 0 && i < island.bodies[k].size;
        const double v = solved ? x[At(first + i)] : free[i][0];
        EXPECT_NEAR(island.m.v[6 * k + i][0], v, solved ? 1e-9 : 0.0) << k << " " << i;
      }
    }
    for (std::size_t r = 0; r < l.size(); ++r) {
      EXPECT_NEAR(l[r], x[x.size() - l.size() + r], 1e-9) << "row " << r;
    }
    // The solution is on the branches that the equations assume.
    EXPECT_GT(l[3], 0.01);
    EXPECT_TRUE(l[6] > 0.001 && l[6] < 0.999) << l[6];
    if (!slides) {
      EXPECT_LT(across, 4.9 * l[3]);
      continue;
    }
    const double u[2] = {island.m.u[4][0], island.m.u[5][0]}, slip = std::hypot(u[0], u[1]);
    EXPECT_GT(slip, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(u[i] / slip, -s[i], 1e-7);
  }
}

TEST(Unknowns, ALockedRotorAndAHeavyOneAreTheSame) {
  // A rotor with a very large inertia keeps its speed, like a prescribed rotor.
  double wound[2];
  for (const bool locked : {false, true}) {
    OwnIsland<Cable> island;
    const int rotor = island.AddRotor(1e9, 7), mass = island.AddPointMass(0.5, {0, 0, -0.1});
    if (locked) island.Prescribe(rotor);
    auto& cable = island.Add<Cable>();
    cable.live = Num::Splat(1.0), cable.SetLine(Num::Splat(0.05), Num::Splat(3.0));
    cable.upper = Num::Splat(10.0), cable.link_count = 2, cable.links = island.Links(2);
    island.SetRow(cable.links[0], 0, rotor, {-kRadius, 0, 0}, {});
    island.SetRow(cable.links[1], 0, mass, {0, 0, 1}, {});
    cable.FinishMasses();
    island.Start();
    sim::SolverWork work{0, 10};
    EXPECT_LT(island.Solve(work), 1e-10);
    EXPECT_NEAR(island.VelocityOf(rotor).x, 7, 1e-9);
    wound[locked] = island.VelocityOf(mass).z;
    // l = base - gain (v - r w),  v = v_free + l / m
    const double l = (0.05 - 3 * (-0.1 - kRadius * 7)) / (1 + 3 / 0.5);
    EXPECT_NEAR(wound[locked], -0.1 + l / 0.5, 1e-9);
  }
  EXPECT_NEAR(wound[0], wound[1], 1e-9);
}

TEST(Unknowns, SweepsLeaveWhatIsPrescribedAlone) {
  Machine machine;
  Build(machine, kMu);
  machine.island.island.Judge();
  const double residual = sim::Sweep(machine.island.island, 2000);
  EXPECT_LT(residual, 1e-8);
  const Vec3 v = machine.island.VelocityOf(machine.belt), w = machine.island.SpinOf(machine.belt);
  EXPECT_TRUE(v.x == kBeltSpeed.x && v.y == kBeltSpeed.y && w.z == kBeltSpin.z);
  Machine other;
  Build(other, kMu);
  sim::SolverWork work{0, 200};
  EXPECT_LT(other.island.Solve(work), 1e-10);
  const std::vector<double> swept = machine.island.Impulses(), solved = other.island.Impulses();
  for (std::size_t i = 0; i < swept.size(); ++i) EXPECT_NEAR(swept[i], solved[i], 1e-7) << i;
}

}  // namespace
}  // namespace taut::test
