/// What a robot and its surroundings are made of, in numbers: the plain description that a
/// `Model` is compiled from. A model file (`taut/spec.h`) is one way to fill it; a program may
/// fill it directly.
///
/// SI units. World frame W: right-handed, z up, x forward, y left. Everything is given in W at
/// the moment t = 0, as described (before any settling).
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "taut/dc_motor.h"
#include "taut/joint_def.h"
#include "taut/member_def.h"
#include "taut/motion_def.h"
#include "taut/types.h"

namespace taut {

/// Friction that falls from the static to the kinetic coefficient while the speed of sliding rises
/// (docs/theory/friction.md, eq. 1).
struct StribeckDef {
  double speed_m_per_s = 0.0;  ///< At which half of what friction at rest has more is gone, > 0.
  double viscous_friction_s_per_m = 0.0;  ///< What the coefficient gains per speed, >= 0.
  bool operator==(const StribeckDef&) const = default;
};

/// Factors on a surface's coefficients of friction, by the direction in which it slides over what
/// it touches: scales, skates (docs/theory/friction.md, eq. 3). At right angles to the axis it
/// slides sideways.
struct FrictionDirections {
  double forward = 1.0, backward = 1.0, sideways = 1.0;  ///< >= 0.
  Vec3 axis;  ///< Where forward is, of any length, in W at t = 0; turns with the body. Zero, for
              ///< rods only: along the rod, `from_m` to `to_m`.
  bool operator==(const FrictionDirections&) const = default;
};

/// Surface properties of a shape. How two of them combine is `ModelDef::friction_combine`.
struct Material {
  double static_friction = 0.5;   ///< Coulomb coefficient while sticking, >= kinetic_friction.
  double kinetic_friction = 0.5;  ///< Coulomb coefficient while sliding, >= 0.
  double restitution = 0.0;       ///< Newton's coefficient, 0..1.
  std::optional<StribeckDef> stribeck = std::nullopt;           ///< None: the same at any speed.
  std::optional<FrictionDirections> directions = std::nullopt;  ///< None: the same in all.
  bool operator==(const Material&) const = default;
};

/// A rigid body. Shapes, cables and nodes refer to it by its index.
struct BodyDef {
  std::string name;
  double mass_kg = 0.0;             ///< > 0 (ignored if `fixed`).
  Vec3 com_m;                       ///< Centre of mass in W.
  Inertia inertia_kg_m2;            ///< About the centre of mass, in axes parallel to W.
  Vec3 velocity_m_per_s;            ///< Of the centre of mass, in W.
  Vec3 angular_velocity_rad_per_s;  ///< In W.
  bool fixed = false;               ///< Does not move: anchored to the world.
  bool operator==(const BodyDef&) const = default;
};

struct SphereDef {
  std::string name;
  int body = 0;
  Vec3 center_m;
  double radius_m = 0.0;  ///< > 0.
  Material material;
  bool collides = true;
  bool operator==(const SphereDef&) const = default;
};

/// A rod's shape: all points within `radius_m` of the segment from..to.
struct CapsuleDef {
  std::string name;
  int body = 0;
  Vec3 from_m, to_m;
  double radius_m = 0.0;  ///< > 0.
  Material material;
  bool collides = true;
  MemberDef member = {};  ///< As a strut.
  bool operator==(const CapsuleDef&) const = default;
};

struct BoxDef {
  std::string name;
  int body = 0;
  Vec3 center_m;
  Quat orientation;     ///< q_WBox.
  Vec3 half_extents_m;  ///< Along the box axes, > 0.
  Material material;
  bool collides = true;
  bool operator==(const BoxDef&) const = default;
};

/// A convex solid with flat faces: what its corners span.
struct HullDef {
  /// No more count; a finer form is to be thinned out before (docs/theory/contact.md).
  static constexpr int kMostCorners = 64;
  std::string name;
  int body = 0;
  std::vector<Vec3>
      corners_m;  ///< 4 to kMostCorners, not all in one plane; what is inside does not count.
  Material material;
  bool collides = true;
};

/// A named point of a body (or of the world): where forces are applied and positions measured.
struct NodeDef {
  std::string name;
  int body = kWorld;
  Vec3 position_m;
  bool operator==(const NodeDef&) const = default;
};

/// How a cable's damper acts (docs/theory/cables.md).
enum class DampingLaw {
  kExact,    ///< b dl/dt, tension never below 0 (paper eq. 1).
  kClamped,  ///< b dl/dt limited to +- the elastic force, as NTRT does.
};

/// What changes a cable's rest length.
struct ActuatorDef {
  enum class Kind {
    kNone,     ///< Rest length fixed; commands are ignored.
    kIdeal,    ///< The rest length is what was commanded, at once.
    kLimited,  ///< Follows the command within the limits below.
    kDcMotor,  ///< Is a motor: `dc_motor`. Of the limits, only `min_rest_length_m` is one of it.
  };
  Kind kind = Kind::kNone;
  double max_speed_m_per_s = 0.0;          ///< Of the rest length, > 0; infinity: no limit.
  double max_acceleration_m_per_s2 = 0.0;  ///< Of the rest length, > 0; infinity: no limit.
  double max_force_n = 0.0;                ///< Never winds past this tension, > 0; may be infinity.
  double min_rest_length_m = 0.0;          ///< >= 0.
  double min_length_m = 0.0;               ///< Does not wind in while the cable is shorter, >= 0.
  std::optional<DcMotorDef> dc_motor;      ///< There if and only if it is one.
  bool operator==(const ActuatorDef&) const = default;
};

/// A cylinder of a body that a cable goes round: a pulley, a drum (docs/theory/cables.md, section
/// 4). It has no ends, and no mass of its own.
struct WheelDef {
  Vec3 axis;                      ///< Unit vector in W, as the body is described.
  double radius_m = 0.0;          ///< Of the cable's middle, > 0.
  bool counterclockwise = false;  ///< How the cable goes round it, seen with the axis towards one.
  int turns = 0;                  ///< Whole ones on top of what the points beside it ask for, >= 0.
  bool operator==(const WheelDef&) const = default;
};

/// Where a cable is fixed to, or slides through, a body; or the middle of a wheel.
struct AttachmentDef {
  int body = kWorld;
  Vec3 position_m;
  double friction = 0.0;               ///< mu of the capstan's law, >= 0; 0 at the ends.
  std::optional<WheelDef> wheel = {};  ///< Not at the ends.
  bool operator==(const AttachmentDef&) const = default;
};

/// What a cable does not pass through, but comes to lie against (docs/theory/cables.md, section 6).
enum class CableTouches {
  kNone,
  kTerrain,  ///< Edges of boxes, height fields and meshes of the terrain.
  kRods,     ///< Capsules of bodies that collide, but for those on which it ends.
  kAll
};

/// A tension-only spring and damper through two or more attachments. One tension, but for friction
/// at attachments: then each span between those has its own (docs/theory/cables.md, section 5), and
/// the actuator winds at the first attachment.
struct CableDef {
  static constexpr int kMostSpans = 16;  ///< That friction parts.
  static constexpr int kMostBends = 8;   ///< Edges and rods that it touches at once.
  std::string name;
  std::vector<AttachmentDef> attachments;  ///< >= 2, in order along the cable.
  double stiffness_n_per_m = 0.0;          ///< k > 0.
  double damping_n_s_per_m = 0.0;          ///< b >= 0.
  double rest_length_m = 0.0;              ///< L > 0 at t = 0.
  DampingLaw damping_law = DampingLaw::kExact;
  ActuatorDef actuator;
  CableTouches touches = CableTouches::kNone;  ///< Others only with two plain attachments,
  double radius_m = 0.0;                       ///< and with a radius > 0.
  double touch_friction = 0.0;  ///< mu where it touches, along the cable and across it, >= 0; not
                                ///< of one that a direct-current motor winds.
  MemberDef member = {};
  bool operator==(const CableDef&) const = default;
};

/// Whether friction parts it into spans.
bool HasFriction(const CableDef& cable);

/// A half space: the ground, a slope. The solid side is opposite to `normal`.
struct PlaneDef {
  std::string name;
  Vec3 normal{0.0, 0.0, 1.0};  ///< Unit vector in W.
  Vec3 point_m;                ///< Any point of the surface.
  Material material;
};

/// A fixed box: a wall, a step.
struct TerrainBoxDef {
  std::string name;
  Vec3 center_m;
  Quat orientation;  ///< q_WBox.
  Vec3 half_extents_m;
  Material material;
};

/// Ground above a rectangle: heights at the corners of square cells, each of which is two
/// triangles. Below it is solid. Outside of the rectangle there is nothing.
struct HeightFieldDef {
  /// Along which diagonal a cell is split. Corner (i, j) is the i-th along x of the j-th along y.
  enum class Split {
    kSame,         ///< From (i, j) to (i + 1, j + 1).
    kAlternating,  ///< So where i + j is even, else across.
    kShortest,     ///< That of the two whose ends differ less in height.
  };
  std::string name;
  int columns = 0, rows = 0;     ///< Corners along x and y, >= 2.
  double cell_m = 0.0;           ///< Side of a cell, > 0.
  Vec3 origin_m;                 ///< Middle of the rectangle; its z is added to all heights.
  std::vector<double> height_m;  ///< columns * rows, x running fastest.
  Split split = Split::kAlternating;
  Material material;
};

/// Ground of any form.
struct TerrainMeshDef {
  std::string name;
  std::vector<Vec3> corners_m;                ///< In W.
  std::vector<std::array<int, 3>> triangles;  ///< Corners, counter-clockwise seen from outside.
  bool solid = true;  ///< Closed: there is an inside. Else a thin sheet with two sides.
  Material material;
};

/// How the coefficients of two touching materials become one.
enum class CombineRule { kProduct, kGeometricMean, kMinimum, kMaximum };

/// In which directions friction acts at a contact.
enum class FrictionLaw {
  kCone,       ///< Both tangential directions: the exact Coulomb cone.
  kAlongSlip,  ///< Only along the sliding velocity that would result without contact, as Bullet
               ///< does by default (and so NTRT). Lets a robot creep sideways.
};

/// Everything a `Model` is compiled from. Indices are positions in these vectors.
struct ModelDef {
  std::string name;
  std::vector<BodyDef> bodies;
  std::vector<SphereDef> spheres;
  std::vector<CapsuleDef> capsules;
  std::vector<BoxDef> boxes;
  std::vector<HullDef> hulls;
  std::vector<NodeDef> nodes;
  std::vector<CableDef> cables;
  std::vector<JointDef> joints;
  std::vector<ApartDef> apart;
  std::vector<MotionDef> motions;
  std::vector<PlaneDef> planes;
  std::vector<TerrainBoxDef> terrain_boxes;
  std::vector<HeightFieldDef> height_fields;
  std::vector<TerrainMeshDef> terrain_meshes;

  Vec3 gravity_m_per_s2{0.0, 0.0, -9.81};
  CombineRule friction_combine = CombineRule::kGeometricMean;
  CombineRule restitution_combine = CombineRule::kMaximum;
  FrictionLaw friction_law = FrictionLaw::kCone;
};

/// Bodies that never touch each other, the lower index first: `apart`, and what joints join.
std::set<std::pair<int, int>> KeptApart(const ModelDef& def);

}  // namespace taut
