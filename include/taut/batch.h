/// Many worlds of one model, stepped together: one world a SIMD lane, groups of lanes on a
/// thread pool. A world gives the same bits alone, in any lane, on any number of threads and on
/// any instruction set (docs/determinism.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "taut/cable_readings.h"
#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut {

/// A model, checked and laid out for stepping. Immutable; shared by all worlds of a batch, and by
/// any number of threads.
class Model {
 public:
  /// Checks the numbers of `def`. Nothing and diagnostics (without file positions) if one is
  /// wrong: a negative mass, NaN, an index out of range. The same if the environment variable
  /// TAUT_SIMD names no instruction set.
  static std::shared_ptr<const Model> Compile(const ModelDef& def, Diagnostics& out);

  virtual ~Model() = default;
  const ModelDef& def() const noexcept { return def_; }

 protected:
  explicit Model(ModelDef def) : def_(std::move(def)) {}
  ModelDef def_;
};

/// How many worlds share a register: 1, 2 (SSE2; NEON on AArch64; SIMD128 in
/// WebAssembly), 4 (AVX2), 8 (AVX-512).
enum class Simd { kScalar = 1, kSse2 = 2, kNeon = 2, kSimd128 = 2, kAvx2 = 4, kAvx512 = 8 };

/// The widest that this machine has, or what the environment variable TAUT_SIMD asks for
/// (scalar, sse2, neon, simd128, avx2, avx512; what the machine lacks falls back to what it has; a
/// name that is none of these counts as none, and `Model::Compile` complains about it). Any thread
/// may call it while none changes the environment.
Simd BestSimd();

class ContactFriction;  // taut/friction.h

struct BatchOptions {
  int worlds = 1;
  int threads = 1;               ///< 0: one a core.
  std::optional<Simd> simd;      ///< Nothing: `BestSimd()`, or scalar for a single world.
  int max_linear_solves = 1000;  ///< Bound of a step's work, per island; what needs more says so.
  double tolerance_m_per_s = 1e-10;  ///< Residual at which the contact solve counts as done.
  /// A law of one's own; null: the model's.
  std::shared_ptr<const ContactFriction> friction = nullptr;
};

/// What a world has to say for itself. Bits; 0 is good. Sticky until `ClearStatus`.
enum StatusBits : std::uint32_t {
  kStatusOk = 0,
  kStatusNonFinite = 1u << 0,     ///< A state is NaN or infinite: the world is frozen.
  kStatusNotConverged = 1u << 1,  ///< Contacts, stiff cables: not to the tolerance.
  /// The contact buffer is full; or, if `cable` is set, the cable touches more edges and rods than
  /// it can bend around (docs/theory/cables.md, section 6).
  kStatusContactOverflow = 1u << 2,
  /// The step is too long: for transverse motion under a cable's tension (docs/theory/cables.md,
  /// 12), for the joint forces of a body, or for its rotation about a hinge away from its center of
  /// mass (docs/theory/joints.md, section 6).
  kStatusStepTooLong = 1u << 3,
  /// A body's centre of mass is below all of a terrain that has a height field or a mesh and no
  /// plane: it has left what it stood on, and falls for ever.
  kStatusFellOff = 1u << 4,
  /// A member exceeded its strength, yield or buckling limit (taut/safety.h). Runs only: a Batch
  /// does not check these limits.
  kStatusOverloaded = 1u << 5,
};

struct WorldStatus {
  std::uint32_t bits = kStatusOk;
  double first_time_s = 0.0;  ///< When the first bit was set.
  int body = kWorld;          ///< Concerned body, or kWorld.
  int cable = -1;             ///< Concerned cable, or -1.
  /// Which height field, or, counted after them, which mesh is nearest, seen from above, to a body
  /// that fell off; else -1.
  int ground = -1;
  double residual_m_per_s = 0;  ///< Of the last solve.
  int linear_solves = 0;        ///< Of the last step: in lanes, of all islands, and of pushing out.
  /// Largest relaxation of the contact equations in the last step, as a velocity; they are relaxed
  /// if they are inconsistent around a loop of bodies (docs/theory/contact.md, section 5). At most
  /// 1e-6 m/s; 0 in most steps. `residual_m_per_s` refers to the relaxed equations.
  double contact_relaxation_m_per_s = 0;
};

/// A cable at the current time.
using CableState = CableReadings<double>;

/// All cables of the worlds that share a register: cable c of world `first_world + j` is at
/// [c * lanes + j]. Points into the batch; what was sensed is void after the next step or change.
struct CableRows : ReadingRows {
  int lanes = 1, first_world = 0;
  double* rest_length_target_m = nullptr;  ///< As `SetRestLengthTarget` sets them; may be written.
};

/// A point of a cable's path.
struct CablePoint {
  int body = kWorld;
  Vec3 position_m;  ///< In W.
  Vec3 force_n;     ///< Of the cable on the body there, in W.
};

/// A part of a cable between places where it may slip.
struct CableSpanState {
  double length_m = 0;       ///< With half of the arcs at its ends.
  double rest_length_m = 0;  ///< Those of a cable's spans add up to its own.
  double tension_n = 0;      ///< Mean over the last step.
};

struct BodyState {
  Vec3 position_m;                  ///< Of the centre of mass, in W.
  Quat orientation;                 ///< From the start's orientation (identity at t = 0), in W.
  Vec3 velocity_m_per_s;            ///< In W.
  Vec3 angular_velocity_rad_per_s;  ///< In W.
};

struct Energy {
  double kinetic_j = 0, gravity_j = 0, elastic_j = 0;
};

/// A touching point of the last step.
struct ContactState {
  int body_a = 0, body_b = kWorld;  ///< The force acts on A, its opposite on B.
  Vec3 point_m, normal;             ///< In W; normal points from B to A.
  Vec3 force_n;                     ///< On A, in W.
  double gap_m = 0;
};

/// A shape or plane of a `ModelDef`: in which of its lists, and which of them.
struct ShapeRef {
  enum class List {
    kSpheres,
    kCapsules,
    kBoxes,
    kHulls,
    kTerrainBoxes,
    kPlanes,
    kHeightFields,
    kTerrainMeshes
  };
  List list = List::kSpheres;
  int index = 0;
};

/// Two shapes of different bodies, or a shape and a part of the terrain, that are in each other.
struct Overlap {
  ShapeRef a, b;  ///< `a` is of a body that moves.
  int body_a = 0, body_b = kWorld;
  double depth_m = 0;  ///< How far they have to part to touch only, > 0.
  /// Half the thickness of the thinner one: its radius, half the smallest edge of a box, how far a
  /// hull's middle is from its nearest face; of `a` alone where `b` is a plane. Deeper than this,
  /// the way out may be the other side.
  double half_thickness_m = 0;
};

/// A joint at the current time; its forces are those of the last step.
struct JointState {
  double coordinate = 0;  ///< As `JointDef` says [rad] or [m]; 0 if it has none that is free.
  double rate = 0;        ///< [rad/s] or [m/s]
  Vec3 force_n;           ///< On its body b, at b's point, in W.
  Vec3 torque_n_m;        ///< On b, about that point, in W.
  double gap_m = 0;       ///< How far it is from what it holds; of turns, at the bodies' gyration.
  double turned_rad = 0;  ///< How far b is turned against a from where it is described, 0..pi.
};

/// A motion of a body at the current time; its force and torque are those of the last step.
struct MotionState {
  double slide_m = 0, slide_rate_m_per_s = 0;
  double turn_rad = 0, turn_rate_rad_per_s = 0;
  Vec3 force_n;       ///< That the motion has to hold its body with, in W; without its own weight
  Vec3 torque_n_m;    ///< and inertia. About the body's origin (`BodyDef::com_m`).
  double work_j = 0;  ///< That it has done on all else since the start.
};

/// Which per-world parameter `SetParameter` changes. `index`: a body, a cable or a surface.
enum class Parameter {
  kBodyMass,        ///< [kg]; inertia scales with it.
  kCableStiffness,  ///< [N/m]
  kCableDamping,    ///< [N s/m]
  kFrictionScale,   ///< Factor on all coefficients of the world; index 0. [1]
  kGravityX,
  kGravityY,
  kGravityZ,  ///< [m/s^2]; index 0.
};

/// An index that is out of range (world, group, body, cable, joint, node) is a mistake of the
/// program that calls: a line on stderr names it, and the program ends by abort().
///
/// Threads: any number may call const functions of a batch at once. A function that is not const,
/// and writing where `Cables` points to, needs the batch for itself. Batches do not know of each
/// other, even those of one model.
class Batch {
 public:
  Batch(std::shared_ptr<const Model> model, const BatchOptions& options);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  const Model& model() const noexcept;
  int worlds() const noexcept;
  int lanes() const noexcept;

  /// Advances every world by `count` steps of `step_s`. Allocates nothing.
  void Step(double step_s, int count = 1) noexcept;
  /// The same under new targets for the rest lengths of all cables of all worlds [m], cable c of
  /// world w at [w * cables + c]. The thread that steps a world sets them, where
  /// `SetRestLengthTarget` for each would keep the other threads waiting.
  void Step(double step_s, int count, std::span<const double> rest_length_targets_m) noexcept;

  /// One step of the worlds that go (`goes[world]` is not 0); the others stand still, to the bit.
  /// Costs what a step of all costs, and allocates.
  void StepSome(double step_s, std::span<const std::uint8_t> goes);

  /// Simulated time of a world [s].
  double Time(int world) const noexcept;

  // --- commands: held until changed -------------------------------------------------------
  /// The actuator's target for a cable's rest length [m].
  void SetRestLengthTarget(int world, int cable, double rest_length_m) noexcept;
  double RestLengthTarget(int world, int cable) const noexcept;
  /// The share of its supply's voltage that a cable's motor gets, -1..1; positive winds in. What is
  /// beyond counts as the end; what is not a number halts the world. From here on the motor follows
  /// no target, until `SetRestLengthTarget` says one: its servo takes over again. (Targets that are
  /// set for many cables at once change no motor's mode.) For this and the next two, a cable
  /// without a `dc_motor` is an index out of range.
  void SetDuty(int world, int cable, double duty) noexcept;
  /// Whether the motor's driver is on. Off: no current flows, whatever the duty or the target; the
  /// motor runs down by its friction. At first it is on.
  void SetMotorEnabled(int world, int cable, bool enabled) noexcept;
  MotorState Motor(int world, int cable) const noexcept;
  /// A force on a node [N], in W, for all following steps.
  void SetNodeForce(int world, int node, const Vec3& force_n) noexcept;
  Vec3 NodeForce(int world, int node) const noexcept;

  // --- observation -------------------------------------------------------------------------
  CableState Cable(int world, int cable) const noexcept;
  /// How many spans with tensions of their own a cable has: those between places with friction. Of
  /// one that has friction where it touches: the most, and all numbers of those that it does not
  /// have now, behind the first CableBends() + 1, are 0.
  int CableSpans(int cable) const noexcept;
  CableSpanState CableSpan(int world, int cable, int span) const noexcept;
  /// Of the spans that it has now, from its first end on: one more than CableBendPlaces(), or than
  /// places with friction on its way [N].
  std::vector<double> CableSpanTensions(int world, int cable) const;
  /// What friction along a cable has taken since the start [J].
  double CableFrictionLoss(int world, int cable) const noexcept;
  /// The angle about a cable's wheel, the first of which is 0, from the point before it to that
  /// behind it, with all turns, counter-clockwise about its axis [rad].
  double WheelAngle(int world, int cable, int wheel) const noexcept;
  /// Against how many edges and rods a cable lies that touches what it comes to.
  int CableBends(int world, int cable) const;
  /// Where it is bent by them, from its first end on: the middle of each arc [m], in W.
  std::vector<Vec3> CableBendPlaces(int world, int cable) const;
  /// The angle over which it lies on wheels, edges and rods, of all together [rad].
  double CableWrap(int world, int cable) const;
  /// Where a cable is held, and where it arrives at wheels, edges and rods, and leaves them: what
  /// pulls at bodies.
  std::vector<CablePoint> CablePath(int world, int cable) const;
  /// What `Cable` says, of all cables of a group of `lanes()` worlds at once, and their commands:
  /// for controllers that run over lanes. Group g holds the worlds from g * lanes() on; lanes
  /// behind the last world are there, too.
  CableRows Cables(int group) noexcept;
  /// Brings the readings that `Cables` has pointed to up to date, after steps.
  void Sense(int group) const noexcept;
  int groups() const noexcept;
  BodyState Body(int world, int body) const noexcept;
  Vec3 NodePosition(int world, int node) const noexcept;  ///< [m], in W.
  Vec3 NodeVelocity(int world, int node) const noexcept;  ///< [m/s], in W.
  JointState Joint(int world, int joint) const noexcept;
  MotionState Motion(int world, int motion) const noexcept;
  Energy TotalEnergy(int world) const noexcept;
  Vec3 Momentum(int world) const noexcept;              ///< [kg m/s], in W.
  Vec3 AngularMomentum(int world) const noexcept;       ///< About W's origin [kg m^2/s].
  std::vector<ContactState> Contacts(int world) const;  ///< Of the last step.
  /// What is in each other as the bodies are now: of every two bodies, and of every body and plane,
  /// the overlap that is deepest in half thicknesses.
  std::vector<Overlap> Overlaps(int world) const;

  // --- state -------------------------------------------------------------------------------
  /// Not for kinematic bodies, whose motion sets their state. In models with joints the next step
  /// first projects the velocities onto the joint constraints (docs/theory/joints.md, eq. 7a).
  void SetBodyState(int world, int body, const BodyState& state) noexcept;
  /// Bodies with motions go where they are at that time.
  void SetTime(int world, double time_s) noexcept;
  void SetRestLength(int world, int cable, double rest_length_m) noexcept;
  /// Returns the reason why `SetParameter` refuses a value ("must be a positive number [kg], got
  /// -1"); empty if it accepts it. Limits are those of model files. Fixed bodies have no mass
  /// and accept any value.
  std::string ParameterError(Parameter parameter, int index, double value) const;
  /// Returns false and changes nothing if `ParameterError` returns a reason.
  bool SetParameter(int world, Parameter parameter, int index, double value) noexcept;
  double GetParameter(int world, Parameter parameter, int index) const noexcept;

  /// All that determines a world's future, commands and parameters included.
  std::vector<std::uint8_t> Save(int world) const;
  /// False if `snapshot` is not of this model.
  bool Restore(int world, const std::vector<std::uint8_t>& snapshot) noexcept;
  std::uint64_t Hash(int world) const noexcept;
  WorldStatus Status(int world) const noexcept;
  void ClearStatus(int world) noexcept;
  /// Memory that one more world costs [bytes].
  std::size_t BytesPerWorld() const noexcept;

 private:
  friend struct BatchInside;  ///< For measurements (benchmarks/).
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
