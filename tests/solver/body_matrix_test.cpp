// Block-sparse matrix over bodies, point masses and rotors: elimination order and fill against
// counting by hand, solutions against a dense matrix and its transpose.
#include <gtest/gtest.h>

#include <set>

#include "tests/solver/dense_solve.h"
#include "tests/solver/island_of.h"

namespace taut::test {
namespace {

using Edges = std::set<std::pair<int, int>>;  ///< Both directions.

Edges RandomEdges(int count, double share, math::Random& random) {
  Edges edges;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < i; ++j) {
      if (random.Uniform() < share) edges.insert({i, j}), edges.insert({j, i});
    }
  }
  return edges;
}

/// Eliminates `node` by connecting all its neighbors, which it returns.
std::set<int> Remove(Edges& edges, int node, int count) {
  std::set<int> neighbours;
  for (int i = 0; i < count; ++i) {
    if (edges.count({node, i})) neighbours.insert(i);
  }
  for (const int i : neighbours) {
    edges.erase({node, i}), edges.erase({i, node});
    for (const int j : neighbours) {
      if (i != j) edges.insert({i, j});
    }
  }
  return neighbours;
}

/// A block pattern with its memory.
struct OwnPattern {
  std::vector<int> slot, below, first_below, order, place;
  sim::BlockPattern pattern{};

  explicit OwnPattern(int count)
      : slot(At(count * count)),
        below(At(count * count)),
        first_below(At(count + 1)),
        order(At(count)),
        place(At(count)) {
    pattern = {slot.data(), below.data(), first_below.data(), count, 0, 0};
  }
  bool Eliminate(const Edges& edges, int capacity) {
    const int count = pattern.count, words = sim::BodyGraph::WordsFor(count);
    std::vector<std::uint64_t> bits(At(count * words), ~std::uint64_t{0});
    sim::BodyGraph graph{bits.data(), count, words};
    graph.Clear();
    for (const auto& [i, j] : edges) graph.Join(i, j);
    for (int i = 0; i < count; ++i) graph.Join(i, i);  // self-edges are ignored
    return sim::Eliminate(graph, capacity, order.data(), place.data(), pattern);
  }
  /// Computes the fill by hand, for any order.
  void Fill(Edges edges, const std::vector<int>& in_order) {
    const int count = pattern.count;
    order = in_order;
    for (int k = 0; k < count; ++k) place[At(order[At(k)])] = k;
    slot.assign(slot.size(), -1);
    int used = 0;
    std::vector<std::pair<int, int>> upper;
    for (int k = 0; k < count; ++k) {
      first_below[At(k)] = used - k;
      slot[At(k * count + k)] = used++;
      std::set<int> rows;
      for (const int i : Remove(edges, order[At(k)], count)) rows.insert(place[At(i)]);
      for (const int i : rows) {
        below[At(used - k - 1)] = i;
        slot[At(i * count + k)] = used++;
        upper.push_back({k, i});
      }
    }
    first_below[At(count)] = used - count;
    pattern.lower_count = used;
    for (const auto& [k, i] : upper) slot[At(k * count + i)] = used++;
    pattern.block_count = used;
  }
};

/// Compares the numbers of all blocks.
void ExpectFound(const sim::BlockPattern& found, const OwnPattern& wanted) {
  for (int i = 0; i < found.count; ++i) {
    for (int j = 0; j < found.count; ++j) {
      const int slot = wanted.slot[At(i * found.count + j)];
      if (slot < 0) continue;
      EXPECT_EQ(found.Find(i, j), slot) << i << ' ' << j;
    }
  }
}

TEST(Elimination, TakesTheLowestOfLeastDegreeAndFillsWhatItMust) {
  for (std::uint64_t index = 0; index < 200; ++index) {
    math::Random random(15, 0, index);
    const int count = index % 10 == 9 ? 130 : 1 + static_cast<int>(random.Uniform(0, 20));
    const Edges edges = RandomEdges(count, random.Uniform(0, count > 100 ? 0.03 : 0.5), random);
    Edges left = edges;
    std::vector<int> order;
    std::set<int> nodes;
    for (int i = 0; i < count; ++i) nodes.insert(i);
    while (!nodes.empty()) {
      const auto degree = [&](int i) {
        return std::count_if(nodes.begin(), nodes.end(), [&](int j) {
          return left.count({i, j}) > 0;
        });
      };
      const int best = *std::min_element(nodes.begin(), nodes.end(),
                                         [&](int a, int b) { return degree(a) < degree(b); });
      order.push_back(best);
      nodes.erase(best);
      Remove(left, best, count);
    }
    OwnPattern wanted(count), found(count);
    wanted.Fill(edges, order);
    const int blocks = wanted.pattern.block_count;
    ASSERT_TRUE(found.Eliminate(edges, blocks)) << index;
    EXPECT_EQ(found.order, order) << index;
    EXPECT_EQ(found.place, wanted.place) << index;
    EXPECT_EQ(found.pattern.lower_count, wanted.pattern.lower_count);
    EXPECT_EQ(found.pattern.block_count, blocks);
    EXPECT_EQ(found.first_below, wanted.first_below);
    const auto used = [](const OwnPattern& p) {
      return std::vector<int>(p.below.begin(), p.below.begin() + p.first_below.back());
    };
    EXPECT_EQ(used(found), used(wanted));
    if (count <= sim::BlockPattern::kMostInTable) {
      EXPECT_EQ(found.slot, wanted.slot) << index;
    }
    ExpectFound(found.pattern, wanted);
    EXPECT_FALSE(OwnPattern(count).Eliminate(edges, blocks - 1)) << "no room";
  }
}

TEST(Elimination, NumbersOfLargePatternsAreSearchedFor) {
  // A grid of bodies, too many for a table.
  constexpr int kSide = 14, kCount = kSide * kSide;
  static_assert(kCount > sim::BlockPattern::kMostInTable);
  Edges edges;
  const auto join = [&](int i, int j) { edges.insert({i, j}), edges.insert({j, i}); };
  for (int i = 0; i < kCount; ++i) {
    if (i % kSide != 0) join(i, i - 1);
    if (i >= kSide) join(i, i - kSide);
  }
  OwnPattern wanted(kCount), found(kCount);
  found.slot.clear(), found.pattern.slot = nullptr;
  ASSERT_TRUE(found.Eliminate(edges, kCount * kCount));
  wanted.Fill(edges, found.order);
  ExpectFound(found.pattern, wanted);
}

/// The parts of a law that the matrix needs: rows on up to three bodies.
struct ThreeLinks {
  static constexpr int kRows = 3;
  int link_count;
  sim::Link<Num, 3> links[3];
  Num g[9];
};

struct System {
  std::vector<sim::Unknown<Num>> bodies;
  std::vector<ThreeLinks> laws;
  Edges edges;
  Dense dense;
  std::vector<double> rhs;
};

/// Returns M + sum of J^T G J, with G positive definite, or nonsymmetric but nearly so. `mixed`:
/// some unknowns have 3 velocities or 1; for the missing ones the dense matrix has a one on its
/// diagonal.
System RandomSystem(int count, bool symmetric, math::Random& random, bool mixed = false) {
  System s;
  const std::size_t n = At(6 * count);
  s.dense.assign(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) s.rhs.push_back(random.Uniform(-1, 1));
  for (int b = 0; b < count; ++b) {
    sim::Unknown<Num> body{};
    const double mass = random.Uniform(0.5, 2), off = random.Uniform(-0.2, 0.2);
    const Inertia inertia = {{{1, off, 0.1}, {off, 1.5, -0.2}, {0.1, -0.2, 2}}};
    body.mass = Num::Splat(mass);
    body.inertia = WideInertia(inertia);
    const int sizes[] = {6, 3, 1};
    body.size = mixed ? sizes[random.Bits() % 3] : 6;
    s.bodies.push_back(body);
    for (std::size_t i = 0; i < 3; ++i) {
      s.dense[At(6 * b) + i][At(6 * b) + i] = mass;
      for (std::size_t j = 0; j < 3; ++j)
        s.dense[At(6 * b) + 3 + i][At(6 * b) + 3 + j] = inertia[i][j];
    }
    for (std::size_t i = At(6 * b + body.size); i < At(6 * b + 6); ++i) {
      s.rhs[i] = 0;
      s.dense[i].assign(n, 0);
      for (auto& row : s.dense) row[i] = 0;
      s.dense[i][i] = 1;
    }
  }
  const auto pick = [&] { return static_cast<int>(random.Uniform() * count); };
  for (int c = 0; c < 2 * count; ++c) {
    ThreeLinks law{};
    std::set<int> on = {pick(), pick(), c % 3 == 0 ? pick() : 0};
    law.link_count = static_cast<int>(on.size());
    double j[3][3][6], root[9], g[9];
    int k = 0;
    for (const int body : on) {
      law.links[k].body = body;
      for (auto& row : j[k]) {
        for (double& x : row) x = random.Uniform(-1, 1);
        for (int i = s.bodies[At(body)].size; i < 6; ++i) row[i] = 0;
      }
      for (int r = 0; r < 3; ++r) {
        const double* const x = j[k][r];
        law.links[k].lin[r] = Wide3({x[0], x[1], x[2]});
        law.links[k].ang[r] = Wide3({x[3], x[4], x[5]});
      }
      for (const int other : on) {
        if (other != body) s.edges.insert({body, other});
      }
      ++k;
    }
    for (double& x : root) x = random.Uniform(-2, 2);
    for (int x = 0; x < 3; ++x) {
      for (int y = 0; y < 3; ++y) {
        g[3 * x + y] = root[3 * x] * root[3 * y] + root[3 * x + 1] * root[3 * y + 1] +
                       root[3 * x + 2] * root[3 * y + 2];
        if (!symmetric && x > y) g[3 * x + y] += 0.3;
      }
    }
    for (std::size_t i = 0; i < 9; ++i) law.g[i] = Num::Splat(g[i]);
    for (int a = 0; a < law.link_count; ++a) {
      for (int b = 0; b < law.link_count; ++b) {
        for (int x = 0; x < 36; ++x) {
          double sum = 0;
          for (int r = 0; r < 9; ++r) sum += j[a][r / 3][x / 6] * g[r] * j[b][r % 3][x % 6];
          s.dense[At(6 * law.links[a].body + x / 6)][At(6 * law.links[b].body + x % 6)] += sum;
        }
      }
    }
    s.laws.push_back(law);
  }
  return s;
}

/// Returns the system's solution by blocks, with the bodies in the order of the pattern.
std::vector<double> BlockSolve(const System& s, const OwnPattern& own, bool symmetric,
                               bool transposed = false) {
  const int count = own.pattern.count;
  std::vector<sim::Unknown<Num>> bodies(At(count));
  std::vector<Num> x(At(6 * count)), blocks(At(36 * own.pattern.block_count));
  for (int b = 0; b < count; ++b) {
    const int at = own.place[At(b)];
    bodies[At(at)] = s.bodies[At(b)];
    for (int i = 0; i < 6; ++i) x[At(6 * at + i)] = Num::Splat(s.rhs[At(6 * b + i)]);
  }
  sim::BodyMatrix<Num> matrix(own.pattern, blocks.data());
  matrix.Start(bodies.data(), symmetric);
  for (ThreeLinks law : s.laws) {
    for (int i = 0; i < law.link_count; ++i) law.links[i].body = own.place[At(law.links[i].body)];
    matrix.Add(law, law.g);
  }
  EXPECT_TRUE(matrix.Factor());
  if (transposed) {
    matrix.SolveTransposed(x.data());
  } else {
    matrix.Solve(x.data());
  }
  std::vector<double> out;
  for (int b = 0; b < count; ++b) {
    for (int i = 0; i < 6; ++i) out.push_back(x[At(6 * own.place[At(b)] + i)][0]);
  }
  return out;
}

TEST(BodyMatrix, SolvesAsADenseMatrixDoesInAnyOrder) {
  int fill = 0;
  for (std::uint64_t index = 0; index < 200; ++index) {
    for (const bool symmetric : {true, false}) {
      math::Random random(16, symmetric, index);
      const int count = 1 + static_cast<int>(random.Uniform(0, 12));
      const System s = RandomSystem(count, symmetric, random);
      const std::vector<double> wanted = DenseSolve(s.dense, s.rhs);
      std::vector<int> order;
      for (int i = 0; i < count; ++i) order.push_back(i);
      for (int trial = 0; trial < 4; ++trial) {
        OwnPattern own(count);
        if (trial == 0) {
          ASSERT_TRUE(own.Eliminate(s.edges, count * count));
        } else {  // forward, backward, random
          if (trial == 2) std::reverse(order.begin(), order.end());
          for (std::size_t i = order.size(); trial == 3 && i-- > 1;) {
            std::swap(order[i], order[random.Bits() % (i + 1)]);
          }
          own.Fill(s.edges, order);
        }
        fill += own.pattern.block_count - count - static_cast<int>(s.edges.size());
        const std::vector<double> found = BlockSolve(s, own, symmetric);
        for (std::size_t i = 0; i < found.size(); ++i) {
          EXPECT_NEAR(found[i], wanted[i], 1e-11) << index << ", row " << i << ", order " << trial;
        }
      }
    }
  }
  EXPECT_GT(fill, 1000) << "without fill-in this test sees little";
}

TEST(BodyMatrix, SolvesSmallerUnknownsAndItsTransposeAsADenseMatrixDoes) {
  double askew = 0;
  for (std::uint64_t index = 0; index < 300; ++index) {
    const bool symmetric = index % 3 == 0, mixed = index % 2 == 0;
    math::Random random(19, 0, index);
    const int count = 1 + static_cast<int>(random.Uniform(0, 12));
    const System s = RandomSystem(count, symmetric, random, mixed);
    OwnPattern own(count);
    ASSERT_TRUE(own.Eliminate(s.edges, count * count));
    const std::vector<double> straight = DenseSolve(s.dense, s.rhs);
    const std::vector<double> across = DenseSolve(Transposed(s.dense), s.rhs);
    for (const bool transposed : {false, true}) {
      const std::vector<double> found = BlockSolve(s, own, symmetric, transposed);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], (transposed ? across : straight)[i], 1e-11) << index << ", row " << i;
        askew = std::max(askew, std::abs(straight[i] - across[i]));
      }
    }
  }
  EXPECT_GT(askew, 0.01) << "without a difference this test sees little";
}

TEST(BodyMatrix, RefusesWhatItCannotFactor) {
  math::Random random(17, 0, 0);
  System s = RandomSystem(1, true, random);
  OwnPattern own(1);
  ASSERT_TRUE(own.Eliminate(s.edges, 1));
  std::vector<Num> blocks(36);
  sim::BodyMatrix<Num> matrix(own.pattern, blocks.data());
  matrix.Start(s.bodies.data(), true);
  EXPECT_TRUE(matrix.Factor());
  s.bodies[0].mass = Num::Splat(-1.0);
  matrix.Start(s.bodies.data(), true);
  EXPECT_FALSE(matrix.Factor()) << "not positive definite";
  matrix.Start(s.bodies.data(), false);
  EXPECT_TRUE(matrix.Factor()) << "a general matrix may be";
  s.bodies[0].mass = Num::Splat(0.0);
  matrix.Start(s.bodies.data(), false);
  EXPECT_FALSE(matrix.Factor()) << "singular";
}

}  // namespace
}  // namespace taut::test
