/// Island that owns its memory, built from bodies and constraints of any kind or from a stored
/// problem, for tests.
#pragma once

#include <deque>
#include <tuple>
#include <vector>

#include "sim/solve/island_solver.inl"
#include "sim/solve/tangent.inl"
#include "tests/solver/law_checks.h"
#include "tests/solver/problems.h"

namespace taut::test {

inline simd::V3<Num> Wide3(const Vec3& v) {
  return {Num::Splat(v.x), Num::Splat(v.y), Num::Splat(v.z)};
}
inline Vec3 Plain3(const simd::V3<Num>& v) { return {v.x[0], v.y[0], v.z[0]}; }

using Inertia = std::array<std::array<double, 3>, 3>;

inline simd::S3<Num> WideInertia(const Inertia& m) {
  return {Num::Splat(m[0][0]), Num::Splat(m[1][1]), Num::Splat(m[2][2]),
          Num::Splat(m[0][1]), Num::Splat(m[0][2]), Num::Splat(m[1][2])};
}
inline Inertia Inverse(const Inertia& m) {
  Inertia out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      out[j][i] = m[p][r] * m[q][s] - m[p][s] * m[q][r];
    }
  }
  const double det = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
  for (auto& row : out) {
    for (double& x : row) x /= det;
  }
  return out;
}

inline constexpr int kManyBlocks = 1 << 20;

/// Add bodies first, then constraints between them; Start() numbers them for the solver.
template <class... K>
class OwnIsland {
 public:
  using P = sim::Pools<K...>;

  OwnIsland() = default;
  OwnIsland(const OwnIsland&) = delete;  // the island points into its memory
  OwnIsland(OwnIsland&&) = default;

  int AddBody(double inverse_mass, const Inertia& inverse_inertia, const Vec3& free_v,
              const Vec3& free_w) {
    bodies_.push_back({static_cast<int>(bodies_.size()),
                       sim::kDofs,
                       Num::Splat(1 / inverse_mass),
                       Num::Splat(inverse_mass),
                       WideInertia(Inverse(inverse_inertia)),
                       WideInertia(inverse_inertia),
                       {Wide3(free_v), Wide3(free_w)},
                       {Wide3(free_v), Wide3(free_w)}});
    prescribed_.push_back(false);
    return static_cast<int>(bodies_.size()) - 1;
  }
  int AddPointMass(double mass, const Vec3& free_v) { return AddSmall(3, mass, free_v); }
  /// Adds a rotor; the rows of its links hold their lever in lin.x.
  int AddRotor(double inertia, double free_spin) { return AddSmall(1, inertia, {free_spin, 0, 0}); }
  /// Prescribes the body's velocity. Call it before any link to the body is made.
  void Prescribe(int body) {
    sim::Unknown<Num>& b = bodies_[At(body)];
    prescribed_[At(body)] = true;
    b.inv_mass = Num::Splat(0.0), b.inv_inertia = WideInertia({});
  }
  /// Sets one row of a link: the effect of an impulse along `lin` with the lever `ang` on the body.
  template <int R>
  void SetRow(sim::Link<Num, R>& link, int row, int body, const Vec3& lin, const Vec3& ang) {
    const sim::Unknown<Num>& b = bodies_[At(body)];
    link.body = body;
    link.inv_mass = b.inv_mass;
    link.lin[row] = Wide3(lin);
    link.ang[row] = Wide3(ang);
    link.turn[row] = b.inv_inertia * link.ang[row];
  }
  /// Adds a constraint of a kind. The solver starts from its impulses `l`.
  template <class Law>
  Law& Add() {
    return std::get<std::vector<Law>>(laws_).emplace_back();
  }
  /// Returns memory for the links of a kind that does not store them.
  sim::Link<Num, 1>* Links(std::size_t count) { return links_.emplace_back(count).data(); }
  int PlaceOf(int body) const { return place_[At(body)]; }
  /// Returns the velocity of a body by its original number.
  Vec3 VelocityOf(int body) const { return Plain3(TwistOf(body).v); }
  Vec3 SpinOf(int body) const { return Plain3(TwistOf(body).w); }
  std::vector<double> Impulses() const {
    std::vector<double> out;
    for (int i = 0; i < island.rows; ++i) out.push_back(island.m.l[i][0]);
    return out;
  }

  sim::Island<Num, P> island{};

  /// Orders the bodies, allocates memory and starts from the impulses of the laws; call it once.
  /// With more blocks than `block_capacity` there are no matrices.
  void Start(int block_capacity = kManyBlocks) {
    const int n = island.body_count = static_cast<int>(bodies_.size());
    (SetPool<K>(), ...);
    island.rows = island.pools.rows();
    Order(block_capacity);
    std::vector<sim::Unknown<Num>> ordered(bodies_.size());
    for (int b = 0; b < n; ++b) ordered[At(PlaceOf(b))] = bodies_[At(b)];
    bodies_ = ordered;
    island.bodies = {bodies_.data(), n};
    auto& m = island.m;
    numbers_.clear();
    for (sim::Row<Num>* const list : {&m.v, &m.rhs, &m.direction, &m.trial_v}) {
      *list = Take(6 * n);
    }
    for (sim::Row<Num>* const list :
         {&m.l, &m.u, &m.best, &m.center, &m.projected, &m.du, &m.u2, &m.f}) {
      *list = Take(island.rows);
    }
    m.g = Take(island.pools.cells());
    m.blocks = Take(island.has_matrix ? 36 * island.pattern.block_count : 0);
    island.pools.ForEach([&](auto& law, auto&, int row, int) {
      for (int i = 0; i < law.link_count; ++i) law.links[i].body = PlaceOf(law.links[i].body);
      for (int r = 0; r < sim::LawOf<decltype(law)>::kRows; ++r) m.l[row + r] = law.l[r];
    });
  }
  /// Returns the residual that the solver reports [m/s].
  double Solve(sim::SolverWork& work, double tolerance = 1e-10) {
    return sim::SolveIsland(island, sim::Target{tolerance}, work);
  }

 private:
  template <class Law>
  void SetPool() {
    auto& items = std::get<std::vector<Law>>(laws_);
    auto& branches = std::get<std::vector<typename Law::Branch>>(branches_);
    branches.resize(items.size());
    const int count = static_cast<int>(items.size());
    static_cast<sim::Pool<Law>&>(island.pools) = {
        {items.data(), count}, {branches.data(), count}, count};
  }
  int AddSmall(int size, double mass, const Vec3& free_v) {
    const int body = AddBody(1 / mass, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, free_v, {});
    sim::Unknown<Num>& b = bodies_[At(body)];
    b.size = size;
    b.inertia = b.inv_inertia = WideInertia({});
    return body;
  }
  /// Places prescribed bodies behind the others, which the elimination orders.
  void Order(int block_capacity) {
    const int all = island.body_count;
    std::vector<int> number, solved, order;
    for (int b = 0; b < all; ++b) {
      number.push_back(prescribed_[At(b)] ? -1 : static_cast<int>(solved.size()));
      if (!prescribed_[At(b)]) solved.push_back(b);
    }
    const int n = static_cast<int>(solved.size());
    const int words = sim::BodyGraph::WordsFor(n);
    std::vector<std::uint64_t> bits(At(n * words));
    sim::BodyGraph graph{bits.data(), n, words};
    island.pools.ForEach([&](auto& law, auto&, int, int) {
      for (int i = 0; i < law.link_count; ++i) {
        for (int j = 0; j < i; ++j) {
          const int a = number[At(law.links[i].body)], b = number[At(law.links[j].body)];
          if (a >= 0 && b >= 0) graph.Join(a, b);
        }
      }
    });
    order.resize(At(n));
    std::vector<int> place(At(n));
    slot_.resize(At(n * n)), below_.resize(At(n * n));
    first_below_.resize(At(n + 1));
    island.pattern = {slot_.data(), below_.data(), first_below_.data(), 0, 0, 0};
    island.has_matrix =
        sim::Eliminate(graph, block_capacity, order.data(), place.data(), island.pattern);
    int next = n;
    for (int b = 0; b < all; ++b) {
      place_.push_back(number[At(b)] < 0 ? next++ : place[At(number[At(b)])]);
    }
  }
  sim::Row<Num> Take(int count) { return {numbers_.emplace_back(At(count)).data(), count}; }
  sim::Twist<Num> TwistOf(int body) const {
    return island.Load(island.m.v + sim::kDofs * PlaceOf(body));
  }

  std::vector<sim::Unknown<Num>> bodies_;
  std::vector<bool> prescribed_;
  std::tuple<std::vector<K>...> laws_;
  std::tuple<std::vector<typename K::Branch>...> branches_;
  std::deque<std::vector<sim::Link<Num, 1>>> links_;
  std::deque<std::vector<Num>> numbers_;
  std::vector<int> place_, slot_, below_, first_below_;
};

using StepIsland = OwnIsland<Contact2, Cable>;

/// Returns a stored problem as one island.
inline StepIsland IslandOf(const ContactProblem& p, int block_capacity = kManyBlocks) {
  StepIsland out;
  for (const ProblemBody& b : p.bodies) {
    out.AddBody(b.inverse_mass, b.inverse_inertia, b.free_v, b.free_w);
  }
  for (const ProblemContact& from : p.contacts) {
    auto& c = out.Add<Contact2>();
    c.live = Num::Splat(1.0);
    c.mu = Num::Splat(from.mu);
    c.bias[0] = Num::Splat(from.bias);
    c.one_direction = false;
    c.restitution = c.before = Num::Splat(0.0);
    c.link_count = from.b < 0 ? 1 : 2;
    const Vec3 directions[3] = {from.n, from.t1, from.t2};
    for (int r = 0; r < 3; ++r) {
      c.l[r] = Num::Splat(from.impulse[At(r)]);
      out.SetRow(c.links[0], r, from.a, directions[r], from.lever_a[At(r)]);
      if (from.b < 0) continue;
      out.SetRow(c.links[1], r, from.b, -1.0 * directions[r], -1.0 * from.lever_b[At(r)]);
    }
    c.FinishMasses();
  }
  for (const ProblemCable& from : p.cables) {
    auto& c = out.Add<Cable>();
    c.live = Num::Splat(1.0);
    c.SetLine(Num::Splat(from.base), Num::Splat(from.gain));
    c.upper = Num::Splat(from.upper);
    c.l[0] = Num::Splat(from.impulse);
    c.link_count = static_cast<int>(from.links.size());
    c.links = out.Links(from.links.size());
    for (std::size_t i = 0; i < from.links.size(); ++i) {
      out.SetRow(c.links[i], 0, from.links[i].body, from.links[i].pull, from.links[i].lever);
    }
    c.FinishMasses();
  }
  out.Start(block_capacity);
  return out;
}

}  // namespace taut::test
