/// What joints hold, as one linear system over the bodies that they move, in all lanes: the least
/// change, by mass, that brings all rows to what is wanted (docs/theory/joints.md, eq. 7). It
/// closes gaps at the end of a step, and makes guesses of velocities agree around loops.
///
/// Which bodies, rows and blocks there are follows from the model. Redundant rows share what they
/// carry: each is softened by a share of its own inverse mass, and a second pass takes back what
/// that leaves.

namespace taut::sim {

/// How far a held row is from what is wanted: its measure is to be 0, but for a distance.
template <class W>
TAUT_INLINE W MissOf(JointMeasure measure, const JointTable& j, W value) noexcept {
  return measure == JointMeasure::kDistance ? value - W::Splat(j.rest) : value;
}

template <class W>
class JointSystem {
  static constexpr double kCompliance = 1e-7;
  static constexpr int kPasses = 2;

 public:
  JointSystem(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept
      : m_(m),
        s_(s),
        work_(work),
        mem_(work.joint_memory),
        matrix_(*m.joint_pattern, mem_.blocks) {}

  /// Adds the stops that are closed at the end of the step to what is held.
  void IncludeStops() noexcept { with_stops_ = true; }

  /// `inertia(body)`: in W, what turns cost; `place(joint)`: where it is.
  template <class F, class G>
  void Assemble(const F& inertia, const G& place) noexcept {
    for (int k = 0; k < m_.joint_body_count; ++k) {
      const int b = m_.joint_bodies[k];
      Unknown<W>& body = mem_.bodies[k];
      body.body = b, body.size = kDofs;
      body.mass = s_.mass[b], body.inv_mass = s_.inv_mass[b];
      body.inertia = inertia(b);
    }
    matrix_.Start(mem_.bodies, true);
    rows_ = 0;
    for (int i = 0; i < m_.joint_count; ++i) {
      const JointTable& j = m_.joints[i];
      const JointPlace<W> p = place(i);
      const JointInertias<W> inertias(s_, work_, j);
      for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
        const JointRowTable& table = m_.joint_rows[r];
        if (table.role != JointRole::kHold) break;
        const JointDirection<W> d = DirectionOf(j, table.measure, p, W::Splat(0.0));
        JointRow<W>& row = mem_.rows[rows_];
        SetJointLinks(s_, work_, j, inertias, p, d, IsTurn(table.measure), row);
        for (int k = 0; k < row.link_count; ++k) {
          row.links[k].body = m_.joint_number[row.links[k].body];
        }
        mem_.G[rows_] = W::Splat(1.0) / (W::Splat(kCompliance) * row.A);
        mem_.miss[rows_] = MissOf(table.measure, j, d.value);
        matrix_.Add(row, &mem_.G[rows_]);
        ++rows_;
      }
    }
    if (with_stops_) AddStops(place);
    matrix_.Factor();
  }

  /// By how much rows miss what is wanted, at the place.
  void Miss(int row, W by) noexcept { mem_.miss[row] = by; }
  int rows() const noexcept { return rows_; }

  /// Velocities (or displacements) by which no row misses it any more: change(k), by the number of
  /// the body.
  void Solve() noexcept {
    const W zero = W::Splat(0.0);
    const int size = kDofs * m_.joint_body_count;
    for (int i = 0; i < size; ++i) mem_.change[i] = zero;
    for (int pass = 0; pass < kPasses; ++pass) {
      for (int i = 0; i < size + kDofs * m_.motion_count; ++i) mem_.rhs[i] = zero;
      for (int r = 0; r < rows_; ++r) {
        const W push = zero - mem_.G[r] * mem_.miss[r];
        for (int k = 0; k < mem_.rows[r].link_count; ++k) {
          if (mem_.rows[r].links[k].body >= m_.joint_body_count) continue;
          Island<W, Pools<JointRow<W>>>::AddForce(mem_.rows[r].links[k], &push, mem_.rhs);
        }
      }
      matrix_.Solve(mem_.rhs);
      for (int r = 0; r < rows_; ++r) mem_.miss[r] += RateBy(mem_.rows[r], mem_.rhs);
      for (int i = 0; i < size; ++i) mem_.change[i] += mem_.rhs[i];
    }
  }
  /// How the bodies give way to the generalized forces in `x`, 6 a body, if nothing held moves.
  void GiveWay(W* x) const noexcept { matrix_.Solve(x); }

  Twist<W> change(int k) const noexcept {
    return Island<W, Pools<JointRow<W>>>::Load(mem_.change + kDofs * k);
  }

  /// A row's velocity at the velocities of bodies, by their numbers in the world.
  W RateAt(int row, const Twist<W>* of) const noexcept {
    W u = W::Splat(0.0);
    const JointRow<W>& r = mem_.rows[row];
    for (int k = 0; k < r.link_count; ++k) {
      const Twist<W>& t = of[m_.joint_bodies[r.links[k].body]];
      AddVelocity(r.links[k], t.v, t.w, &u);
    }
    return u;
  }

 private:
  /// Behind all rows that are held. In lanes where a stop is open its row weighs nothing.
  template <class G>
  void AddStops(const G& place) noexcept {
    const W zero = W::Splat(0.0), one = W::Splat(1.0), least = W::Splat(1e-300);
    for (int r = 0; r < m_.joint_row_count; ++r) {
      const JointRowTable& table = m_.joint_rows[r];
      if (!IsStop(table.role)) continue;
      const int i = work_.joints[r].joint;
      const JointTable& j = m_.joints[i];
      const JointPlace<W> p = place(i);
      const JointDirection<W> d = DirectionOf(j, table, p, AngleAt(j, p, s_.joint_angle[i]));
      const auto closed = IsClosedAtEnd(work_.joints[r], d.value);
      if (!Any(closed)) continue;
      const JointInertias<W> inertias(s_, work_, j);
      JointRow<W>& row = mem_.rows[rows_];
      SetJointLinks(s_, work_, j, inertias, p, d, IsTurn(table.measure), row);
      for (int k = 0; k < row.link_count; ++k) {
        row.links[k].body = m_.joint_number[row.links[k].body];
      }
      const W weight = one / Max(W::Splat(kCompliance) * row.A, least);
      mem_.G[rows_] = Select(closed, weight, zero);
      mem_.miss[rows_] = Select(closed, d.value, zero);
      matrix_.Add(row, &mem_.G[rows_]);
      ++rows_;
    }
  }

  static W RateBy(const JointRow<W>& row, const W* x) noexcept {
    W u = W::Splat(0.0);
    for (int k = 0; k < row.link_count; ++k) {
      const Twist<W> t = Island<W, Pools<JointRow<W>>>::Load(x + kDofs * row.links[k].body);
      AddVelocity(row.links[k], t.v, t.w, &u);
    }
    return u;
  }

  const View& m_;
  const Rows<W>& s_;
  Scratch<W>& work_;
  JointMemory<W>& mem_;
  BodyMatrix<W> matrix_;
  int rows_ = 0;
  bool with_stops_ = false;
};

/// Guessed velocities of the step's end that agree with what joints hold there: around loops the
/// targets that follow from them do not contradict each other.
template <class W>
void AgreeGuesses(const View& m, const Rows<W>& s, Scratch<W>& work, W half_h) noexcept {
  JointSystem<W> system(m, s, work);
  // All turns cost alike: by mass a thin rod's turn about its axis would be nearly free, and a
  // guess far off.
  const auto same = [&](int b) {
    const V3<W>& moments = s.inertia[b];
    const W most = Max(moments.x, Max(moments.y, moments.z)), zero = W::Splat(0.0);
    return S3<W>{most, most, most, zero, zero, zero};
  };
  system.Assemble(same, [&](int i) {
    const JointTable& j = m.joints[i];
    const JointPlace<W> p = PlaceOf(m, s, j, work.bodies[j.a].R, work.bodies[j.b].R);
    return PlaceAfter(p, work.joint_guess[j.a], work.joint_guess[j.b], half_h);
  });
  for (int r = 0; r < system.rows(); ++r) system.Miss(r, system.RateAt(r, work.joint_guess));
  system.Solve();
  for (int k = 0; k < m.joint_body_count; ++k) {
    Twist<W>& guess = work.joint_guess[m.joint_bodies[k]];
    const Twist<W> change = system.change(k);
    guess.v += change.v, guess.w += change.w;
  }
}

/// Of a chain by itself the angular momentum stays: it turns the slower for what its bodies have
/// gained.
template <class W>
void KeepMomentumOf(const View& m, const Rows<W>& s, Scratch<W>& work, const int* bodies,
                    int count) noexcept {
  const W zero = W::Splat(0.0);
  const V3<W> none{zero, zero, zero};
  const auto solid = [&](int k) {
    const int b = bodies[k];
    return Solid<W>{s.pos[b], s.mass[b], Congruence(work.bodies[b].R, s.inertia[b])};
  };
  V3<W> gained = none;
  for (int k = 0; k < count; ++k) gained += work.joint_memory.gained[m.joint_number[bodies[k]]];
  const CommonTurn<W> turn(count, solid, -gained);
  for (int k = 0; k < count; ++k) {
    const int b = bodies[k];
    s.vel[b] += turn.VelocityAt(s.pos[b]) + none;
    s.mom[b] += solid(k).inertia * turn.w + none;
  }
}

/// The furthest that what is held is from where it is to be [m], in each lane.
template <class W>
W WorstGap(const View& m, const Rows<W>& s, const Scratch<W>& work) noexcept {
  W worst = W::Splat(0.0);
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    const JointPlace<W> p = PlaceOf(m, s, j, work.bodies[j.a].R, work.bodies[j.b].R);
    for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
      const JointMeasure measure = m.joint_rows[r].measure;
      if (m.joint_rows[r].role != JointRole::kHold) break;
      const W value = DirectionOf(j, measure, p, W::Splat(0.0)).value;
      worst = Max(Abs(MissOf(measure, j, value)), worst);
    }
    for (int r = j.first_row; r < j.first_row + j.row_count; ++r) {
      if (!IsStop(m.joint_rows[r].role)) continue;
      const W gap = DirectionOf(j, m.joint_rows[r], p, AngleAt(j, p, s.joint_angle[i])).value;
      const auto closed = IsClosedAtEnd(work.joints[r], gap);
      worst = Max(Select(closed, Abs(gap), W::Splat(0.0)), worst);
    }
  }
  return worst;
}

template <class W>
void TurnJointedBodies(const View& m, const Rows<W>& s, Scratch<W>& work) noexcept {
  for (int k = 0; k < m.joint_body_count; ++k) {
    const int b = m.joint_bodies[k];
    work.bodies[b].R = RotationOf(s.quat[b]);
    work.bodies[b].inv_inertia = Congruence(work.bodies[b].R, s.inv_inertia[b]);
  }
}

/// The least displacement of `lanes` that closes all gaps, to first order.
template <class W>
void CloseGaps(const View& m, const Rows<W>& s, Scratch<W>& work, MaskOf<W> lanes) noexcept {
  const W zero = W::Splat(0.0);  // + 0: see StageDriftSecond
  const V3<W> none{zero, zero, zero};
  JointSystem<W> system(m, s, work);
  system.IncludeStops();
  system.Assemble([&](int b) { return Congruence(work.bodies[b].R, s.inertia[b]); },
                  [&](int i) {
                    const JointTable& j = m.joints[i];
                    return PlaceOf(m, s, j, work.bodies[j.a].R, work.bodies[j.b].R);
                  });
  system.Solve();
  for (int k = 0; k < m.joint_body_count; ++k) {
    const int b = m.joint_bodies[k];
    Twist<W> change = system.change(k);
    change.v = Select3(lanes, change.v, none), change.w = Select3(lanes, change.w, none);
    s.pos[b] += change.v + none;
    Q4<W> q = s.quat[b];
    TurnAbout(q, W::Splat(0.5) * change.w);
    NormalizeQuat(q);
    s.quat[b] = {Select(lanes, q.w, s.quat[b].w) + zero, Select(lanes, q.x, s.quat[b].x) + zero,
                 Select(lanes, q.y, s.quat[b].y) + zero, Select(lanes, q.z, s.quat[b].z) + zero};
    const V3<W> turned = Turned(change.w, s.mom[b]);
    work.joint_memory.gained[k] = (turned - s.mom[b]) + Cross(change.v, s.mass[b] * s.vel[b]);
    s.mom[b] = Select3(lanes, turned, s.mom[b]) + none;
    work.joint_memory.moved[k] = Norm1(change.v) + W::Splat(m.bound_m[b]) * Norm1(change.w);
  }
  TurnJointedBodies(m, s, work);
  for (int chain = 0; chain < m.free_chain_count; ++chain) {
    KeepMomentumOf(m, s, work, m.free_chain_bodies + m.free_chains[chain],
                   m.free_chains[chain + 1] - m.free_chains[chain]);
  }
  const auto moved = [&](int b) {
    const int k = m.joint_number[b];
    return k < 0 || k >= m.joint_body_count ? zero : work.joint_memory.moved[k];
  };
  for (int pair = 0; pair < m.body_pair_count; ++pair) {
    s.clearance[pair] -= moved(m.body_pairs[pair].a) + moved(m.body_pairs[pair].b);
  }
}

/// Angles of hinges where their bodies are now, `t` after they were read.
template <class W>
void FollowHinges(const View& m, const Rows<W>& s, const Scratch<W>& work, W t) noexcept {
  for (int i = 0; i < m.joint_count; ++i) {
    const JointTable& j = m.joints[i];
    if (!j.has_angle) continue;
    const BodyWork<W>&a = work.bodies[j.a], &b = work.bodies[j.b];
    const JointPlace<W> p = PlaceOf(m, s, j, a.R, b.R);
    const W turned = t * Dot(p.axes_a.r0, b.w - a.w);
    s.joint_angle[i] = HingeAngle(p, s.joint_angle[i] + turned);
  }
}

/// Stage: closes what gaps the drifts have left in joints. Angular momenta turn with their bodies:
/// a thin rod would take what it then has along its axis for a spin.
///   reads   pos, quat, joints[]     writes  pos, quat, vel, mom, bodies[].R, clearance,
///   joint_angle
template <class W>
void StageJointPlaces(const View& m, const Rows<W>& s, Scratch<W>& work, W half_h) noexcept {
  constexpr double kClosed_m = 1e-10;
  constexpr int kRounds = 3;
  TurnJointedBodies(m, s, work);
  FollowHinges(m, s, work, half_h);
  auto lanes = MaskOf<W>::Splat(true);
  for (int round = 0; round < kRounds && Any(lanes); ++round) {
    CloseGaps(m, s, work, lanes);
    lanes = lanes & (WorstGap(m, s, work) > W::Splat(kClosed_m));
  }
  FollowHinges(m, s, work, W::Splat(0.0));
}

}  // namespace taut::sim
