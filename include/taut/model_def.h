/// Model definition: bodies, shapes, cables, joints and terrain of a robot as plain numbers, from
/// which a `Model` is compiled. The definition is read from a model file (`taut/spec.h`) or filled
/// in by a program.
///
/// SI units. World frame W: right-handed, z up, x forward, y left. Positions and directions are in
/// W, in the described pose (at t = 0, before any settling).
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

/// Stribeck friction: the coefficient decreases from its static to its kinetic value with
/// increasing sliding speed (docs/theory/friction.md, eq. 1).
struct StribeckDef {
  /// vS: speed at which half of the difference of both coefficients remains, > 0.
  double speed_m_per_s = 0.0;
  double viscous_friction_s_per_m = 0.0;  ///< Increase c of the coefficient with speed, >= 0.
  bool operator==(const StribeckDef&) const = default;
};

/// Anisotropic friction, for example of scales or skates: factors on the friction coefficients of a
/// surface, by its sliding direction (docs/theory/friction.md, eq. 3). `sideways` is normal to the
/// axis.
struct FrictionDirections {
  double forward = 1.0, backward = 1.0, sideways = 1.0;  ///< Friction factors, >= 0.
  /// Forward direction of any length in W at t = 0, fixed to the body. The zero vector (only for
  /// rods) means: from `from_m` to `to_m`.
  Vec3 axis;
  bool operator==(const FrictionDirections&) const = default;
};

/// Surface properties of a shape. `ModelDef::friction_combine` combines the properties of two
/// surfaces.
struct Material {
  double static_friction = 0.5;  ///< Coulomb coefficient of sticking contacts, >= kinetic_friction.
  double kinetic_friction = 0.5;  ///< Coulomb coefficient of sliding contacts, >= 0.
  double restitution = 0.0;       ///< Newton's coefficient of restitution, 0..1.
  std::optional<StribeckDef> stribeck = std::nullopt;           ///< None: no dependence on speed.
  std::optional<FrictionDirections> directions = std::nullopt;  ///< None: isotropic.
  bool operator==(const Material&) const = default;
};

/// Rigid body. Shapes, cables and nodes refer to its index.
struct BodyDef {
  std::string name;
  double mass_kg = 0.0;             ///< Mass, > 0; ignored if `fixed`.
  Vec3 com_m;                       ///< Center of mass in W.
  Inertia inertia_kg_m2;            ///< About the center of mass, in axes parallel to W.
  Vec3 velocity_m_per_s;            ///< Velocity of the center of mass, in W.
  Vec3 angular_velocity_rad_per_s;  ///< Angular velocity, in W.
  bool fixed = false;               ///< Anchored to the world or kinematic: forces do not move it.
  bool operator==(const BodyDef&) const = default;
};

struct SphereDef {
  std::string name;
  int body = 0;
  Vec3 center_m;
  double radius_m = 0.0;  ///< Radius, > 0.
  Material material;
  bool collides = true;
  bool operator==(const SphereDef&) const = default;
};

/// Shape of a rod (capsule): all points within `radius_m` of the segment from `from_m` to `to_m`.
struct CapsuleDef {
  std::string name;
  int body = 0;
  Vec3 from_m, to_m;
  double radius_m = 0.0;  ///< Radius, > 0.
  Material material;
  bool collides = true;
  MemberDef member = {};  ///< Section and limits of the rod as a strut.
  bool operator==(const CapsuleDef&) const = default;
};

struct BoxDef {
  std::string name;
  int body = 0;
  Vec3 center_m;
  Quat orientation;     ///< Rotation q_WBox from box axes to W.
  Vec3 half_extents_m;  ///< Half the edge lengths along the box axes, > 0.
  Material material;
  bool collides = true;
  bool operator==(const BoxDef&) const = default;
};

/// Convex polyhedron: the convex hull of its corners.
struct HullDef {
  /// Maximum number of corners; simplify finer shapes first (docs/theory/contact.md).
  static constexpr int kMostCorners = 64;
  std::string name;
  int body = 0;
  /// 4 to kMostCorners points in W, not all in one plane. Points inside the hull are ignored.
  std::vector<Vec3> corners_m;
  Material material;
  bool collides = true;
};

/// Named point of a body or of the world, for forces and position measurements.
struct NodeDef {
  std::string name;
  int body = kWorld;
  Vec3 position_m;
  bool operator==(const NodeDef&) const = default;
};

/// Damping law of a cable (docs/theory/cables.md).
enum class DampingLaw {
  kExact,    ///< Force b dl/dt; the tension is never negative (Mirletz et al. 2015, eq. 1).
  kClamped,  ///< Force b dl/dt, limited to +- the elastic force, as in NTRT.
};

/// Actuator of a cable: changes its rest length.
struct ActuatorDef {
  enum class Kind {
    kNone,     ///< Fixed rest length; commands are ignored.
    kIdeal,    ///< The rest length equals the command immediately.
    kLimited,  ///< The rest length follows the command within the limits below.
    kDcMotor,  ///< A `dc_motor`; `min_rest_length_m` is the only limit below that applies.
  };
  Kind kind = Kind::kNone;
  double max_speed_m_per_s = 0.0;  ///< Limit of the rest length's speed, > 0; infinity: none.
  /// Limit of the rest length's acceleration, > 0; infinity: none.
  double max_acceleration_m_per_s2 = 0.0;
  /// Tension above which the actuator does not wind in, > 0; infinity: none.
  double max_force_n = 0.0;
  double min_rest_length_m = 0.0;  ///< Smallest rest length, >= 0.
  double min_length_m = 0.0;  ///< Cable length below which the actuator does not wind in, >= 0.
  std::optional<DcMotorDef> dc_motor;  ///< Present only with kDcMotor.
  bool operator==(const ActuatorDef&) const = default;
};

/// Wheel (pulley or drum): cylinder on a body around which a cable bends (docs/theory/cables.md,
/// section 4). The cylinder is infinitely long and has no mass.
struct WheelDef {
  Vec3 axis;              ///< Unit vector in W, in the described pose.
  double radius_m = 0.0;  ///< Radius to the center line of the cable, > 0.
  /// Direction of the cable around the wheel, seen with the axis toward the viewer.
  bool counterclockwise = false;
  /// Full turns in addition to the smallest wrap between the adjacent points, >= 0.
  int turns = 0;
  bool operator==(const WheelDef&) const = default;
};

/// Attachment: end point of a cable, point through which it slides, or center of a wheel.
struct AttachmentDef {
  int body = kWorld;
  Vec3 position_m;
  double friction = 0.0;               ///< Capstan friction coefficient mu, >= 0; 0 at the ends.
  std::optional<WheelDef> wheel = {};  ///< Not allowed at the ends.
  bool operator==(const AttachmentDef&) const = default;
};

/// Obstacles of cable wrapping: geometry around which a cable bends (docs/theory/cables.md, section
/// 6).
enum class CableTouches {
  kNone,
  kTerrain,  ///< Edges of terrain boxes, height fields and meshes.
  kRods,     ///< Colliding rods, except on the bodies at the ends of the cable.
  kAll
};

/// Cable: tension-only spring and damper through two or more attachments, with the same tension
/// everywhere. Friction at attachments divides it into spans with different tensions
/// (docs/theory/cables.md, section 5); the actuator of such a cable winds at the first attachment.
struct CableDef {
  static constexpr int kMostSpans = 16;  ///< Maximum number of spans separated by friction.
  /// Maximum number of edges and rods that bend the cable at one time.
  static constexpr int kMostBends = 8;
  std::string name;
  std::vector<AttachmentDef> attachments;  ///< At least 2, in order along the cable.
  double stiffness_n_per_m = 0.0;          ///< Stiffness k > 0.
  double damping_n_s_per_m = 0.0;          ///< Damping coefficient b >= 0.
  double rest_length_m = 0.0;              ///< Rest length L > 0 at t = 0.
  DampingLaw damping_law = DampingLaw::kExact;
  ActuatorDef actuator;
  /// Obstacles of the cable. All except kNone require two attachments without wheels, and
  /// `radius_m` > 0.
  CableTouches touches = CableTouches::kNone;
  double radius_m = 0.0;  ///< Cable radius, > 0 unless `touches` is kNone.
  /// Friction coefficient mu at obstacles, along and across the cable, >= 0. Not with a `dc_motor`.
  double touch_friction = 0.0;
  MemberDef member = {};
  bool operator==(const CableDef&) const = default;
};

/// Returns whether friction at attachments divides a cable into spans with different tensions.
bool HasFriction(const CableDef& cable);

/// Half space, such as level or inclined ground. The half space is solid on the side opposite to
/// `normal`.
struct PlaneDef {
  std::string name;
  Vec3 normal{0.0, 0.0, 1.0};  ///< Unit vector in W.
  Vec3 point_m;                ///< Any point of the surface.
  Material material;
};

/// Fixed box, such as a wall or a step.
struct TerrainBoxDef {
  std::string name;
  Vec3 center_m;
  Quat orientation;  ///< Rotation q_WBox from box axes to W.
  Vec3 half_extents_m;
  Material material;
};

/// Height field: ground heights on a rectangular grid. Each square cell has two triangles. The
/// ground is solid below them and ends at the sides of the rectangle.
struct HeightFieldDef {
  /// Diagonal that divides a cell into triangles. Corner (i, j) is corner i along x and j along y.
  enum class Split {
    kSame,         ///< The diagonal from corner (i, j) to corner (i + 1, j + 1).
    kAlternating,  ///< As kSame where i + j is even, otherwise the other diagonal.
    kShortest,     ///< The diagonal with the smaller height difference.
  };
  std::string name;
  int columns = 0, rows = 0;     ///< Numbers of corners along x and y, >= 2.
  double cell_m = 0.0;           ///< Side of a cell, > 0.
  Vec3 origin_m;                 ///< Center of the rectangle; its z is added to all heights.
  std::vector<double> height_m;  ///< columns * rows values; x changes fastest.
  Split split = Split::kAlternating;
  Material material;
};

/// Terrain mesh: ground of any shape, made of triangles.
struct TerrainMeshDef {
  std::string name;
  std::vector<Vec3> corners_m;  ///< Corners, in W.
  /// Corner indices, counterclockwise seen from outside.
  std::vector<std::array<int, 3>> triangles;
  bool solid = true;  ///< True: closed surface around a solid. False: thin sheet with two sides.
  Material material;
};

/// Rule for the coefficient of two touching materials.
enum class CombineRule { kProduct, kGeometricMean, kMinimum, kMaximum };

/// Directions of friction forces at a contact.
enum class FrictionLaw {
  kCone,  ///< All tangential directions: the exact Coulomb cone.
  /// Only the direction of the sliding velocity that would result without contact, as by default in
  /// Bullet and NTRT. A robot may creep sideways.
  kAlongSlip,
};

/// All data for the compilation of a `Model`. Indices in these structs refer to these vectors.
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

  /// Names of parts of the experiment file that act on this model (`ActingParts`); empty for a
  /// model file. A `WorldBatch` ignores these parts, and `Model::Compile` warns about them.
  std::string experiment_parts;
};

/// Returns the pairs of bodies that cannot collide, lower index first: the pairs in `apart` and
/// bodies connected by joints.
std::set<std::pair<int, int>> KeptApart(const ModelDef& def);

}  // namespace taut
