// Derivatives of an island's solution: against differences of whole solves, and forward against
// reverse mode.
#include <gtest/gtest.h>

#include <map>

#include "tests/solver/machine.h"

namespace taut::test {
namespace {

using List = std::vector<Num>;

/// A change of an island's inputs, the resulting change of its solution, or a gradient.
struct Change {
  List v, rows;  ///< 6 per unknown; 1 per row.
};

/// Returns random numbers, with zeros where an unknown has no velocities.
template <class P>
Change RandomChange(const sim::Island<Num, P>& island, math::Random& random) {
  Change out;
  for (int k = 0; k < island.body_count; ++k) {
    for (int i = 0; i < 6; ++i) {
      out.v.push_back(Num::Splat(i < island.bodies[k].size ? random.Normal() : 0.0));
    }
  }
  for (int i = 0; i < island.rows; ++i) out.rows.push_back(Num::Splat(random.Normal()));
  return out;
}

double Product(const Change& a, const Change& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.v.size(); ++i) sum += a.v[i][0] * b.v[i][0];
  for (std::size_t i = 0; i < a.rows.size(); ++i) sum += a.rows[i][0] * b.rows[i][0];
  return sum;
}
double Size(const Change& a) { return std::sqrt(Product(a, a)); }

/// Checks x . (T y) = (T^T x) . y.
template <class P>
void ExpectAdjoint(sim::Island<Num, P>& island, math::Random& random, const std::string& where) {
  sim::IslandTangent<Num, P> tangent(island);
  ASSERT_TRUE(tangent.Factor()) << where;
  const Change y = RandomChange(island, random), x = RandomChange(island, random);
  Change ty = y, tx = x;
  tangent.Apply(y.v.data(), y.rows.data(), ty.v.data(), ty.rows.data());
  tangent.ApplyTransposed(x.v.data(), x.rows.data(), tx.v.data(), tx.rows.data());
  // Terms of stiff and of free motion cancel in the sums. 1e-7 of compliance is 1e7 of stiffness.
  const double most = Size(x) * Size(ty) + Size(tx) * Size(y);
  EXPECT_NEAR(Product(x, ty), Product(tx, y), 1e-9 * most) << where;
  // The matrix alone.
  List forth = y.v, back = x.v;
  tangent.matrix().Solve(forth.data());
  tangent.matrix().SolveTransposed(back.data());
  double left = 0, right = 0, scale = 0;
  for (int i = 0; i < 6 * island.pattern.count; ++i) {
    left += x.v[At(i)][0] * forth[At(i)][0], right += back[At(i)][0] * y.v[At(i)][0];
    scale += std::abs(x.v[At(i)][0] * forth[At(i)][0]);
  }
  EXPECT_NEAR(left, right, 1e-9 * scale) << where;
}

/// Returns true if all laws are on the same branches.
template <class P>
bool SameBranches(const sim::Island<Num, P>& a, const sim::Island<Num, P>& b) {
  std::vector<bool> same;
  const auto compare = [&](auto& law, auto&, int row, int) {
    using Law = sim::LawOf<decltype(law)>;
    // Directions of sliding may rotate with the change.
    const auto was = law.BranchOf(a.m.u + row, a.m.l + row);
    same.push_back(Law::Same(was, law.BranchOf(b.m.u + row, b.m.l + row)));
  };
  a.pools.ForEach(compare);
  return std::find(same.begin(), same.end(), false) == same.end();
}

/// Returns the problem with its free velocities and its rows' right-hand sides changed by `by`
/// times `change`.
ContactProblem Moved(ContactProblem p, const StepIsland& from, const Change& change, double by) {
  const auto& island = from.island;
  for (std::size_t b = 0; b < p.bodies.size(); ++b) {
    const int at = from.PlaceOf(static_cast<int>(b));
    const sim::Unknown<Num>& body = island.bodies[at];
    const Num* const x = change.v.data() + 6 * at;  // a momentum
    p.bodies[b].free_v = p.bodies[b].free_v + by * body.inv_mass[0] * Plain3({x[0], x[1], x[2]});
    const simd::V3<Num> spin = body.inv_inertia * simd::V3<Num>{x[3], x[4], x[5]};
    p.bodies[b].free_w = p.bodies[b].free_w + by * Plain3(spin);
  }
  std::size_t row = 0;
  for (ProblemContact& c : p.contacts) c.bias += by * change.rows[row][0], row += 3;
  for (ProblemCable& c : p.cables) c.base -= by * c.gain * change.rows[row++][0];
  return p;
}

/// Sets the impulses of a solution of the same problem as its start.
void StartFrom(ContactProblem& p, const StepIsland& island) {
  const std::vector<double> l = island.Impulses();
  std::size_t row = 0;
  for (ProblemContact& c : p.contacts) {
    for (double& x : c.impulse) x = l[row++];
  }
  for (ProblemCable& c : p.cables) c.impulse = l[row++];
}

TEST(IslandTangent, IsHowWholeSolvesDiffer) {
  // Differences over 1e-6 of the free velocities, in both directions; solved to 1e-13 m/s.
  std::map<std::string, int> seen, compared;
  for (const ContactProblem& stored : LoadProblems()) {
    if (seen[stored.scene]++ >= 12 || stored.contacts.size() > 80) continue;
    math::Random random(20, 0, static_cast<std::uint64_t>(seen[stored.scene]));
    StepIsland middle = IslandOf(stored);
    sim::SolverWork work{0, 300};
    if (!(middle.Solve(work, 1e-13) <= 1e-12)) continue;
    Change change = RandomChange(middle.island, random), slope = change;
    for (std::size_t i = 0; i < stored.contacts.size(); ++i) {  // tangents have no bias in a file
      change.rows[3 * i + 1] = change.rows[3 * i + 2] = Num::Splat(0.0);
    }
    double momentum = 0, most = 0;
    for (const ProblemBody& b : stored.bodies) momentum += 1 / b.inverse_mass;
    const double by = 1e-6;
    for (Num& x : change.v) x = Num::Splat(0.01 * momentum) * x;
    sim::IslandTangent tangent(middle.island);
    ASSERT_TRUE(tangent.Factor());
    tangent.Apply(change.v.data(), change.rows.data(), slope.v.data(), slope.rows.data());
    bool usable = true;
    List ends[2];
    for (int side = 0; side < 2 && usable; ++side) {
      ContactProblem p = Moved(stored, middle, change, side == 0 ? -by : by);
      StartFrom(p, middle);
      StepIsland end = IslandOf(p);
      sim::SolverWork more{0, 300};
      usable = end.Solve(more, 1e-13) <= 1e-12 && SameBranches(middle.island, end.island);
      ends[side].assign(end.island.m.v.data(), end.island.m.v + change.v.size());
    }
    if (!usable) continue;
    ++compared[stored.scene];
    for (const Num& x : slope.v) most = std::max(most, std::abs(x[0]));
    for (std::size_t i = 0; i < slope.v.size(); ++i) {
      const double wanted = (ends[1][i][0] - ends[0][i][0]) / (2 * by);
      EXPECT_NEAR(slope.v[i][0], wanted, 1e-4 * most + 1e-6) << stored.scene << " " << i;
    }
  }
  int all = 0;
  for (const auto& [scene, count] : compared) all += count;
  EXPECT_GT(all, 80);
}

TEST(IslandTangent, BackwardsIsTheTransposeOfForwards) {
  std::map<std::string, int> seen;
  for (const ContactProblem& stored : LoadProblems()) {
    if (seen[stored.scene]++ >= 6) continue;
    math::Random random(21, 0, static_cast<std::uint64_t>(seen[stored.scene]));
    StepIsland island = IslandOf(stored);
    sim::SolverWork work{0, 100};
    island.Solve(work);
    ExpectAdjoint(island.island, random, stored.scene);
  }
  for (const double friction : {kMu, 5.0}) {
    Machine machine;
    Build(machine, friction);
    math::Random random(22, 0, friction > 1);
    sim::SolverWork work{0, 100};
    EXPECT_LT(machine.island.Solve(work), 1e-10);
    for (int i = 0; i < 20; ++i) ExpectAdjoint(machine.island.island, random, "machine");
  }
}

TEST(IslandTangent, FollowsWhatIsPrescribed) {
  // The belt moves faster or slower, under a foot that sticks or slides.
  const double by = 1e-5;
  for (const double friction : {kMu, 5.0}) {
    Machine middle;
    Build(middle, friction);
    sim::SolverWork work{0, 300};
    EXPECT_LT(middle.island.Solve(work, 1e-13), 1e-12);
    auto& island = middle.island.island;
    Change change{List(At(6 * island.body_count), Num::Splat(0.0)),
                  List(At(island.rows), Num::Splat(0.0))};
    const Vec3 faster = {0.3, 0.7, -0.2};
    const auto at = At(6 * middle.island.PlaceOf(middle.belt));
    change.v[at] = Num::Splat(faster.x), change.v[at + 1] = Num::Splat(faster.y);
    change.v[at + 2] = Num::Splat(faster.z);
    Machine ends[2];
    for (int side = 0; side < 2; ++side) {
      Build(ends[side], friction, kBeltSpeed + (side == 0 ? -by : by) * faster);
      sim::SolverWork more{0, 300};
      EXPECT_LT(ends[side].island.Solve(more, 1e-13), 1e-12);
    }
    const auto& low = ends[0].island.island.m;
    const auto& high = ends[1].island.island.m;
    for (const double compliance : {1e-7, 1e-8}) {
      sim::IslandTangent tangent(island);
      ASSERT_TRUE(tangent.Factor(compliance));
      Change slope = change;
      tangent.Apply(change.v.data(), change.rows.data(), slope.v.data(), slope.rows.data());
      double most = 0;
      for (std::size_t i = 0; i < slope.v.size(); ++i) {
        const double wanted = (high.v[i][0] - low.v[i][0]) / (2 * by);
        EXPECT_NEAR(slope.v[i][0], wanted, 30 * compliance) << i;
        if (i / 6 != at / 6) most = std::max(most, std::abs(slope.v[i][0]));
      }
      EXPECT_GT(most, 0.01) << "the belt drives something";
      for (std::size_t i = 0; i < slope.rows.size(); ++i) {
        const double wanted = (high.l[i][0] - low.l[i][0]) / (2 * by);
        EXPECT_NEAR(slope.rows[i][0], wanted, 30 * compliance) << i;
      }
    }
  }
}

}  // namespace
}  // namespace taut::test
