/// One lane's islands: where lanes have too little in common to walk together (contacts of moving
/// bodies, many contacts, what the solves in lanes did not get). Each island is gathered in the
/// numbers of one lane, solved (island_solver.inl), and written back.

namespace taut::sim {

/// What solving one lane came to.
struct LaneResult {
  double residual = 0, gave_in = 0;
  int linear_solves = 0;
  int body = kWorld;  ///< In the island that is furthest from solved.
};

template <class W>
class LaneSolve {
  using L = simd::Lane<W>;

 public:
  LaneSolve(const View& m, const Rows<W>& s, Scratch<W>& work, const StepSettings& settings,
            int lane, double step_s) noexcept
      : m_(m),
        s_(s),
        work_(work),
        mem_(work.lane),
        settings_(settings),
        lane_(lane),
        h_(L::Splat(step_s)) {}

  /// Solves the lane's islands that have touches, or bodies marked as unsolved. The touches must be
  /// prepared (PrepareTouches).
  LaneResult Solve() noexcept {
    LaneResult result;
    FindIslands([&](int body) { return work_.unsolved[body][lane_] > 0; });
    for (int body = 0; body < m_.body_count; ++body) {
      if (mem_.root[body] != body || !Gather(body)) continue;
      SolverWork work{0, settings_.max_linear_solves};
      double residual = 0;
      if (work_.implicit.any && IsImplicit() && IsFinite()) {
        residual = SolveImplicit(work);
      } else {
        residual = SolveGathered(work);
        Scatter();
      }
      result.linear_solves += work.linear_solves;
      if (work.gave_in > result.gave_in) result.gave_in = work.gave_in;
      if (residual > result.residual || !(residual - residual == 0)) {
        result.residual = residual;
        result.body = body;
      }
    }
    return result;
  }

  /// Takes what is deep out of each other (push_out.inl). Returns how many linear systems it took.
  int PushOut() noexcept;

 private:
  /// Solves the island gathered. What rolls on a body that turns takes rounds (rolling.inl).
  double SolveGathered(SolverWork& work) noexcept {
    constexpr int kMostRounds = 8;
    const Target target{settings_.tolerance_m_per_s};
    if (!FindRolling()) return SolveIsland(mem_.island, target, work);
    ExpectVelocities();
    FollowRolling();
    double residual = SolveIsland(mem_.island, target, work);
    for (int round = 0; round < kMostRounds && work.linear_solves < work.limit; ++round) {
      if (!(FollowRolling() > target.tolerance)) break;
      residual = SolveIsland(mem_.island, target, work);
    }
    KeepRolling();
    return residual;
  }
  bool FindRolling() const noexcept;
  void ExpectVelocities() noexcept;
  double FollowRolling() noexcept;
  void KeepRolling() noexcept;
  RollingSide<L> SideOf(const Contact<L, 2>& c, int k, const Shape& shape) const noexcept;
  bool IsDeep(int body) const noexcept;
  bool IsAlone() const noexcept;
  V3<L> Pending(int body) const noexcept;
  V3<L> Displace(int number) noexcept;
  void KeepMomentum(const V3<L>& gained) noexcept;
  int Body(const ContactPoint<L, 2>& c, int k) const noexcept {
    return mem_.island.bodies[c.links[k].body].body;
  }

  /// By impulses.
  bool Moves(int body) const noexcept {
    return body < m_.body_count && s_.inv_mass[body][lane_] > 0;
  }
  int Root(int body) const noexcept {
    while (mem_.root[body] != body) body = mem_.root[body] = mem_.root[mem_.root[body]];
    return body;
  }
  void Join(int a, int b) noexcept {
    a = Root(a), b = Root(b);
    if (a < b) mem_.root[b] = a;
    if (b < a) mem_.root[a] = b;
  }
  bool IsOn(const StiffCable<W>& cable) const noexcept {
    return !displaces_ && cable.live[lane_] > 0;
  }
  /// Whether the link is one of this lane's: a cable that touches has links to what it touches in
  /// any lane, and what a lane gets must not depend on the others.
  bool IsOn(const StiffCable<W>& cable, int link) const noexcept {
    return m_.cables[cable.cable].touch < 0 || Acts(cable.links[link], lane_);
  }

  /// Whether its cables are integrated implicitly (implicit_groups.inl).
  bool IsImplicit(const StiffCable<W>& cable) const noexcept {
    return work_.implicit.any && work_.implicit.cables[cable.cable][lane_] > 0;
  }
  /// The same of the island that has been gathered.
  bool IsImplicit() const noexcept {
    bool any = false;
    for (int k = 0; k < count_ && !displaces_; ++k) {
      any = any || work_.implicit.bodies[mem_.bodies[k]][lane_] > 0;
    }
    return any;
  }
  /// Whether the island's bodies have finite velocities without its constraints. Others are left as
  /// they are: the world's status says what they are.
  bool IsFinite() const noexcept {
    const L zero = L::Splat(0.0);
    L sum = zero;
    for (int k = 0; k < count_; ++k) {
      const Twist<L>& t = mem_.island.bodies[k].free;
      sum += zero * (t.v.x + t.v.y + t.v.z + t.w.x + t.w.y + t.w.z);
    }
    return sum[0] == 0.0;
  }
  double SolveImplicit(SolverWork& work) noexcept;
  void DisplaceEnd(int body, const V3<L>& dx, const V3<L>& half) noexcept;
  V3<L> PendingOfTouches(int body) const noexcept;

  template <class F>
  void EachChain(const F& f) const noexcept;
  void GatherChains(Pool<CableChain<L>>& pool) noexcept;

  /// root[b]: the lowest body of b's island, for islands with a body that `asks` for it; else -1.
  template <class Asks>
  void FindIslands(const Asks& asks) noexcept {
    for (int b = 0; b < m_.body_count; ++b) mem_.root[b] = b;
    for (int i = 0; i < work_.touch_count[lane_]; ++i) {
      const ContactPoint<L, 2>& c = mem_.pairs[i];
      if (Moves(c.links[1].body)) Join(c.links[0].body, c.links[1].body);
    }
    for (int i = 0; i < work_.stiff_count; ++i) {
      const StiffCable<W>& cable = work_.stiff[i];
      int first = -1;
      for (int k = 0; IsOn(cable) && k < cable.link_count; ++k) {
        const int body = cable.links[k].body;
        if (!Moves(body) || !IsOn(cable, k)) continue;
        if (first >= 0) Join(first, body);
        first = body;
      }
    }
    EachChain([&](int, int a, int b) { Join(a, b); });
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      if (j.a_moves && j.b_moves) Join(j.a, j.b);
    }
    for (int b = 0; b < m_.body_count; ++b) mem_.local[b] = 0;
    for (int b = 0; b < m_.body_count; ++b) {
      if (asks(b)) mem_.local[Root(b)] = 1;
    }
    for (int b = 0; b < m_.body_count; ++b) mem_.root[b] = Root(b);
    for (int b = 0; b < m_.body_count; ++b) {
      if (mem_.local[mem_.root[b]] == 0) mem_.root[b] = -1;
    }
  }

  /// The island of `root` into the memory of the solver. False if nothing acts on it.
  bool Gather(int root) noexcept {
    count_ = 0;
    for (int b = root; b < m_.body_count; ++b) {
      if (mem_.root[b] != root) continue;
      mem_.bodies[count_] = b;
      mem_.local[b] = count_++;
    }
    island_root_ = root;
    Order();
    Island<L, StepPools<L>>& island = mem_.island;
    for (int k = 0; k < count_; ++k) GatherBody(mem_.bodies[mem_.order[k]], island.bodies[k]);
    island.body_count = count_;
    for (int i = 0; i < m_.motion_count; ++i) {  // prescribed
      const int b = m_.motions[i].body, k = island.body_count++;
      mem_.local[b] = mem_.place[k] = k;
      GatherBody(b, island.bodies[k]);
    }
    GatherContacts(island.pools);
    GatherCables(island.pools);
    GatherJoints(island.pools, island.pools);
    GatherChains(island.pools);
    island.rows = island.pools.rows();
    int row = 0;
    Pool<ContactPoint<L, 2>>& contacts = island.pools;
    for (int i = 0; i < contacts.count; ++i) {
      for (int k = 0; k < 3; ++k) island.m.l[row++] = contacts.items[i].l[k];
    }
    Pool<CableRow<L>>& cables = island.pools;
    for (int i = 0; i < cables.count; ++i) island.m.l[row++] = cables.items[i].l[0];
    Pool<JointRow<L>>& joints = island.pools;
    for (int i = 0; i < joints.count; ++i) island.m.l[row++] = joints.items[i].l[0];
    Pool<TurnFriction<L>>& frictions = island.pools;
    for (int i = 0; i < frictions.count; ++i) {
      for (int k = 0; k < 3; ++k) {
        island.m.l[row++] = OfLane<L>(work_.joints[friction_source_[i] + k].l[0], lane_);
      }
    }
    Pool<CableChain<L>>& chains = island.pools;
    for (int i = 0; i < chains.count; ++i) {
      for (int k = 0; k < chains.items[i].rows; ++k) island.m.l[row++] = chains.items[i].spans[k].l;
    }
    return row > 0 || (work_.implicit.any && IsImplicit());
  }

  /// Numbers of elimination: place[local number]. Without room for the blocks the solver has no
  /// linear systems, only sweeps.
  void Order() noexcept {
    BodyGraph& graph = mem_.graph;
    graph.count = count_;
    graph.words = BodyGraph::WordsFor(count_);
    graph.Clear();
    for (int i = 0; i < work_.touch_count[lane_]; ++i) {
      const ContactPoint<L, 2>& c = mem_.pairs[i];
      if (mem_.root[c.links[0].body] != island_root_ || !Moves(c.links[1].body)) continue;
      graph.Join(mem_.local[c.links[0].body], mem_.local[c.links[1].body]);
    }
    for (int i = 0; i < work_.stiff_count; ++i) {
      const StiffCable<W>& cable = work_.stiff[i];
      for (int k = 0; IsOn(cable) && k < cable.link_count; ++k) {
        const int a = cable.links[k].body;
        if (!Moves(a) || mem_.root[a] != island_root_ || !IsOn(cable, k)) continue;
        for (int j = 0; j < k; ++j) {
          const int b = cable.links[j].body;
          if (Moves(b) && IsOn(cable, j)) graph.Join(mem_.local[a], mem_.local[b]);
        }
      }
    }
    EachChain([&](int, int a, int b) {
      if (mem_.root[a] == island_root_) graph.Join(mem_.local[a], mem_.local[b]);
    });
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      if (!j.a_moves || !j.b_moves || mem_.root[j.a] != island_root_) continue;
      graph.Join(mem_.local[j.a], mem_.local[j.b]);
    }
    mem_.island.has_matrix =
        Eliminate(graph, mem_.block_capacity, mem_.order, mem_.place, mem_.island.pattern);
  }
  int Number(int body) const noexcept { return mem_.place[mem_.local[body]]; }

  void GatherBody(int body, Unknown<L>& out) const noexcept {
    const BodyWork<W>& b = work_.bodies[body];
    out.body = body;
    out.size = kDofs;
    out.mass = OfLane<L>(s_.mass[body], lane_);
    out.inv_mass = OfLane<L>(s_.inv_mass[body], lane_);
    out.inv_inertia = OfLane<L>(b.inv_inertia, lane_);
    const M3<L> R{OfLane<L>(b.R.r0, lane_), OfLane<L>(b.R.r1, lane_), OfLane<L>(b.R.r2, lane_)};
    out.inertia = Congruence(R, OfLane<L>(s_.inertia[body], lane_));
    const V3<L> none{L::Splat(0.0), L::Splat(0.0), L::Splat(0.0)};
    out.free = {OfLane<L>(b.v, lane_), OfLane<L>(b.w, lane_)};
    if (displaces_) out.free = {none, none};
    out.before = {OfLane<L>(b.v0, lane_), OfLane<L>(b.w0, lane_)};
  }

  /// `first`: of the rows of `to`.
  template <int R, int S>
  void GatherLink(const Link<W, R>& from, Link<L, S>& to, int first = 0) const noexcept {
    to.body = Number(from.body);
    to.inv_mass = OfLane<L>(from.inv_mass, lane_);
    for (int r = 0; r < R; ++r) {
      to.lin[first + r] = OfLane<L>(from.lin[r], lane_);
      to.ang[first + r] = OfLane<L>(from.ang[r], lane_);
      to.turn[first + r] = OfLane<L>(from.turn[r], lane_);
    }
  }

  /// As the lanes have worked them out, all together (prepare_contact.inl).
  void GatherMasses(const Contact<W, 1>& from, ContactPoint<L, 2>& to) const noexcept {
    to.wnn = OfLane<L>(from.wnn, lane_), to.wt = OfLane<L>(from.wt, lane_);
    to.inv_wnn = OfLane<L>(from.inv_wnn, lane_), to.inv_wt = OfLane<L>(from.inv_wt, lane_);
    to.w1n = OfLane<L>(from.w1n, lane_), to.w2n = OfLane<L>(from.w2n, lane_);
    to.w11 = OfLane<L>(from.w11, lane_), to.w12 = OfLane<L>(from.w12, lane_);
    to.w22 = OfLane<L>(from.w22, lane_);
  }

  void GatherContacts(Pool<ContactPoint<L, 2>>& pool) noexcept {
    pool.count = 0;
    for (int i = 0; i < count_; ++i) {
      const int body = mem_.bodies[i];
      for (int k = 0; k < work_.contact_count[body]; ++k) {
        const int slot = m_.first_slot[body] + k;
        const Contact<W, 1>& from = work_.contacts[slot];
        if (!(from.live[lane_] > 0)) continue;
        ContactPoint<L, 2>& to = pool.items[pool.count];
        mem_.source[pool.count++] = slot;
        to.live = OfLane<L>(from.live, lane_);
        to.mu = OfLane<L>(from.mu, lane_);
        to.restitution = OfLane<L>(from.restitution, lane_);
        to.before = OfLane<L>(from.before, lane_);
        for (int r = 0; r < 3; ++r) {
          to.bias[r] = OfLane<L>(from.bias[r], lane_);
          to.l[r] = OfLane<L>(from.l[r], lane_);
        }
        to.one_direction = from.one_direction;
        to.link_count = 1;
        GatherLink(from.links[0], to.links[0]);
        GatherMasses(from, to);
        if (displaces_) Displacing(to, from.deep[lane_], from.gap[lane_]);
      }
    }
    for (int i = 0; i < work_.touch_count[lane_]; ++i) {
      const Contact<L, 2>& from = mem_.pairs[i];
      if (mem_.root[from.links[0].body] != island_root_) continue;
      ContactPoint<L, 2>& to = pool.items[pool.count];
      mem_.source[pool.count++] = m_.slot_count + i;
      to = from;
      for (Link<L, 3>& link : to.links) link.body = Number(link.body);
      if (displaces_) Displacing(to, from.deep[0], from.gap[0]);
    }
    cable_source_ = mem_.source.From(pool.count);
  }

  /// The law of a displacement: out, or no further in than to touch.
  void Displacing(ContactPoint<L, 2>& c, double deep, double gap) const noexcept;

  void GatherCables(Pool<CableRow<L>>& pool) noexcept {
    pool.count = 0;
    int link_count = 0;
    for (int i = 0; i < work_.stiff_count; ++i) {
      const StiffCable<W>& from = work_.stiff[i];
      if (!IsOn(from) || IsImplicit(from)) continue;
      CableRow<L>& to = pool.items[pool.count];
      const Row<Link<L, 1>> links = mem_.links.From(link_count);
      to.links = links;
      to.link_count = 0;
      bool pulls = false;
      for (int k = 0; k < from.link_count; ++k) {
        const int body = from.links[k].body;
        const bool mine = Moves(body) && mem_.root[body] == island_root_;
        if ((!mine && !m_.HasMotion(body)) || !IsOn(from, k)) continue;
        pulls = pulls || mine;
        GatherLink(from.links[k], links[to.link_count++]);
      }
      if (!pulls) continue;
      link_count += to.link_count;
      cable_source_[pool.count++] = i;
      to.TakeLaw(from, [&](W x) { return OfLane<L>(x, lane_); });
      to.FinishMasses();
    }
    joint_source_ = cable_source_.From(pool.count);
  }

  void GatherJoints(Pool<JointRow<L>>& pool, Pool<TurnFriction<L>>& frictions) noexcept {
    pool.count = 0;
    for (int i = 0; i < m_.joint_row_count; ++i) {
      const HeldRow<W>& from = work_.joints[i];
      if (!(from.live[lane_] > 0) || mem_.root[from.links[0].body] != island_root_) continue;
      if (m_.joint_rows[i].role == JointRole::kTurnFriction) continue;
      JointRow<L>& to = pool.items[pool.count];
      joint_source_[pool.count++] = i;
      to.link_count = from.link_count;
      for (int k = 0; k < from.link_count; ++k) GatherLink(from.links[k], to.links[k]);
      to.TakeLaw(from, [&](W x) { return OfLane<L>(x, lane_); });
      if (displaces_) to.Hold();
    }
    friction_source_ = joint_source_.From(pool.count);
    GatherFrictions(frictions);
    chain_source_ = friction_source_.From(frictions.count);
  }

  /// Of ball joints: three rows are one law. A displacement has none.
  void GatherFrictions(Pool<TurnFriction<L>>& pool) noexcept {
    pool.count = 0;
    if (m_.turn_friction_count == 0 || displaces_) return;
    for (int i = 0; i < m_.joint_row_count; ++i) {
      if (m_.joint_rows[i].role != JointRole::kTurnFriction) continue;
      const HeldRow<W>* const from = work_.joints + i;
      i += 2;
      if (!(from->live[lane_] > 0) || mem_.root[from->links[0].body] != island_root_) continue;
      TurnFriction<L>& to = pool.items[pool.count];
      friction_source_[pool.count++] = i - 2;
      to.limit = OfLane<L>(from->upper, lane_);
      to.link_count = from->link_count;
      for (int k = 0; k < to.link_count; ++k) {
        for (int r = 0; r < 3; ++r) GatherLink(from[r].links[k], to.links[k], r);
      }
      to.FinishMasses();
    }
  }

  /// Impulses and velocities back into the lane.
  void Scatter() noexcept {
    const Island<L, StepPools<L>>& island = mem_.island;
    const L* l = island.m.l;
    const Pool<ContactPoint<L, 2>>& contacts = island.pools;
    for (int i = 0; i < contacts.count; ++i) {
      const int from = mem_.source[i];
      for (int k = 0; k < 3; ++k) {
        if (from < m_.slot_count) {
          SetLane(work_.contacts[from].l[k], l[0], lane_);
        } else {
          mem_.pairs[from - m_.slot_count].l[k] = l[0];
        }
        ++l;
      }
    }
    const Pool<CableRow<L>>& cables = island.pools;
    for (int i = 0; i < cables.count; ++i) {
      SetLane(work_.stiff[cable_source_[i]].l[0], *l++, lane_);
    }
    const Pool<JointRow<L>>& joints = island.pools;
    for (int i = 0; i < joints.count; ++i) {
      SetLane(work_.joints[joint_source_[i]].l[0], *l++, lane_);
    }
    const Pool<TurnFriction<L>>& frictions = island.pools;
    for (int i = 0; i < frictions.count; ++i) {
      for (int k = 0; k < 3; ++k) {
        SetLane(work_.joints[friction_source_[i] + k].l[0], *l++, lane_);
      }
    }
    const Pool<CableChain<L>>& chains = island.pools;
    for (int i = 0; i < chains.count; ++i) {
      ChainSpan<W>* const spans = work_.spans + m_.cables[chain_source_[i]].first_span;
      for (int k = 0; k < chains.items[i].rows; ++k) SetLane(spans[k].l, *l++, lane_);
    }
    for (int b = 0; b < count_; ++b) {
      const Twist<L> t = island.Load(island.m.v + kDofs * b);
      BodyWork<W>& body = work_.bodies[island.bodies[b].body];
      SetLane(body.v, t.v, lane_);
      SetLane(body.w, t.w, lane_);
    }
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  LaneMemory<L>& mem_;
  const StepSettings& settings_;
  int lane_;
  L h_;
  bool displaces_ = false;
  int count_ = 0, island_root_ = 0;
  Row<int> cable_source_, joint_source_, friction_source_, chain_source_;
};

}  // namespace taut::sim
