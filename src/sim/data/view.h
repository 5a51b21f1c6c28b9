/// Read-only model data for a step: topology and constants, shared by all worlds.
///
/// Every body has a principal frame P: its origin is the center of mass, its axes are the principal
/// axes of inertia. Points of a body are stored in P. The world is body number `body_count`; it has
/// no mass, does not move, and its frame is W.
#pragma once

#include <cstdint>

#include "sim/data/body_frame.h"
#include "sim/data/cable_table.h"
#include "sim/data/elimination.h"
#include "sim/data/joint_table.h"
#include "sim/data/motion_table.h"
#include "sim/data/state_rows.h"
#include "sim/geometry/bvh.h"
#include "sim/geometry/seams.h"
#include "sim/geometry/shape_contacts.h"
#include "sim/geometry/surface.h"
#include "taut/world_batch.h"

namespace taut::sim {

/// Parameters of a `DcMotorDef` in the form that its law uses (dc_motor.inl; docs/theory/motor.md).
struct MotorTable {
  int cable = 0, supply = 0;
  double way_m = 0;        ///< Change of the rest length per rotor angle [m/rad].
  double inv_inertia = 0;  ///< 1 / moment of inertia of the rotor [1/(kg m^2)].
  double constant = 0;     ///< Torque per current, and back EMF per speed [V s/rad].
  double winding_ohm = 0, driver_ohm = 0;
  double rise_per_k = 0, rated_c = 0, ambient_c = 0;
  /// Coulomb friction torque, and excess of the static friction torque over it [N m].
  double friction = 0, static_more = 0;
  double inv_stribeck2 = 0;  ///< 1 / (Stribeck speed)^2 [s^2/rad^2].
  double viscous = 0;        ///< Viscous friction [N m s/rad].
  double gear_loss = 0;      ///< Friction of the gear per torque from the cable [1].
  double backlash_m = 0, min_rest_m = 0;
  /// Thermal conductances from winding to housing, and from housing to air.
  double winding_w_per_k = 0, housing_w_per_k = 0;
  double winding_k_per_j = 0, housing_k_per_j = 0;  ///< 1 / heat capacity.
  double servo_gain = 0, servo_damping = 0;         ///< Gains of the servo [1/m], [s/m].
};

struct SupplyTable {
  double voltage_v = 0, resistance_ohm = 0;
};

struct AttachmentTable {
  int body = 0;
  double p_P[3] = {};  ///< Position in frame P [m].
  int spot = 0;        ///< For cables: index of the point among all attachment points.
};

/// Shape that may touch other shapes.
struct ShapeTable {
  int body = 0;
  Shape shape_P;
  double center_P[3] = {};
  double bound_m = 0;  ///< Radius of the bounding sphere around `center_P`.
  Material material;
  int point[2] = {};            ///< For round shapes: indices of both ends among all points.
  bool elsewhere[2] = {};       ///< Whether another shape of the body has the same end.
  const int* beside = nullptr;  ///< For terrain boxes: other terrain boxes that touch this one.
  int beside_count = 0;
  SeamList seams;    ///< For terrain boxes: adjacent pieces.
  bool led = false;  ///< Whether the shape's body is kinematic or has a joint.

  /// Returns whether adjacent pieces must be checked. Always inline: see View.
  [[gnu::always_inline]] bool IsJoined() const noexcept {
    return beside_count > 0 || seams.count > 0;
  }
};

/// Largest gap between touching terrain boxes [m].
inline constexpr double kJoinedM = 1e-9;
/// Maximum numbers of pairs of touching boxes, and of their points, per query.
inline constexpr int kMostJoinedPairs = 32, kMostJoinedPoints = kMostJoinedPairs * 13;

/// Point that can touch a plane: center of a sphere, end of a capsule, or corner of a box or hull.
struct PointTable {
  double p_P[3] = {};
  double radius_m = 0;
  double static_friction[8] = {}, kinetic_friction[8] = {}, restitution[8] = {};  ///< Per plane.
};

/// Friction properties of one surface of a contact.
struct FrictionSide {
  ShapeRef ref;
  int body = kWorld;  ///< Body index in the `ModelDef`.
  bool directed = false;
  bool by_slip = false;  ///< Friction is not given by two constant coefficients.
  double at_rest = 0, sliding = 0;
  double inv_stribeck2 = 0;  ///< 1 / (Stribeck speed)^2 [s^2/m^2], or 0.
  double viscous = 0;        ///< Increase of the coefficient with speed [s/m].
  double forward = 1, backward = 1, sideways = 1;
  double axis_P[3] = {};  ///< Unit vector, if directed.
};

/// Friction data of models with more than two coefficients per pair (friction.h).
struct FrictionTable {
  const FrictionSide* sides = nullptr;  ///< For all shapes, then for all planes.
  int shape_count = 0;
  const int* shape_of_point = nullptr;
  CombineRule combine = CombineRule::kGeometricMean;
  const ContactFriction* law = nullptr;  ///< Custom law, or null.
};

struct PlaneTable {
  double normal[3] = {}, tangent1[3] = {}, tangent2[3] = {};
  double offset_m = 0;   ///< normal . x for points x of the plane.
  bool upright = false;  ///< Whether the normal and tangents are z, x and y.
};

struct ShapePairTable {
  int a = 0, b = 0;      ///< Shape indices; the body of `a` is not the world.
  std::uint32_t id = 0;  ///< Key of its first possible contact point.
  double static_friction = 0, kinetic_friction = 0, restitution = 0;
  std::uint32_t elsewhere = 0;  ///< One bit per feature that another pair also has.
};

/// Body and static body or world that may touch, with all pairs of their shapes; or a shape of a
/// body and a surface.
struct WorldPairTable {
  int a = 0, b = 0;  ///< b may be the world.
  int first_pair = 0, pair_count = 0;
  bool by_tree = false;    ///< `b` is the world; the BVH finds its shapes.
  bool on_ground = false;  ///< A single pair, whose second shape is a surface.
  int kept = -1;           ///< Index of its cache of near parts (contact_cache.h); -1: none.
  bool joined = false;     ///< `b` is the world, and some of its boxes touch each other.
};

/// Two bodies that may touch: impulses move `a`; `b` is moved by impulses, too, or kinematic. The
/// pairs of their shapes are not stored, because their number grows with the square of the model
/// (contacts/moving_pairs.h).
struct MovingPair {
  int a = 0, b = 0;
};

/// Entry in the list of a body A: a body with a larger number that cannot collide with A.
struct ApartTable {
  int body = 0;
  int shapes_before = 0;  ///< Shapes of all previous bodies of the list.
};

/// Largest number of pairs of moving bodies that are tested one by one. In larger models, lists of
/// near bodies replace the list of all pairs (near_bodies.inl).
inline constexpr int kFewMovingPairs = 1024;
/// Capacity of a list of near bodies, per body that may touch others.
inline constexpr int kNearPerBody = 8;

/// Largest number of static shapes that are tested one by one; more are in a BVH.
inline constexpr int kFewShapes = 8;

inline constexpr int kMaxPlanes = 8;

/// Offsets of all rows of a group of worlds, in units of rows with one double per lane
/// (state_rows.h).
struct Layout {
#define TAUT_ROW(name, ...) int name = 0;
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  int hash_rows = 0;      ///< State and parameters, which are first.
  int snapshot_rows = 0;  ///< State, parameters, and the following readings.
  int rows = 0;
};

/// Line of state_rows.h, for loops over all rows.
struct RowInfo {
  int width;
  Per per;
  Role role;
  Halted halted;
  int Layout::*first;
};

inline constexpr RowInfo kStateRows[] = {
#define TAUT_ROW(name, type, per, role, halted, start) \
  {kWidth##type, Per::per, Role::role, Halted::halted, &Layout::name},
    TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
};

/// Returns whether roles ascend in the list. Snapshots and hashes need this, because they copy
/// state and parameters as one block.
constexpr bool RolesRise() {
  Role last = Role::kState;
  for (const RowInfo& row : kStateRows) {
    if (row.role < last) return false;
    last = row.role;
  }
  return true;
}
static_assert(RolesRise());

/// Pointers to the data of `Tables`, without the standard library.
struct View {
  int body_count, cable_count, node_count, plane_count;
  const double* bound_m;
  const CableTable* cables;
  const AttachmentTable* attachments;
  const AttachmentTable* spots;
  const AttachmentTable* nodes;
  const PlaneTable* planes;
  const int* first_point;
  const PointTable* points;
  const ShapeTable* shapes;
  int shape_count;
  const ShapePairTable* shape_pairs;  ///< With static shapes.
  int shape_pair_count;
  const WorldPairTable* world_pairs;
  int world_pair_count;
  /// Bodies that have shapes and move or are kinematic; shapes of each body, by its number. The row
  /// of a body contains its pairs with later bodies. For each row: number of shape pairs before the
  /// row, and the bodies that are kept apart from this body.
  const int* colliders;
  int collider_count;
  const int *first_shape, *body_shapes;
  const std::uint32_t* shape_pairs_before;
  const ApartTable* apart;
  const int* first_apart;
  /// All pairs of moving bodies; none if there are too many. With too many pairs, `near_capacity`
  /// is the capacity of a list of near bodies, otherwise 0.
  const MovingPair* moving_pairs;
  int moving_pair_count, near_capacity;
  double near_m;  ///< Motion of a body after which the list of near bodies is made again [m].
  CombineRule friction_combine, restitution_combine;
  const int* first_slot;
  int slot_count;
  std::uint32_t first_pair_id;
  int pair_capacity, max_attachments, attachment_count, spot_count;
  int wheel_count, max_wheels;
  const WheelTable* wheels;
  int chain_count, span_count, slip_count, chain_link_count;
  const SlipTable* slips;
  bool along_slip;
  bool has_ground;  ///< Whether there are height fields or meshes.
  int kept_count;   ///< Number of caches of near parts (WorldPairTable::kept).
  int motor_count, supply_count;
  const MotorTable* motors;
  const SupplyTable* supplies;
  int tree_nodes, tree_shapes;
  const TreeNode* tree;
  int world_shape_count;    ///< Number of static shapes without surfaces.
  const int* world_shapes;  ///< Static shapes in BVH order.
  int touch_count;
  const TouchTable* touches;
  int touch_rod_count;
  const TouchRodTable* touch_rods;
  const FrictionTable* friction;  ///< Null: only the coefficients of the pairs apply.
  double floor_m;  ///< Height below which a body left the terrain; minus infinity: no limit.
  int first_ground, ground_count;  ///< Range of the surfaces among the shapes.
  int joint_count, joint_row_count, joint_body_count, turn_friction_count;
  const JointTable* joints;
  const JointRowTable* joint_rows;
  const int *joint_bodies, *joint_number, *hinged;
  const BlockPattern* joint_pattern;
  /// System of all bodies (solve/world_primal.inl); empty if that solver is not used. Body of each
  /// number, and the inverse mapping.
  const BlockPattern* world_pattern;
  const int *world_bodies, *world_number;
  bool joint_loops;
  int free_chain_count;
  const int *free_chains, *free_chain_bodies;
  int motion_count;
  const MotionTable* motions;
  const MotionKnot* motion_knots;
  const int* motion_of_body;  ///< Per body: index of its motion, or -1; null without motions.

  // Always inline: if several instruction sets emit a function, the linker keeps any one of them.
  /// Returns the number of clearances of moving bodies.
  [[gnu::always_inline]] int MovingClearances() const noexcept {
    return near_capacity > 0 ? near_capacity : moving_pair_count;
  }
  /// Returns whether one shape of a pair is round, so that the contact point is fixed to neither
  /// body, and one body is kinematic or has a joint (solve/rolling.inl).
  [[gnu::always_inline]] bool Rolls(int shape_a, int shape_b) const noexcept {
    const ShapeTable &a = shapes[shape_a], &b = shapes[shape_b];
    const bool round = a.shape_P.kind == ShapeKind::kRound || b.shape_P.kind == ShapeKind::kRound;
    return round && (a.led || b.led);
  }
  /// Returns the maximum number of simultaneous contacts in one world.
  [[gnu::always_inline]] int ContactCapacity() const noexcept { return slot_count + pair_capacity; }
  /// Returns the capacity for links of all cables to bodies in `lanes` lanes: one per attachment,
  /// and one per rod around which the cable may wrap. In each lane, a cable touches at most
  /// kMostBends rods, possibly different ones.
  [[gnu::always_inline]] int CableLinkCapacity(int lanes) const noexcept {
    int count = attachment_count;
    for (int i = 0; i < touch_count; ++i) {
      const int bends = lanes * kMostBends, rods = touches[i].rod_count;
      count += bends < rods ? bends : rods;
    }
    return count;
  }
  /// Returns the largest number of rods around which one cable may wrap.
  [[gnu::always_inline]] int MostTouchRods() const noexcept {
    int most = 0;
    for (int i = 0; i < touch_count; ++i) {
      if (touches[i].rod_count > most) most = touches[i].rod_count;
    }
    return most;
  }
  /// Returns whether a body is kinematic.
  [[gnu::always_inline]] bool HasMotion(int body) const noexcept {
    return motion_count > 0 && body < body_count && motion_of_body[body] >= 0;
  }
  /// Returns the number of elements of a row.
  [[gnu::always_inline]] int Count(Per per) const noexcept {
    switch (per) {
      case Per::kBody:
        return body_count;
      case Per::kCable:
        return cable_count;
      case Per::kMotor:
        return motor_count;
      case Per::kWheel:
        return wheel_count;
      case Per::kSpan:
        return span_count;
      case Per::kSlip:
        return slip_count;
      case Per::kTouch:
        return touch_count;
      case Per::kTouchRod:
        return touch_rod_count;
      case Per::kBend:
        return touch_count * kMostBends;
      case Per::kNode:
        return node_count;
      case Per::kJoint:
        return joint_count;
      case Per::kJointRow:
        return joint_row_count;
      case Per::kMotion:
        return motion_count;
      case Per::kBodyPair:
        return world_pair_count + MovingClearances();
      case Per::kNear:
        return near_capacity > 0 ? body_count : 0;
      case Per::kKept:
        return kept_count;
      case Per::kContact:
        return ContactCapacity();
      default:
        return 1;
    }
  }
};

}  // namespace taut::sim
