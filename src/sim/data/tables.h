/// Compiled model: topology and constants as tables for the step (`View`).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/data/view.h"
#include "sim/geometry/hull_build.h"
#include "sim/geometry/surface_build.h"
#include "taut/world_batch.h"

namespace taut::sim {

class Tables final : public Model {
 public:
  explicit Tables(ModelDef def) : Model(std::move(def)) {}

  /// Returns whether impulses move a body. `body` may be the world.
  bool Moves(int body) const {
    return body < body_count && !def().bodies[static_cast<std::size_t>(body)].fixed;
  }
  /// Returns whether a body is kinematic.
  bool HasMotion(int body) const {
    return body < body_count && motion_of_body[static_cast<std::size_t>(body)] >= 0;
  }

  int body_count = 0, cable_count = 0, node_count = 0, plane_count = 0;
  std::vector<double> q_WP0;    ///< 4 per body: quaternion from the principal frame to W at t = 0.
  std::vector<double> inertia;  ///< 3 per body: principal moments [kg m^2].
  /// Per body and for the world: largest distance of a shape point from the origin.
  std::vector<double> bound_m;
  std::vector<CableTable> cables;
  std::vector<double> start_tension_n;  ///< Per cable: elastic tension of the described pose.
  std::vector<MotorTable> motors;       ///< In the order of the cables.
  std::vector<SupplyTable> supplies;
  std::vector<AttachmentTable> attachments;
  std::vector<AttachmentTable> spots;   ///< Points of bodies with attachments, each once.
  int max_attachments = 0;              ///< Largest number of attachments of a cable.
  std::vector<WheelTable> wheels;       ///< Sorted by cable.
  int max_wheels = 0;                   ///< Largest number of wheels of a cable.
  int chain_count = 0, span_count = 0;  ///< Numbers of cables with friction, and of their spans.
  int chain_link_count = 0;             ///< Capacity for links of their spans to bodies.
  std::vector<double> span_rest_m;      ///< Rest lengths of the spans at the start.
  std::vector<SlipTable> slips;
  std::vector<TouchTable> touches;
  std::vector<TouchRodTable> touch_rods;
  std::vector<AttachmentTable> nodes;
  std::vector<PlaneTable> planes;
  std::vector<int> first_point;  ///< Per body, with one more entry for the end.
  std::vector<PointTable> points;
  std::vector<ShapeTable> shapes;
  std::vector<ShapeRef> shape_refs;  ///< Per shape: reference to its definition in the model.
  std::vector<Hull> hulls;
  std::vector<Surface> surfaces;
  std::vector<ShapePairTable> shape_pairs;
  std::vector<WorldPairTable> world_pairs;               ///< Sorted by `a`.
  std::vector<int> colliders, first_shape, body_shapes;  ///< See View.
  std::vector<std::uint32_t> shape_pairs_before;         ///< See View.
  std::vector<ApartTable> apart;
  std::vector<int> first_apart;
  std::vector<MovingPair> moving_pairs;
  int near_capacity = 0;
  double near_m = 0;
  /// Per body: first slot for contacts with static geometry; one more entry for the end.
  std::vector<int> first_slot;
  int slot_count = 0;
  int kept_count = 0;  ///< Number of pairs with a cache of near parts (WorldPairTable::kept).
  std::uint32_t first_pair_id = 0;  ///< Smaller keys are point * planes + plane.
  /// Maximum number of simultaneous contacts between moving bodies in a world.
  int pair_capacity = 0;
  bool along_slip = false;
  std::vector<FrictionSide> friction_sides;  ///< For all shapes, then for all planes.
  std::vector<int> shape_of_point;
  /// Whether some surface has friction with more than two constant coefficients.
  bool friction_by_slip = false;
  double floor_m = 0;             ///< See View.
  std::vector<TreeNode> tree;     ///< BVH of the static shapes, if there are more than kFewShapes.
  int tree_shapes = 0;            ///< Number of shapes in the BVH; 0 without BVH.
  std::vector<int> world_shapes;  ///< Static shapes without surfaces, in BVH order.
  std::vector<int> beside;        ///< Storage of `ShapeTable::beside`.
  std::vector<std::vector<SeamPiece>> seams;  ///< Storage of the seam lists.
  std::vector<JointTable> joints;
  std::vector<JointRowTable> joint_rows;
  int turn_friction_count = 0;  ///< Ball joints with friction.
  bool joint_loops = false;  ///< Whether joints form a kinematic loop: some rows may be redundant.
  /// Bodies moved by joints in elimination order, then kinematic bodies.
  std::vector<int> joint_bodies;
  std::vector<int> joint_number;  ///< Per body: index in `joint_bodies`, or -1.
  std::vector<int> hinged;        ///< Per body: whether it is on a hinge.
  BlockPattern joint_pattern{};   ///< Pattern of the joint system, stored in the following vectors.
  std::vector<int> joint_slot, joint_below, joint_first_below;
  /// Pattern of the system of all bodies, stored in the following vectors, with the body of each
  /// number and its inverse. Empty if solve/world_primal.inl does not solve the world.
  BlockPattern world_pattern{};
  std::vector<int> world_bodies, world_number;
  std::vector<int> world_slot, world_below, world_first_below;
  /// Chains: groups of bodies that joints connect to each other, but not to the world or to fixed
  /// or kinematic bodies. Start of each group in `free_chain_bodies`, with one more entry for the
  /// end; bodies of all groups.
  std::vector<int> free_chains, free_chain_bodies;
  std::vector<MotionTable> motions;
  std::vector<MotionKnot> motion_knots;
  std::vector<int> motion_of_body;
  std::vector<double> coupling;  ///< Per cable: sum over all cables of |coupling| [1/kg].
  double largest_coupling = 0;   ///< Largest eigenvalue of the couplings [1/kg].

  /// Returns the tables as plain pointers, for code that is compiled for several instruction sets
  /// and must not use the standard library.
  struct View View() const noexcept;
  Layout MakeLayout() const;
};

/// Fills in pairs and slots. `shapes_of`: shapes of each body and of the world, without surfaces;
/// `ground`: indices of the surfaces.
void LayOutPairs(Tables& tables, const std::vector<std::vector<std::size_t>>& shapes_of,
                 const std::vector<std::size_t>& ground);

/// Builds the BVH if there are many static shapes, and marks the pairs that use it.
void LayOutTree(Tables& tables);

/// Finds static boxes that touch each other, and marks their pairs.
void JoinBoxes(Tables& tables);

/// Finds adjacent pieces of surfaces and terrain boxes, and marks the pairs with these boxes. Call
/// it after JoinBoxes.
void JoinPieces(Tables& tables);

/// Sets floor_m.
void LayOutFloor(Tables& tables);

/// Fills in friction_sides and friction_by_slip.
void LayOutFriction(Tables& tables);

/// Fills in motors and supplies, and the motor of each cable.
void LayOutMotors(Tables& tables);

/// Fills in all tables of cables. `frames`: principal frames of all bodies, and W.
void LayOutCables(Tables& tables, const std::vector<Frame>& frames);

/// Fills in touch_rods. Call it after the shapes are compiled.
void LayOutTouchRods(Tables& tables);

/// Reserves links of cables with friction. Call it after LayOutTouchRods.
void LayOutChainLinks(Tables& tables);

/// Fills in all tables of joints. `frames`: principal frames of all bodies, and W.
void LayOutJoints(Tables& tables, const std::vector<Frame>& frames);

/// Fills in all tables of motions. Call it before shapes and joints are compiled.
void LayOutMotions(Tables& tables);

/// Fills in coupling and largest_coupling.
void CoupleCables(Tables& tables);

/// Fills in world_pattern, if the model allows the solver of solve/world_primal.inl. Call it after
/// cables, joints and motions are compiled.
void OrderWorld(Tables& tables);

}  // namespace taut::sim
