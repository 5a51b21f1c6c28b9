// Compilation of the joints of a model: rows, and the elimination order of their linear system.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "base/union_find.h"
#include "math/rotation.h"
#include "math/vec.h"
#include "sim/data/body_frame.h"
#include "sim/data/elimination.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

using M = JointMeasure;

/// Returns the measures that a kind of joint constrains.
std::vector<M> HeldMeasures(JointKind kind) {
  const HeldMotions held = ConstrainedMotions(kind);
  std::vector<M> rows;
  const auto add = [&](bool has, std::initializer_list<M> measures) {
    for (const M measure : measures) {
      if (has) rows.push_back(measure);
    }
  };
  add(held.along, {M::kAlongAxis});
  add(held.across, {M::kAcross1, M::kAcross2});
  add(held.swing, {M::kSwing1, M::kSwing2});
  add(held.twist, {M::kTwist});
  add(kind == JointKind::kDistance, {M::kDistance});
  return rows;
}

std::optional<M> CoordinateOf(JointKind kind) {
  using K = JointKind;
  switch (kind) {
    case K::kBall:
      return M::kCone;
    case K::kHinge:
      return M::kAngle;
    case K::kPrismatic:
    case K::kCylindrical:
    case K::kLine:
      return M::kAlongAxis;
    case K::kDistance:
      return M::kDistance;
    case K::kWeld:
    case K::kPlanar:
    case K::kPlane:
      break;
  }
  return std::nullopt;
}

class JointCompiler {
 public:
  JointCompiler(Tables& t, const std::vector<Frame>& frames) : t_(t), frames_(frames) {}

  void Run() {
    for (const JointDef& def : t_.def().joints) Lay(def);
    if (t_.joints.empty()) return;
    FindChains();
    Order();
  }

 private:
  int Index(int body) const { return body == kWorld ? t_.body_count : body; }
  void Axes(int body, const Vec3 (&axes)[3], double out[9]) const {
    Frame turned = frames_[static_cast<std::size_t>(body)];
    std::fill_n(turned.origin, 3, 0.0);
    for (int i = 0; i < 3; ++i) ToBody(turned, axes[i], out + 3 * i);
  }

  /// Returns the largest radius of gyration of a body [m].
  double Gyration(int body) const {
    if (!t_.Moves(body)) return 0;
    const double* const moments = &t_.inertia[static_cast<std::size_t>(3 * body)];
    const double most = std::max({moments[0], moments[1], moments[2]});
    return std::sqrt(most / t_.def().bodies[static_cast<std::size_t>(body)].mass_kg);
  }

  void Lay(const JointDef& def) {
    JointTable j;
    j.a = Index(def.body_a), j.b = Index(def.body_b);
    j.a_moves = t_.Moves(j.a), j.b_moves = t_.Moves(j.b);
    j.a_is_moved = t_.HasMotion(j.a), j.b_is_moved = t_.HasMotion(j.b);
    ToBody(frames_[static_cast<std::size_t>(j.a)], def.from_m, j.own_a_P);
    ToBody(frames_[static_cast<std::size_t>(j.b)], def.to_m, j.own_b_P);
    const Vec3 n = (1 / std::sqrt(Dot(def.axis, def.axis))) * def.axis;
    const Vec3 other = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 across = other - Dot(other, n) * n;
    across = (1 / std::sqrt(Dot(across, across))) * across;
    const Vec3 axes[3] = {n, across, Cross(n, across)};
    Axes(j.a, axes, j.axes_a_P);
    const Vec3 in_b[3] = {Rotate(def.turned, axes[0]), Rotate(def.turned, axes[1]),
                          Rotate(def.turned, axes[2])};
    Axes(j.b, in_b, j.axes_b_P);
    j.reach_m = std::max(Gyration(j.a), Gyration(j.b));
    j.first_row = static_cast<int>(t_.joint_rows.size());
    if (def.kind != JointKind::kDistance || HoldsLength(def)) {
      for (const M measure : HeldMeasures(def.kind)) {
        t_.joint_rows.push_back({measure, JointRole::kHold});
      }
    }
    if (const auto coordinate = CoordinateOf(def.kind)) Coordinate(def, *coordinate, j);
    if (def.kind == JointKind::kBall) Turns(def, j);
    if (def.kind == JointKind::kDistance && HoldsLength(def)) {
      const Vec3 d = def.to_m - def.from_m;
      j.rest = std::sqrt(Dot(d, d));
    }
    j.row_count = static_cast<int>(t_.joint_rows.size()) - j.first_row;
    j.holds_point = ConstrainedMotions(def.kind).along && ConstrainedMotions(def.kind).across;
    t_.joints.push_back(j);
  }

  void Coordinate(const JointDef& def, M measure, JointTable& j) {
    const bool turns = IsAngle(def.kind);
    const double unit = turns ? j.reach_m : 1.0;
    j.has_coordinate = true, j.coordinate = measure;
    j.has_angle = measure == M::kAngle;
    j.least = unit * def.least.value_or(0), j.most = unit * def.most.value_or(0);
    j.rest = unit * def.rest;
    j.restitution = def.restitution;
    j.friction = def.friction / unit;
    j.stiffness = def.stiffness / (unit * unit), j.damping = def.damping / (unit * unit);
    const auto add = [&](bool has, JointRole role) {
      if (has) t_.joint_rows.push_back({measure, role});
    };
    add(def.least.has_value(), JointRole::kLeast);
    add(def.most.has_value(), JointRole::kMost);
    if (def.kind == JointKind::kBall) return;
    add(def.friction > 0, JointRole::kFriction);
    add(HasSpring(def), JointRole::kSpring);
  }
  static bool HasSpring(const JointDef& def) { return def.stiffness > 0 || def.damping > 0; }

  /// Adds friction and spring to the rotation of a ball joint, equal about all axes.
  void Turns(const JointDef& def, JointTable& j) {
    const auto add = [&](JointRole role) {
      for (const M measure : {M::kTurn1, M::kTurn2, M::kTurn3}) {
        t_.joint_rows.push_back({measure, role});
      }
    };
    if (def.friction > 0) add(JointRole::kTurnFriction), ++t_.turn_friction_count;
    if (HasSpring(def)) add(JointRole::kSpring);
    j.has_turn_spring = def.stiffness > 0;
  }

  /// Detects kinematic loops, including loops through static or kinematic bodies, because their
  /// rows may be redundant. Collects the chains of bodies that are not connected to such bodies.
  void FindChains() {
    base::UnionFind sets(static_cast<std::size_t>(t_.body_count) + 1);
    for (const JointTable& j : t_.joints) {
      const int a = j.a_moves ? j.a : t_.body_count, b = j.b_moves ? j.b : t_.body_count;
      t_.joint_loops = t_.joint_loops || sets.Root(a) == sets.Root(b);
      sets.Join(a, b);
    }
    const int world = sets.Root(t_.body_count);
    std::map<int, std::set<int>> chains;
    for (const JointTable& j : t_.joints) {
      for (const int body : {j.a, j.b}) {
        if (t_.Moves(body) && sets.Root(body) != world) chains[sets.Root(body)].insert(body);
      }
    }
    for (const auto& [first, bodies] : chains) {
      t_.free_chains.push_back(static_cast<int>(t_.free_chain_bodies.size()));
      t_.free_chain_bodies.insert(t_.free_chain_bodies.end(), bodies.begin(), bodies.end());
    }
    t_.free_chains.push_back(static_cast<int>(t_.free_chain_bodies.size()));
  }

  void Order() {
    const auto bodies = static_cast<std::size_t>(t_.body_count);
    std::vector<int> local(bodies + 1, -1), members;
    const auto take = [&](int body, bool moves) {
      int& number = local[static_cast<std::size_t>(body)];
      if (!moves || number >= 0) return;
      number = static_cast<int>(members.size());
      members.push_back(body);
    };
    for (const JointTable& j : t_.joints) take(j.a, j.a_moves), take(j.b, j.b_moves);
    const int n = static_cast<int>(members.size());
    const auto count = members.size();
    const int words = BodyGraph::WordsFor(n);
    std::vector<std::uint64_t> bits(count * static_cast<std::size_t>(words));
    BodyGraph graph{bits.data(), n, words};
    graph.Clear();
    for (const JointTable& j : t_.joints) {
      if (!j.a_moves || !j.b_moves) continue;
      graph.Join(local[static_cast<std::size_t>(j.a)], local[static_cast<std::size_t>(j.b)]);
    }
    std::vector<int> order(count), place(count);
    if (n <= BlockPattern::kMostInTable) t_.joint_slot.resize(count * count);
    t_.joint_below.resize(count * count);
    t_.joint_first_below.resize(count + 1);
    t_.joint_pattern = {
        t_.joint_slot.data(), t_.joint_below.data(), t_.joint_first_below.data(), n, 0, 0};
    Eliminate(graph, n * n, order.data(), place.data(), t_.joint_pattern);
    t_.hinged.assign(bodies + 1, 0);
    for (const JointTable& j : t_.joints) {
      for (const int body : {j.a, j.b}) {
        if (j.has_angle) t_.hinged[static_cast<std::size_t>(body)] = 1;
      }
    }
    t_.joint_number.assign(bodies + 1, -1);
    for (int k = 0; k < n; ++k) {
      const int body = members[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])];
      t_.joint_bodies.push_back(body);
      t_.joint_number[static_cast<std::size_t>(body)] = k;
    }
    int next = n;
    for (const MotionTable& motion : t_.motions) {
      t_.joint_bodies.push_back(motion.body);
      t_.joint_number[static_cast<std::size_t>(motion.body)] = next++;
    }
  }

  Tables& t_;
  const std::vector<Frame>& frames_;
};

}  // namespace

void LayOutJoints(Tables& tables, const std::vector<Frame>& frames) {
  JointCompiler(tables, frames).Run();
}

}  // namespace taut::sim
