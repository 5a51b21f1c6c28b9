/// Compiled model: topology and constants, in tables for stepping (`View`).
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
  int chain_link_count = 0;             ///< Room for links of their spans to bodies.
  std::vector<double> span_rest_m;      ///< Of the spans, at the start.
  std::vector<SlipTable> slips;
  std::vector<TouchTable> touches;
  std::vector<TouchRodTable> touch_rods;
  std::vector<AttachmentTable> nodes;
  std::vector<PlaneTable> planes;
  std::vector<int> first_point;  ///< Per body, and one past the last.
  std::vector<PointTable> points;
  std::vector<ShapeTable> shapes;
  std::vector<ShapeRef> shape_refs;  ///< Per shape: its definition in the model.
  std::vector<Hull> hulls;
  std::vector<Surface> surfaces;
  std::vector<ShapePairTable> shape_pairs;
  std::vector<BodyPairTable> body_pairs;
  int world_pair_count = 0;     ///< Pairs whose `b` is static; they come first, ordered by `a`.
  std::vector<int> first_slot;  ///< First slot of each body's contacts with static geometry, and
                                ///< one past the last.
  int slot_count = 0;
  int kept_count = 0;               ///< Pairs with a cache of near parts (BodyPairTable::kept).
  std::uint32_t first_pair_id = 0;  ///< Smaller keys: point * planes + plane.
  int pair_capacity = 0;            ///< Contacts of moving bodies: most at once in a world.
  bool along_slip = false;
  std::vector<FrictionSide> friction_sides;  ///< Of all shapes, then of all planes.
  std::vector<int> shape_of_point;
  bool friction_by_slip = false;  ///< Some side has friction beyond two constant coefficients.
  double floor_m = 0;             ///< See View.
  std::vector<TreeNode> tree;     ///< BVH of the world's shapes, if they are more than kFewShapes.
  int tree_shapes = 0;            ///< Number of shapes in the BVH; 0 without one.
  std::vector<int> world_shapes;  ///< Without surfaces, in the order of their numbers in the BVH.
  std::vector<int> beside;        ///< Storage of `ShapeTable::beside`.
  std::vector<std::vector<SeamPiece>> seams;  ///< Storage of the seam lists.
  std::vector<JointTable> joints;
  std::vector<JointRowTable> joint_rows;
  int turn_friction_count = 0;    ///< Ball joints with friction.
  bool joint_loops = false;       ///< They form a kinematic loop: some rows may be redundant.
  std::vector<int> joint_bodies;  ///< Bodies that joints move, in the order of elimination, then
                                  ///< kinematic bodies;
  std::vector<int> joint_number;  ///< per body its index there, or -1;
  std::vector<int> hinged;        ///< per body whether it is on a hinge;
  BlockPattern joint_pattern{};   ///< pattern of their system, stored in the following vectors.
  std::vector<int> joint_slot, joint_below, joint_first_below;
  /// Groups of bodies that joints connect to each other but not to the world, fixed or kinematic
  /// bodies: start of each group in `free_chain_bodies`, and one past the last; bodies of all
  /// groups.
  std::vector<int> free_chains, free_chain_bodies;
  std::vector<MotionTable> motions;
  std::vector<MotionKnot> motion_knots;
  std::vector<int> motion_of_body;
  std::vector<double> coupling;  ///< Per cable: sum over all cables of |coupling| [1/kg].
  double largest_coupling = 0;   ///< Largest eigenvalue of the couplings [1/kg].

  /// Returns the same tables as plain pointers, for code that is compiled for several instruction
  /// sets and must not touch the standard library.
  struct View View() const noexcept;
  Layout MakeLayout() const;
};

/// Fills pairs and slots. `shapes_of`: the shapes of each body and the world, except the ground;
/// `ground`: surfaces among the shapes.
void LayOutPairs(Tables& tables, const std::vector<std::vector<std::size_t>>& shapes_of,
                 const std::vector<std::size_t>& ground);

/// Builds the BVH of the world's shapes if they are many, and marks the pairs with it.
void LayOutTree(Tables& tables);

/// Finds the boxes of the world that touch each other, and marks the pairs with it.
void JoinBoxes(Tables& tables);

/// Finds the adjacent pieces of surfaces and terrain boxes, and marks the pairs with those boxes.
/// Call after JoinBoxes.
void JoinPieces(Tables& tables);

/// Fills floor_m.
void LayOutFloor(Tables& tables);

/// Fills friction_sides and friction_by_slip.
void LayOutFriction(Tables& tables);

/// Fills motors and supplies, and the motor of each cable.
void LayOutMotors(Tables& tables);

/// Fills all tables of cables. `frames`: of the bodies and the world.
void LayOutCables(Tables& tables, const std::vector<Frame>& frames);

/// Fills touch_rods. Call after the shapes.
void LayOutTouchRods(Tables& tables);

/// Reserves links of cables with friction. Call after LayOutTouchRods.
void LayOutChainLinks(Tables& tables);

/// Fills all tables of joints. `frames`: of the bodies and the world.
void LayOutJoints(Tables& tables, const std::vector<Frame>& frames);

/// Fills all tables of motions. Call before shapes and joints.
void LayOutMotions(Tables& tables);

/// Fills coupling and largest_coupling.
void CoupleCables(Tables& tables);

}  // namespace taut::sim
