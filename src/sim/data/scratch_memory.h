/// Solver memory. The model determines its size.
#pragma once

#include "sim/constraint/cable_chain.h"
#include "sim/constraint/cable_row.h"
#include "sim/constraint/joint_row.h"
#include "sim/constraint/turn_friction.h"
#include "sim/data/contacts.h"
#include "sim/data/island.h"
#include "sim/data/room.h"
#include "sim/data/view.h"

namespace taut::sim {

/// All kinds of constraints in a step.
template <class Num>
using StepPools =
    Pools<ContactPoint<Num, 2>, CableRow<Num>, JointRow<Num>, TurnFriction<Num>, CableChain<Num>>;

/// Sizes of a pattern that the next island uses again if it has the same graph.
struct KeptPattern {
  int count;  ///< Number of bodies; 0: no pattern is kept.
  int lower_count, block_count;
};

/// Memory to solve the islands of one lane. Systems with too many blocks (over 128 bodies that all
/// interact) are left to Gauss-Seidel sweeps.
template <class Num>
struct LaneMemory {
  static constexpr int64_t kFullBodies = 128;

  Row<Contact<Num, 2>> pairs;  ///< Prepared contacts of moving bodies of the lane.
  /// Per body: its island, and its number in this island; bodies of an island.
  Row<int> root, local, bodies;
  Row<int> order, place;  ///< Elimination order and its inverse.
  Row<int> source;        ///< Per constraint of an island: its index in the lane.
  BodyGraph graph;
  Row<uint64_t> kept_bits;  ///< Graph of the last island, whose order and pattern are stored.
  Row<KeptPattern> kept;
  int block_capacity;
  Island<Num, StepPools<Num>> island;
  Row<Link<Num, 1>> links;
  Row<RowLink<Num>> chain_links;  ///< Links of spans; those of a cable start at its first_link.
  Row<ChainSpan<Num>> spans;

  void Take(const View& m, Room& room) noexcept {
    const int64_t n = m.body_count, contacts = m.slot_count + m.pair_capacity;
    const int64_t single = m.cable_count + m.joint_row_count;
    const int64_t rows = 3 * contacts + single + m.span_count;
    const int64_t cells =
        9 * (contacts + m.turn_friction_count) + single + kMostSpans * m.span_count;
    const int64_t blocks = n < kFullBodies ? n * n : kFullBodies * n;
    block_capacity = static_cast<int>(blocks);
    pairs = room.Take<Contact<Num, 2>>(m.pair_capacity);
    Row<int>* const per_body[] = {&root, &local, &bodies, &order, &place};
    for (Row<int>* list : per_body) *list = room.Take<int>(n + 1);
    source = room.Take<int>(contacts + single + m.chain_count);
    graph.bits = room.Take<uint64_t>(n * BodyGraph::WordsFor(m.body_count));
    kept_bits = room.Take<uint64_t>(n * BodyGraph::WordsFor(m.body_count));
    kept = room.Take<KeptPattern>(1);
    links = room.Take<Link<Num, 1>>(m.CableLinkCapacity(1));
    chain_links = room.Take<RowLink<Num>>(m.chain_link_count);
    spans = room.Take<ChainSpan<Num>>(m.span_count);
    island.bodies = room.Take<Unknown<Num>>(n);
    constexpr int64_t kMostInTable = BlockPattern::kMostInTable;
    const int64_t in_table = n < kMostInTable ? n : kMostInTable;
    island.pattern.slot = room.Take<int>(in_table * in_table);
    island.pattern.below = room.Take<int>(blocks);
    island.pattern.first_below = room.Take<int>(n + 1);
    Pool<ContactPoint<Num, 2>>& points = island.pools;
    points.items = room.Take<ContactPoint<Num, 2>>(contacts);
    points.branches = room.Take<typename ContactPoint<Num, 2>::Branch>(contacts);
    Pool<CableRow<Num>>& cables = island.pools;
    cables.items = room.Take<CableRow<Num>>(m.cable_count);
    cables.branches = room.Take<typename CableRow<Num>::Branch>(m.cable_count);
    Pool<JointRow<Num>>& joints = island.pools;
    joints.items = room.Take<JointRow<Num>>(m.joint_row_count);
    joints.branches = room.Take<typename JointRow<Num>::Branch>(m.joint_row_count);
    Pool<TurnFriction<Num>>& frictions = island.pools;
    frictions.items = room.Take<TurnFriction<Num>>(m.turn_friction_count);
    frictions.branches = room.Take<typename TurnFriction<Num>::Branch>(m.turn_friction_count);
    Pool<CableChain<Num>>& chains = island.pools;
    chains.items = room.Take<CableChain<Num>>(m.chain_count);
    chains.branches = room.Take<typename CableChain<Num>::Branch>(m.chain_count);
    IslandMemory<Num>& x = island.m;
    Row<Num>* const per_dof[] = {&x.v, &x.rhs, &x.direction, &x.trial_v};
    for (Row<Num>* list : per_dof) *list = room.Take<Num>(kDofs * n);
    Row<Num>* const per_row[] = {&x.l,  &x.u, &x.best,           &x.center,    &x.projected, &x.du,
                                 &x.u2, &x.f, &x.impacts.before, &x.impacts.u, &x.impacts.l};
    for (Row<Num>* list : per_row) *list = room.Take<Num>(rows);
    x.g = room.Take<Num>(cells);
    x.blocks = room.Take<Num>(36 * blocks);
  }
};

/// Memory for the system of all constrained joint rows (joint_system.inl).
template <class W>
struct JointMemory {
  Row<Unknown<W>> bodies;
  Row<JointRow<W>> rows;
  Row<int> number;         ///< Per constrained row: its number in the model.
  Row<W> G, gap, miss, l;  ///< Per constrained row: stiffness, gap, error, impulse.
  Row<W> rhs, change;      ///< 6 per body. `rhs` includes kinematic bodies, which do not change.
  Row<W> moved;            ///< Per body: largest displacement of its points [m].
  Row<V3<W>> gained;       ///< Per body: change of angular momentum due to the displacement.
  Row<W> blocks;           ///< Matrix blocks, 36 numbers each.

  void Take(const View& m, Room& room) noexcept {
    const int64_t n = m.joint_body_count;
    const int64_t with_motions = n + (m.joint_count > 0 ? m.motion_count : 0);
    bodies = room.Take<Unknown<W>>(n);
    rows = room.Take<JointRow<W>>(m.joint_row_count);
    number = room.Take<int>(m.joint_row_count);
    Row<W>* const per_row[] = {&G, &gap, &miss, &l};
    for (Row<W>* list : per_row) *list = room.Take<W>(m.joint_row_count);
    rhs = room.Take<W>(kDofs * with_motions), change = room.Take<W>(kDofs * n);
    moved = room.Take<W>(n), gained = room.Take<V3<W>>(n);
    blocks = room.Take<W>(36 * static_cast<int64_t>(m.joint_pattern->lower_count));
  }
};

/// Memory to solve all cables and contacts of a world in lanes (world_dual.inl). The number of
/// possible contacts in the model determines whether a world is solved this way; other lanes have
/// no effect.
template <class W>
struct DualMemory {
  static constexpr int kMaxRows = 96, kMaxRowsPerBody = 12;
  /// Packed contacts for height fields and meshes. On these surfaces, rods have room for many
  /// contacts, but only few are active.
  using Packed = ContactPoint<W, W::kLanes>;

  /// Row of J that acts on a body.
  struct Column {
    int row;
    const V3<W>*lin, *ang, *turn;
  };
  int capacity;         ///< Number of rows; 0: this method is not used.
  int packed_capacity;  ///< Number of contacts in a world if they are packed (packed_contacts.inl).
  Row<Packed> packed;
  Row<W> a;                 ///< Delassus operator, later its factors: upper triangle, by rows.
  Row<W> c;                 ///< System matrix of the contacts.
  Row<W> u, l, r, q;        ///< Velocities and impulses; right sides, later changes.
  Row<W> d, now;            ///< Changes and impulses of the contacts only.
  Row<W> diagonal, active;  ///< A and S of the linearized cable laws.
  ImpactRows<W> impacts;
  Row<Twist<W>> v;        ///< Velocities per body.
  Row<Column> columns;    ///< Columns, sorted by body.
  Row<int> first_column;  ///< Index of the first column of each body.

  void Take(const View& m, Room& room) noexcept {
    const int of_bodies = kMaxRowsPerBody * m.body_count;
    const int most = of_bodies < kMaxRows ? of_bodies : kMaxRows;
    int contacts = m.slot_count;
    if (m.has_ground) contacts = most > m.cable_count ? (most - m.cable_count) / 3 : 0;
    const int rows = 3 * contacts + m.cable_count;
    const bool fits = rows <= most && (contacts > 0 || !m.has_ground) && m.joint_row_count == 0 &&
                      m.motion_count == 0;
    capacity = fits ? rows : 0;
    if (capacity == 0) contacts = 0;
    packed_capacity = m.has_ground ? contacts : 0;
    packed = room.Take<Packed>(packed_capacity);
    a = room.Take<W>(capacity * (capacity + 1) / 2);
    c = room.Take<W>(9 * contacts * contacts);
    Row<W>* const per_row[] = {
        &u, &l, &r, &q, &d, &now, &diagonal, &active, &impacts.before, &impacts.u, &impacts.l};
    for (Row<W>* list : per_row) *list = room.Take<W>(capacity);
    v = room.Take<Twist<W>>(m.body_count);
    first_column = room.Take<int>(m.body_count + 1);
    const int links = m.has_ground ? W::kLanes * packed_capacity : m.slot_count;
    columns = room.Take<Column>(3 * links + m.CableLinkCapacity(W::kLanes));
  }
};

/// Largest number of blocks of the system of a world with joints that is solved in lanes.
inline constexpr int kMostPrimalBlocks = 1024;

/// Memory to solve all joints, cables and contacts of a world in lanes (world_primal.inl). Empty if
/// the model does not allow this solver.
template <class W>
struct PrimalMemory {
  Row<Unknown<W>> bodies;
  Row<TurnFriction<W>> frictions;
  Row<int> friction_row;  ///< Per friction of a ball joint: its first row among those of joints.
  Row<typename JointRow<W>::Branch> joint_branches;
  Row<typename TurnFriction<W>::Branch> friction_branches;
  Row<typename CableRow<W>::Branch> cable_branches;
  Row<typename ContactPoint<W, 1>::Branch> contact_branches;
  Row<W> v, force, x, change;  ///< Vectors with 6 numbers per body.
  Row<W> l, u, f;              ///< Vectors with one number per row.
  Row<W> g;                    ///< Per constraint: a matrix of rows^2 numbers.
  Row<W> blocks;               ///< Matrix blocks, 36 numbers each.

  void Take(const View& m, Room& room) noexcept {
    const bool on = m.world_pattern->count > 0;
    const int64_t n = m.world_pattern->count, contacts = on ? m.slot_count : 0;
    const int64_t joints = on ? m.joint_row_count : 0, cables = on ? m.cable_count : 0;
    const int64_t turns = on ? m.turn_friction_count : 0;
    bodies = room.Take<Unknown<W>>(n);
    frictions = room.Take<TurnFriction<W>>(turns);
    friction_row = room.Take<int>(turns);
    joint_branches = room.Take<typename JointRow<W>::Branch>(joints);
    friction_branches = room.Take<typename TurnFriction<W>::Branch>(turns);
    cable_branches = room.Take<typename CableRow<W>::Branch>(cables);
    contact_branches = room.Take<typename ContactPoint<W, 1>::Branch>(contacts);
    for (Row<W>* list : {&v, &force, &x, &change}) *list = room.Take<W>(kDofs * n);
    for (Row<W>* list : {&l, &u, &f}) *list = room.Take<W>(joints + cables + 3 * contacts);
    g = room.Take<W>(joints + cables + 9 * (contacts + turns));
    blocks = room.Take<W>(kDofs * kDofs * static_cast<int64_t>(m.world_pattern->block_count));
  }
};

}  // namespace taut::sim
