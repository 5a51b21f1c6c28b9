/// Model definition: bodies, shapes, cables, joints and terrain of a robot as plain numbers, from
/// which a `Model` is compiled. A model file (`taut/spec.h`) is one way to fill it; a program may
/// fill it directly.
///
/// SI units. World frame W: right-handed, z up, x forward, y left. All quantities are given in W at
/// the time t = 0, as described (before any settling).
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

/// Stribeck friction: the coefficient falls from its static to its kinetic value as the sliding
/// speed rises (docs/theory/friction.md, eq. 1).
struct StribeckDef {
  /// vS: speed at which half of static minus kinetic friction is gone, > 0.
  double speed_m_per_s = 0.0;
  double viscous_friction_s_per_m = 0.0;  ///< c: increase of the coefficient per speed, >= 0.
  bool operator==(const StribeckDef&) const = default;
};

/// Anisotropic friction, as of scales or skates: factors on a surface's friction coefficients by
/// the direction in which it slides on the other surface (docs/theory/friction.md, eq. 3).
/// `sideways` is for sliding at right angles to the axis.
struct FrictionDirections {
  double forward = 1.0, backward = 1.0, sideways = 1.0;  ///< >= 0.
  Vec3 axis;  ///< Forward direction, of any length, in W at t = 0; turns with the body. Zero, for
              ///< rods only: along the rod, from `from_m` to `to_m`.
  bool operator==(const FrictionDirections&) const = default;
};

/// Surface properties of a shape. `ModelDef::friction_combine` combines the properties of two
/// surfaces.
struct Material {
  double static_friction = 0.5;   ///< Coulomb coefficient while sticking, >= kinetic_friction.
  double kinetic_friction = 0.5;  ///< Coulomb coefficient while sliding, >= 0.
  double restitution = 0.0;       ///< Newton's coefficient, 0..1.
  std::optional<StribeckDef> stribeck = std::nullopt;           ///< None: independent of speed.
  std::optional<FrictionDirections> directions = std::nullopt;  ///< None: isotropic.
  bool operator==(const Material&) const = default;
};

/// A rigid body. Shapes, cables and nodes refer to it by its index.
struct BodyDef {
  std::string name;
  double mass_kg = 0.0;             ///< > 0 (ignored if `fixed`).
  Vec3 com_m;                       ///< Center of mass in W.
  Inertia inertia_kg_m2;            ///< About the center of mass, in axes parallel to W.
  Vec3 velocity_m_per_s;            ///< Of the center of mass, in W.
  Vec3 angular_velocity_rad_per_s;  ///< In W.
  bool fixed = false;               ///< Anchored to the world: does not move.
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

/// Shape of a rod: all points within `radius_m` of the segment from `from_m` to `to_m`.
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

/// Convex polyhedron: the convex hull of its corners.
struct HullDef {
  /// Largest number of corners; simplify finer shapes first (docs/theory/contact.md).
  static constexpr int kMostCorners = 64;
  std::string name;
  int body = 0;
  std::vector<Vec3>
      corners_m;  ///< 4 to kMostCorners, not all in one plane; points inside the hull are ignored.
  Material material;
  bool collides = true;
};

/// Named point of a body or of the world, where forces act and positions are measured.
struct NodeDef {
  std::string name;
  int body = kWorld;
  Vec3 position_m;
  bool operator==(const NodeDef&) const = default;
};

/// Damping law of a cable (docs/theory/cables.md).
enum class DampingLaw {
  kExact,    ///< b dl/dt, with a tension never below 0 (paper eq. 1).
  kClamped,  ///< b dl/dt, limited to +- the elastic force, as in NTRT.
};

/// Actuator of a cable: changes its rest length.
struct ActuatorDef {
  enum class Kind {
    kNone,     ///< Fixed rest length; commands are ignored.
    kIdeal,    ///< The rest length equals the command immediately.
    kLimited,  ///< Follows the command within the limits below.
    kDcMotor,  ///< The motor `dc_motor`. Only `min_rest_length_m` of the limits applies to it.
  };
  Kind kind = Kind::kNone;
  double max_speed_m_per_s = 0.0;          ///< Of the rest length, > 0; infinity: no limit.
  double max_acceleration_m_per_s2 = 0.0;  ///< Of the rest length, > 0; infinity: no limit.
  double max_force_n = 0.0;            ///< Winds in only up to this tension, > 0; may be infinity.
  double min_rest_length_m = 0.0;      ///< >= 0.
  double min_length_m = 0.0;           ///< Winds in only while the cable is longer than this, >= 0.
  std::optional<DcMotorDef> dc_motor;  ///< Set if and only if the kind is kDcMotor.
  bool operator==(const ActuatorDef&) const = default;
};

/// Wheel (pulley or drum): cylinder of a body that a cable goes around (docs/theory/cables.md,
/// section 4). It has no ends and no mass.
struct WheelDef {
  Vec3 axis;              ///< Unit vector in W, in the described pose.
  double radius_m = 0.0;  ///< To the middle of the cable, > 0.
  /// Direction of the cable around the wheel, seen with the axis toward the viewer.
  bool counterclockwise = false;
  int turns = 0;  ///< Full turns in addition to the wrap that the adjacent points require, >= 0.
  bool operator==(const WheelDef&) const = default;
};

/// Attachment: point of a body where a cable ends or slides through, or the center of a wheel.
struct AttachmentDef {
  int body = kWorld;
  Vec3 position_m;
  double friction = 0.0;               ///< mu of capstan friction, >= 0; 0 at the ends.
  std::optional<WheelDef> wheel = {};  ///< Not at the ends.
  bool operator==(const AttachmentDef&) const = default;
};

/// Obstacles of cable wrapping: geometry along which a cable bends instead of passing through it
/// (docs/theory/cables.md, section 6).
enum class CableTouches {
  kNone,
  kTerrain,  ///< Edges of the terrain's boxes, height fields and meshes.
  kRods,     ///< Capsules that collide, except on bodies at which the cable ends.
  kAll
};

/// Cable: tension-only spring and damper through two or more attachments. It has one tension. With
/// friction at attachments, each span between those has a separate tension (docs/theory/cables.md,
/// section 5), and the actuator winds at the first attachment.
struct CableDef {
  static constexpr int kMostSpans = 16;  ///< Largest number of spans that friction separates.
  /// Largest number of edges and rods that it touches at once.
  static constexpr int kMostBends = 8;
  std::string name;
  std::vector<AttachmentDef> attachments;  ///< >= 2, in order along the cable.
  double stiffness_n_per_m = 0.0;          ///< k > 0.
  double damping_n_s_per_m = 0.0;          ///< b >= 0.
  double rest_length_m = 0.0;              ///< L > 0 at t = 0.
  DampingLaw damping_law = DampingLaw::kExact;
  ActuatorDef actuator;
  CableTouches touches = CableTouches::kNone;  ///< Others require two attachments without wheels
  double radius_m = 0.0;                       ///< and a radius > 0.
  /// mu at obstacles, along and across the cable, >= 0; not with a `dc_motor`.
  double touch_friction = 0.0;
  MemberDef member = {};
  bool operator==(const CableDef&) const = default;
};

/// Returns whether friction at attachments separates a cable into spans with different tensions.
bool HasFriction(const CableDef& cable);

/// Half space, such as level or inclined ground. The solid side is opposite to `normal`.
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
  Quat orientation;  ///< q_WBox.
  Vec3 half_extents_m;
  Material material;
};

/// Height field: heights at the corners of square cells over a rectangle. Each cell has two
/// triangles. It is solid below; outside the rectangle there is no ground.
struct HeightFieldDef {
  /// Diagonal along which a cell is split. Corner (i, j) is the i-th along x in the j-th row along
  /// y.
  enum class Split {
    kSame,         ///< From (i, j) to (i + 1, j + 1).
    kAlternating,  ///< Likewise where i + j is even, else the other diagonal.
    kShortest,     ///< The diagonal with the smaller difference in height between its ends.
  };
  std::string name;
  int columns = 0, rows = 0;     ///< Corners along x and y, >= 2.
  double cell_m = 0.0;           ///< Side of a cell, > 0.
  Vec3 origin_m;                 ///< Center of the rectangle; its z is added to all heights.
  std::vector<double> height_m;  ///< columns * rows, x running fastest.
  Split split = Split::kAlternating;
  Material material;
};

/// Terrain mesh: ground of any shape, as triangles.
struct TerrainMeshDef {
  std::string name;
  std::vector<Vec3> corners_m;  ///< In W.
  /// Corner indices, counterclockwise seen from outside.
  std::vector<std::array<int, 3>> triangles;
  bool solid = true;  ///< Closed surface with an inside; false: thin sheet with two sides.
  Material material;
};

/// Rule that combines the coefficients of two touching materials.
enum class CombineRule { kProduct, kGeometricMean, kMinimum, kMaximum };

/// Directions in which friction acts at a contact.
enum class FrictionLaw {
  kCone,       ///< Both tangential directions: the exact Coulomb cone.
  kAlongSlip,  ///< Only along the sliding velocity that would result without contact, as by default
               ///< in Bullet (and so in NTRT). Lets a robot creep sideways.
};

/// All data from which a `Model` is compiled. Indices are positions in these vectors.
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

  /// Parts of the experiment file from which this model was read (`ActingParts`); empty for a model
  /// file. A `WorldBatch` ignores them, and `Model::Compile` warns about it.
  std::string experiment_parts;
};

/// Returns pairs of bodies without contacts between them, lower index first: pairs of `apart` and
/// pairs that are connected by joints.
std::set<std::pair<int, int>> KeptApart(const ModelDef& def);

}  // namespace taut
