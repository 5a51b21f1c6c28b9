/// The topology and constants of a model, laid out for stepping: what all worlds share.
///
/// Every body has a principal frame P: origin in the centre of mass, axes along the principal
/// axes of inertia. Points of a body are kept in P. The world is body number `body_count`: it
/// has no mass, does not move, and its frame is W.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/body_frame.h"
#include "sim/cable_table.h"
#include "sim/hull_build.h"
#include "sim/joint_table.h"
#include "sim/motion_table.h"
#include "sim/shape_contacts.h"
#include "sim/shape_tree.h"
#include "sim/solve/elimination.h"
#include "sim/state_rows.h"
#include "sim/surface_build.h"
#include "taut/batch.h"

namespace taut::sim {

/// A `DcMotorDef` in what its law is written in (dc_motor.inl).
struct MotorTable {
  int cable = 0, supply = 0;
  double way_m = 0;        ///< Of the rest length, per angle of the rotor [m/rad].
  double inv_inertia = 0;  ///< Of the rotor [1/(kg m^2)].
  double constant = 0;     ///< Torque per current, back EMF per speed [V s/rad].
  double winding_ohm = 0, driver_ohm = 0;
  double rise_per_k = 0, rated_c = 0, ambient_c = 0;
  double friction = 0, static_more = 0;  ///< Coulomb's, and what is above it at rest [N m].
  double inv_stribeck2 = 0;              ///< 1 / speed^2 [s^2/rad^2].
  double viscous = 0;                    ///< [N m s/rad]
  double gear_loss = 0;                  ///< Friction of the gear per torque of the cable [1].
  double backlash_m = 0, min_rest_m = 0;
  double winding_w_per_k = 0, housing_w_per_k = 0;  ///< To the housing, to the air.
  double winding_k_per_j = 0, housing_k_per_j = 0;  ///< 1 / heat capacity.
  double servo_gain = 0, servo_damping = 0;         ///< [1/m], [s/m]
};

struct SupplyTable {
  double voltage_v = 0, resistance_ohm = 0;
};

struct AttachmentTable {
  int body = 0;
  double p_P[3] = {};  ///< [m]
  int spot = 0;        ///< Of a cable: the number of that point among all distinct ones.
};

/// A shape that may touch another.
struct ShapeTable {
  int body = 0;
  Shape shape_P;
  double center_P[3] = {};
  double bound_m = 0;  ///< Radius of the sphere around `center_P` that holds it.
  Material material;
  int point[2] = {};            ///< Of a round one: numbers of its ends among all points;
  bool elsewhere[2] = {};       ///< another shape of the body has that one.
  const int* beside = nullptr;  ///< Of a box of the world: other boxes of it that it touches.
  int beside_count = 0;
  SeamList seams;  ///< Of a box of the world: what else it meets.

  /// Whether what it meets is to be looked at with it. Always inline: see View.
  [[gnu::always_inline]] bool IsJoined() const noexcept {
    return beside_count > 0 || seams.count > 0;
  }
};

/// Boxes of the world that are no further apart touch each other [m].
inline constexpr double kJoinedM = 1e-9;
/// So many of them, and of their points, are looked at together.
inline constexpr int kMostJoinedPairs = 32, kMostJoinedPoints = kMostJoinedPairs * 13;

/// A point that can touch a plane: a sphere's centre, a capsule's end, a box's or a hull's corner.
struct PointTable {
  double p_P[3] = {};
  double radius_m = 0;
  double static_friction[8] = {}, kinetic_friction[8] = {}, restitution[8] = {};  ///< A plane each.
};

/// One side of a contact as friction sees it.
struct FrictionSide {
  ShapeRef ref;
  int body = kWorld;  ///< As in a `ModelDef`.
  bool directed = false;
  bool by_slip = false;  ///< Anything but two constant coefficients.
  double at_rest = 0, sliding = 0;
  double inv_stribeck2 = 0;  ///< 1 / speed^2 [s^2/m^2], or 0.
  double viscous = 0;        ///< [s/m]
  double forward = 1, backward = 1, sideways = 1;
  double axis_P[3] = {};  ///< Unit vector, if directed.
};

/// What a step needs where friction is more than two coefficients a pair (friction.h).
struct FrictionTable {
  const FrictionSide* sides = nullptr;  ///< Of all shapes, then of all planes.
  int shape_count = 0;
  const int* shape_of_point = nullptr;
  CombineRule combine = CombineRule::kGeometricMean;
  const ContactFriction* law = nullptr;  ///< Of the user's, or null.
};

struct PlaneTable {
  double normal[3] = {}, tangent1[3] = {}, tangent2[3] = {};
  double offset_m = 0;   ///< normal . x of its points.
  bool upright = false;  ///< Normal and tangents are z, x and y.
};

struct ShapePairTable {
  int a = 0, b = 0;      ///< Shapes; the body of `a` is not the world.
  std::uint32_t id = 0;  ///< Of its first possible contact point.
  double static_friction = 0, kinetic_friction = 0, restitution = 0;
  std::uint32_t elsewhere = 0;  ///< Features that another pair has, too: a bit each.
};

/// Two bodies that may touch, with all pairs of their shapes; or a shape of a body and ground.
struct BodyPairTable {
  int a = 0, b = 0;  ///< b may be the world.
  int first_pair = 0, pair_count = 0;
  bool by_tree = false;    ///< b is the world, whose shapes are looked up in its tree.
  bool on_ground = false;  ///< One pair, whose second shape is a surface.
  int kept = -1;           ///< Its number among those that keep what is near (near_parts.h).
  bool joined = false;     ///< b is the world, and some boxes of it touch each other.
};

/// So many shapes of the world are looked at one after the other; of more there is a tree.
inline constexpr int kFewShapes = 8;

inline constexpr int kMaxPlanes = 8;

/// Offsets, in rows of one double a lane, of everything that a group of worlds keeps
/// (state_rows.h).
struct Layout {
#define TAUT_ROW(name, ...) int name = 0;
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  int hash_rows = 0;      ///< State and parameters, which come first.
  int snapshot_rows = 0;  ///< Those and the readings, which follow.
  int rows = 0;
};

/// A line of state_rows.h, for loops over all rows.
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

/// Snapshots and hashes take state and parameters as one piece.
constexpr bool RolesRise() {
  Role last = Role::kState;
  for (const RowInfo& row : kStateRows) {
    if (row.role < last) return false;
    last = row.role;
  }
  return true;
}
static_assert(RolesRise());

/// `Tables` without the standard library.
struct View {
  int body_count, cable_count, node_count, plane_count, body_pair_count;
  const double* bound_m;
  const CableTable* cables;
  const AttachmentTable* attachments;
  const AttachmentTable* spots;
  const AttachmentTable* nodes;
  const PlaneTable* planes;
  const int* first_point;
  const PointTable* points;
  const ShapeTable* shapes;
  const ShapePairTable* shape_pairs;
  const BodyPairTable* body_pairs;
  int world_pair_count;
  const int* first_slot;
  int slot_count;
  std::uint32_t first_pair_id;
  int pair_capacity, max_attachments, attachment_count, spot_count;
  int wheel_count, max_wheels;
  const WheelTable* wheels;
  int chain_count, span_count, slip_count, chain_link_count;
  const SlipTable* slips;
  bool along_slip;
  bool has_ground;  ///< Height fields or meshes.
  int kept_count;   ///< Pairs that keep what is near (BodyPairTable::kept).
  int motor_count, supply_count;
  const MotorTable* motors;
  const SupplyTable* supplies;
  int tree_nodes, tree_shapes;
  const TreeNode* tree;
  int world_shape_count;    ///< Without surfaces;
  const int* world_shapes;  ///< in the order of the tree's numbers.
  int touch_count;
  const TouchTable* touches;
  int touch_rod_count;
  const TouchRodTable* touch_rods;
  const FrictionTable* friction;   ///< Null: coefficients are those of the pairs.
  double floor_m;                  ///< Whoever is below falls for ever; minus infinity: nobody.
  int first_ground, ground_count;  ///< Surfaces among the shapes.
  int joint_count, joint_row_count, joint_body_count, turn_friction_count;
  const JointTable* joints;
  const JointRowTable* joint_rows;
  const int *joint_bodies, *joint_number, *hinged;
  const BlockPattern* joint_pattern;
  bool joint_loops;
  int free_chain_count;
  const int *free_chains, *free_chain_bodies;
  int motion_count;
  const MotionTable* motions;
  const MotionKnot* motion_knots;
  const int* motion_of_body;  ///< Per body, or -1; null without motions.

  // Always inline: of a function that several instruction sets emit the linker keeps any one.
  /// Contacts that one world may have at once.
  [[gnu::always_inline]] int ContactCapacity() const noexcept { return slot_count + pair_capacity; }
  /// Links of all cables to bodies, in `lanes` lanes: one an attachment, and one a rod that the
  /// cable may lie against. A lane's cable has kMostBends of those at most, each lane others.
  [[gnu::always_inline]] int CableLinkCapacity(int lanes) const noexcept {
    int count = attachment_count;
    for (int i = 0; i < touch_count; ++i) {
      const int bends = lanes * kMostBends, rods = touches[i].rod_count;
      count += bends < rods ? bends : rods;
    }
    return count;
  }
  /// Rods that one cable may come to, the most.
  [[gnu::always_inline]] int MostTouchRods() const noexcept {
    int most = 0;
    for (int i = 0; i < touch_count; ++i) {
      if (touches[i].rod_count > most) most = touches[i].rod_count;
    }
    return most;
  }
  /// Whether a program says how it moves.
  [[gnu::always_inline]] bool HasMotion(int body) const noexcept {
    return motion_count > 0 && body < body_count && motion_of_body[body] >= 0;
  }
  /// How many elements a row has.
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
        return body_pair_count;
      case Per::kKept:
        return kept_count;
      case Per::kContact:
        return ContactCapacity();
      default:
        return 1;
    }
  }
};

class Tables final : public Model {
 public:
  explicit Tables(ModelDef def) : Model(std::move(def)) {}

  /// By impulses. `body` may be the world.
  bool Moves(int body) const {
    return body < body_count && !def().bodies[static_cast<std::size_t>(body)].fixed;
  }
  /// As a program says.
  bool HasMotion(int body) const {
    return body < body_count && motion_of_body[static_cast<std::size_t>(body)] >= 0;
  }

  int body_count = 0, cable_count = 0, node_count = 0, plane_count = 0;
  std::vector<double> q_WP0;    ///< 4 per body: principal frame at t = 0.
  std::vector<double> inertia;  ///< 3 per body: principal moments [kg m^2].
  std::vector<double> bound_m;  ///< Per body and the world: reach of its shapes from its origin.
  std::vector<CableTable> cables;
  std::vector<MotorTable> motors;  ///< In the order of their cables.
  std::vector<SupplyTable> supplies;
  std::vector<AttachmentTable> attachments;
  std::vector<AttachmentTable> spots;   ///< The distinct points of bodies among them.
  int max_attachments = 0;              ///< Of one cable.
  std::vector<WheelTable> wheels;       ///< Cable after cable.
  int max_wheels = 0;                   ///< Of one cable.
  int chain_count = 0, span_count = 0;  ///< Cables with friction, and their spans.
  int chain_link_count = 0;             ///< Room for what those do to bodies.
  std::vector<double> span_rest_m;      ///< Of the spans, at the start.
  std::vector<SlipTable> slips;
  std::vector<TouchTable> touches;
  std::vector<TouchRodTable> touch_rods;
  std::vector<AttachmentTable> nodes;
  std::vector<PlaneTable> planes;
  std::vector<int> first_point;  ///< Per body, and one past the last.
  std::vector<PointTable> points;
  std::vector<ShapeTable> shapes;
  std::vector<ShapeRef> shape_refs;  ///< Per shape: what it is made from.
  std::vector<Hull> hulls;
  std::vector<Surface> surfaces;
  std::vector<ShapePairTable> shape_pairs;
  std::vector<BodyPairTable> body_pairs;
  int world_pair_count = 0;     ///< Of them, the first: `b` does not move; by `a`.
  std::vector<int> first_slot;  ///< Of a body's contacts with what does not move; one more.
  int slot_count = 0;
  int kept_count = 0;               ///< Pairs that keep what is near (BodyPairTable::kept).
  std::uint32_t first_pair_id = 0;  ///< Keys below are point * planes + plane, others of pairs.
  int pair_capacity = 0;            ///< Contacts of moving bodies that one world may have at once.
  bool along_slip = false;
  std::vector<FrictionSide> friction_sides;  ///< Of all shapes, then of all planes.
  std::vector<int> shape_of_point;
  bool friction_by_slip = false;  ///< Some side is.
  double floor_m = 0;             ///< See View.
  std::vector<TreeNode> tree;     ///< Of the world's shapes, where they are more than kFewShapes.
  int tree_shapes = 0;            ///< How many those are; 0 without a tree.
  std::vector<int> world_shapes;  ///< Without surfaces, in the order of the tree's numbers.
  std::vector<int> beside;        ///< What ShapeTable::beside points into.
  std::vector<std::vector<SeamPiece>> seams;  ///< What lists of seams point into.
  std::vector<JointTable> joints;
  std::vector<JointRowTable> joint_rows;
  int turn_friction_count = 0;    ///< Ball joints with friction.
  bool joint_loops = false;       ///< They close one, so that some of their rows may be redundant.
  std::vector<int> joint_bodies;  ///< Those that joints move, in the order of elimination, then
                                  ///< those with motions;
  std::vector<int> joint_number;  ///< per body its place there, or -1;
  std::vector<int> hinged;        ///< per body whether it is on a hinge;
  BlockPattern joint_pattern{};   ///< the blocks of their system, in what follows.
  std::vector<int> joint_slot, joint_below, joint_first_below;
  /// Bodies that joints tie to each other and not to what does not move: where each chain of them
  /// starts, one more, and all their bodies.
  std::vector<int> free_chains, free_chain_bodies;
  std::vector<MotionTable> motions;
  std::vector<MotionKnot> motion_knots;
  std::vector<int> motion_of_body;
  std::vector<double> coupling;  ///< Per cable: sum over all cables of |coupling| [1/kg].
  double largest_coupling = 0;   ///< Largest eigenvalue of the couplings [1/kg].

  /// The same tables as plain pointers, for code that is compiled for several instruction sets
  /// and must not touch the standard library.
  struct View View() const noexcept;
  Layout MakeLayout() const;
};

/// Fills pairs and slots. `shapes_of`: the shapes of each body and the world, but for the ground;
/// `ground`: surfaces among the shapes.
void LayOutPairs(Tables& tables, const std::vector<std::vector<std::size_t>>& shapes_of,
                 const std::vector<std::size_t>& ground);

/// Fills the tree of the world's shapes if they are many, and says so to the pairs with it.
void LayOutTree(Tables& tables);

/// Finds the boxes of the world that touch each other, and says so to the pairs with it.
void JoinBoxes(Tables& tables);

/// Finds the other pieces of terrain that surfaces and boxes of the world meet, and says so to the
/// pairs with those boxes. After JoinBoxes.
void JoinPieces(Tables& tables);

/// Fills floor_m.
void LayOutFloor(Tables& tables);

/// Fills friction_sides and friction_by_slip.
void LayOutFriction(Tables& tables);

/// Fills motors and supplies, and which cable has which motor.
void LayOutMotors(Tables& tables);

/// Fills all that is of cables. `frames`: of the bodies and the world.
void LayOutCables(Tables& tables, const std::vector<Frame>& frames);

/// Fills touch_rods. After the shapes.
void LayOutTouchRods(Tables& tables);

/// Room for what cables with friction do. After touch_rods.
void LayOutChainLinks(Tables& tables);

/// Fills all that is of joints. `frames`: of the bodies and the world.
void LayOutJoints(Tables& tables, const std::vector<Frame>& frames);

/// Fills all that is of motions. Before shapes and joints.
void LayOutMotions(Tables& tables);

/// Fills coupling and largest_coupling.
void CoupleCables(Tables& tables);

}  // namespace taut::sim
