/// Vectorized simulation of many worlds of one model, without controllers and events. For
/// experiments use `Simulation` (taut/simulation.h). Each SIMD lane contains one world; a thread
/// pool steps the groups of lanes. Results of a world are bit-identical for any number of worlds,
/// lane, number of threads and instruction set (docs/determinism.md).
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

/// Compiled model: checked and laid out for stepping. Immutable; shared by all worlds of a batch
/// and by any number of threads.
class Model {
 public:
  /// Checks the numbers of `def` and compiles it. Returns null and adds diagnostics (without file
  /// positions) if a number is invalid (a negative mass, NaN, an index out of range), or if the
  /// environment variable TAUT_SIMD does not name an instruction set.
  /// Warns if `def` belongs to an experiment with controllers, events or a settled start, which a
  /// `WorldBatch` ignores.
  static std::shared_ptr<const Model> Compile(const ModelDef& def, Diagnostics& out);
  /// Same as `Compile`, without the warning about controllers and events, for programs that run
  /// them themselves.
  static std::shared_ptr<const Model> CompileForExperiment(const ModelDef& def, Diagnostics& out);

  virtual ~Model() = default;
  const ModelDef& def() const noexcept { return def_; }

 protected:
  explicit Model(ModelDef def) : def_(std::move(def)) {}
  ModelDef def_;
};

/// Instruction set. The value is the number of worlds per SIMD register: 1, 2 (SSE2; NEON on
/// AArch64; SIMD128 in WebAssembly), 4 (AVX2), 8 (AVX-512).
enum class Simd { kScalar = 1, kSse2 = 2, kNeon = 2, kSimd128 = 2, kAvx2 = 4, kAvx512 = 8 };

/// Returns the widest instruction set of this machine, limited by the environment variable
/// TAUT_SIMD (scalar, sse2, neon, simd128, avx2, avx512). An instruction set that the machine lacks
/// falls back to a supported one. Other values are ignored here; `Model::Compile` reports them as
/// errors. Any thread may call this while no thread changes the environment.
Simd BestSimd();

class ContactFriction;  // taut/friction.h

struct WorldBatchOptions {
  int worlds = 1;
  int threads = 1;                ///< 0: one per core.
  std::optional<Simd> simd = {};  ///< Absent: `BestSimd()`, or scalar for a single world.
  /// Limit of linear solves per island and step; an island that needs more sets
  /// `kStatusNotConverged`.
  int max_linear_solves = 1000;
  double tolerance_m_per_s = 1e-10;  ///< Residual at which the contact solve ends.
  /// Custom friction law; null: the model's.
  std::shared_ptr<const ContactFriction> friction = nullptr;
};

/// Returns the instruction set of a batch with these options; its value is the number of lanes.
Simd SimdOf(const WorldBatchOptions& options);

/// Condition bits of a world; 0: no problem. Bits stay set until `ClearStatus`.
enum StatusBits : std::uint32_t {
  kStatusOk = 0,
  kStatusNonFinite = 1u << 0,     ///< A state is NaN or infinite: the world is frozen.
  kStatusNotConverged = 1u << 1,  ///< Contacts or stiff cables were not solved to the tolerance.
  /// The contact buffer is full; or, if `cable` is set, the cable touches more edges and rods than
  /// it can bend around (docs/theory/cables.md, section 6).
  kStatusContactOverflow = 1u << 2,
  /// The step is too long: for transverse motion under a cable's tension (docs/theory/cables.md,
  /// eq. 12), for the substeps of stiff cables (eq. 12i), for a bend that a turning rod moves along its
  /// axis (section 6), for the joint forces of a body, or for its rotation about a hinge away from its
  /// center of mass (docs/theory/joints.md, section 6).
  kStatusStepTooLong = 1u << 3,
  /// A body's center of mass is below the whole terrain, which has a height field or a mesh and no
  /// plane: the body left the terrain and falls forever.
  kStatusFellOff = 1u << 4,
  /// A member exceeded its strength, yield or buckling limit (taut/safety.h). Runs only: a
  /// WorldBatch does not check these limits.
  kStatusOverloaded = 1u << 5,
};

struct WorldStatus {
  std::uint32_t bits = kStatusOk;
  double first_time_s = 0.0;  ///< When the first bit was set.
  int body = kWorld;          ///< Affected body, or kWorld.
  int cable = -1;             ///< Affected cable, or -1.
  /// For a body that fell off: index of the height field or mesh that is nearest, seen from above;
  /// meshes are numbered after the height fields. Otherwise -1.
  int ground = -1;
  double residual_m_per_s = 0;  ///< Of the last solve.
  /// Linear solves of the last step: in lanes, over all islands, position projection included.
  int linear_solves = 0;
  /// Largest relaxation of the contact equations in the last step, as a velocity; they are relaxed
  /// if they are inconsistent around a loop of bodies (docs/theory/contact.md, section 5). At most
  /// 1e-6 m/s; 0 in most steps. `residual_m_per_s` refers to the relaxed equations.
  double contact_relaxation_m_per_s = 0;
};

/// State of a cable at the current time.
using CableState = CableReadings<double>;

/// All cables of the worlds that share a SIMD register: cable c of world `first_world + j` is at
/// [c * lanes + j]. The pointers refer to memory of the batch. After a step or change, call
/// `WorldBatch::Sense` to update the readings.
struct CableRows : ReadingRows {
  int lanes = 1, first_world = 0;
  double* rest_length_target_m = nullptr;  ///< As in `SetRestLengthTarget`; may be written.
};

/// Point of a cable's path.
struct CablePoint {
  int body = kWorld;
  Vec3 position_m;  ///< In W.
  Vec3 force_n;     ///< Force of the cable on the body at this point, in W.
};

/// State of a cable span, the part between two places with friction or an end.
struct CableSpanState {
  double length_m = 0;       ///< Includes half of the arcs at its ends.
  double rest_length_m = 0;  ///< The spans' rest lengths add up to the cable's.
  double tension_n = 0;      ///< Mean over the last step.
};

struct BodyState {
  Vec3 position_m;        ///< Of the center of mass, in W.
  Quat orientation;       ///< Rotation from the initial orientation (identity at t = 0), in W.
  Vec3 velocity_m_per_s;  ///< In W.
  Vec3 angular_velocity_rad_per_s;  ///< In W.
};

struct Energy {
  double kinetic_j = 0, gravity_j = 0, elastic_j = 0;
};

/// Contact point of the last step.
struct ContactState {
  int body_a = 0, body_b = kWorld;  ///< The force acts on A, its opposite on B.
  Vec3 point_m, normal;             ///< In W; normal points from B to A.
  Vec3 force_n;                     ///< On A, in W.
  double gap_m = 0;
};

/// Reference to a shape or plane of a `ModelDef`: list and index in the list.
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

/// Interpenetration of two shapes of different bodies, or of a shape and a part of the terrain.
struct Overlap {
  ShapeRef a, b;  ///< `a` belongs to a moving body.
  int body_a = 0, body_b = kWorld;
  double depth_m = 0;  ///< Penetration depth, > 0.
  /// Half the thickness of the thinner shape: its radius, half the smallest edge of a box, the
  /// distance from a hull's middle to its nearest face; half the thickness of `a` if `b` is a
  /// plane. At a larger depth, the separation may be toward the other side.
  double half_thickness_m = 0;
};

/// State of a joint at the current time; forces refer to the last step.
struct JointState {
  double coordinate = 0;  ///< See `JointDef` [rad] or [m]; 0 without a free coordinate.
  double rate = 0;        ///< [rad/s] or [m/s]
  Vec3 force_n;           ///< On body b, at b's point, in W.
  Vec3 torque_n_m;        ///< On body b, about that point, in W.
  /// Largest violation of the joint's constraints; for rotations, the angle times the bodies'
  /// radius of gyration.
  double gap_m = 0;
  double turned_rad = 0;  ///< Rotation of b relative to a since the described pose, 0..pi.
};

/// State of a kinematic body's motion at the current time; force and torque refer to the last step.
struct MotionState {
  double slide_m = 0, slide_rate_m_per_s = 0;
  double turn_rad = 0, turn_rate_rad_per_s = 0;
  // Force and torque that the motion exerts to move the body against all other forces, without the
  // body's weight and inertia, in W.
  Vec3 force_n;
  Vec3 torque_n_m;    ///< About the body's origin (`BodyDef::com_m`).
  double work_j = 0;  ///< Work of the motion on everything else since the start.
};

/// Parameters that `SetParameter` changes per world. `index`: a body, a cable or 0.
enum class Parameter {
  kBodyMass,        ///< [kg]; inertia scales with it.
  kCableStiffness,  ///< [N/m]
  kCableDamping,    ///< [N s/m]
  kFrictionScale,   ///< Factor on all coefficients of the world; index 0. [1]
  kGravityX,        ///< This and the next two: [m/s^2], in W; index 0.
  kGravityY,
  kGravityZ,
};

/// Set of worlds of one model, stepped together. It has no controllers, no sensors, no events and
/// no start: worlds begin in the described pose, and move under the commands that the caller sets.
///
/// Errors: an index out of range (world, group, body, cable, joint, node) is a programming error; a
/// line on stderr names it, and the program ends by abort().
///
/// Threads: any number may call const functions of a batch concurrently. Non-const functions, and
/// writing through the pointers of `Cables`, need exclusive access to the batch. Batches are
/// independent of each other, also if they share a model.
class WorldBatch {
 public:
  WorldBatch(std::shared_ptr<const Model> model, const WorldBatchOptions& options);
  ~WorldBatch();
  WorldBatch(WorldBatch&&) noexcept;
  WorldBatch& operator=(WorldBatch&&) noexcept;

  const Model& model() const noexcept;
  int worlds() const noexcept;
  int lanes() const noexcept;

  /// Advances every world by `count` steps of `step_s`. Allocates nothing.
  void Step(double step_s, int count = 1) noexcept;
  /// Sets the rest length targets of all cables of all worlds [m], cable c of world w at
  /// [w * cables + c], and advances every world by `count` steps of `step_s`. The thread that steps
  /// a world also sets its targets, in parallel; separate calls of `SetRestLengthTarget` run on the
  /// caller's thread alone.
  void Step(double step_s, int count, std::span<const double> rest_length_targets_m) noexcept;

  /// Advances the worlds with `mask[world]` != 0 by one step; the state of the others does not
  /// change. Costs as much as a step of all worlds, and allocates memory.
  void StepMasked(double step_s, std::span<const std::uint8_t> mask);
  [[deprecated("StepMasked")]] void StepSome(double step_s, std::span<const std::uint8_t> mask) {
    StepMasked(step_s, mask);
  }

  /// Returns the simulated time of a world [s].
  double Time(int world) const noexcept;

  // --- commands: held until changed -------------------------------------------------------
  /// Sets the actuator's target for a cable's rest length [m].
  void SetRestLengthTarget(int world, int cable, double rest_length_m) noexcept;
  double RestLengthTarget(int world, int cable) const noexcept;
  /// Sets the duty of a cable's motor: its share of the supply voltage, clipped to -1..1; positive
  /// winds in. NaN halts the world. Switches the motor to duty mode, in which it ignores rest
  /// length targets, until `SetRestLengthTarget` for this cable reactivates the servo. (Targets set
  /// for many cables at once do not change a motor's mode.) A cable without a `dc_motor` counts as
  /// an index out of range in this and the next two functions.
  void SetDuty(int world, int cable, double duty) noexcept;
  /// Switches the motor's driver on (the initial state) or off. While it is off, no current flows
  /// at any duty or target, and friction slows the motor down.
  void SetMotorEnabled(int world, int cable, bool enabled) noexcept;
  MotorState Motor(int world, int cable) const noexcept;
  /// Sets the force on a node [N], in W, for all following steps.
  void SetNodeForce(int world, int node, const Vec3& force_n) noexcept;
  Vec3 NodeForce(int world, int node) const noexcept;

  // --- observation -------------------------------------------------------------------------
  CableState Cable(int world, int cable) const noexcept;
  /// Returns the number of spans of a cable: parts between places with friction, whose tensions may
  /// differ. For a `touches` cable with friction: the largest possible number;
  /// spans beyond the current CableBends() + 1 are all 0.
  int CableSpans(int cable) const noexcept;
  CableSpanState CableSpan(int world, int cable, int span) const noexcept;
  /// Returns the tensions of a cable's current spans from its first end on [N]: one more than
  /// CableBendPlaces(), or than places with friction on its path.
  std::vector<double> CableSpanTensions(int world, int cable) const;
  /// Returns the energy dissipated by friction along a cable since the start [J].
  double CableFrictionLoss(int world, int cable) const noexcept;
  /// Returns the wrap angle of a cable about one of its wheels (the first is 0), from the point
  /// before the wheel to the point after it, including full turns, counter-clockwise about the
  /// wheel's axis [rad].
  double WheelAngle(int world, int cable, int wheel) const noexcept;
  /// Returns the number of edges and rods that bend a `touches` cable.
  int CableBends(int world, int cable) const;
  /// Returns the places where edges and rods bend a cable, from its first end on: the middle of
  /// each arc [m], in W.
  std::vector<Vec3> CableBendPlaces(int world, int cable) const;
  /// Returns the total wrap angle of a cable on wheels, edges and rods [rad].
  double CableWrap(int world, int cable) const;
  /// Returns the points at which a cable exerts forces on bodies: its attachments, and the points
  /// where it meets and leaves wheels, edges and rods.
  std::vector<CablePoint> CablePath(int world, int cable) const;
  /// Returns the readings and commands of all cables of a group of `lanes()` worlds, as rows for
  /// vectorized controllers. Group g begins with world g * lanes(). The rows of the last group have
  /// all lanes, including unused ones beyond the last world.
  CableRows Cables(int group) noexcept;
  /// Updates the readings in the rows of `Cables`. Call it after steps.
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
  /// Returns the overlaps in the current pose: for each pair of bodies, and of a body and a plane,
  /// the one with the largest ratio of depth to half thickness.
  std::vector<Overlap> Overlaps(int world) const;

  // --- state -------------------------------------------------------------------------------
  /// Sets the state of a body. Not for kinematic bodies, whose motion sets their state. In models
  /// with joints the next step first projects the velocities onto the joint constraints
  /// (docs/theory/joints.md, eq. 7a).
  void SetBodyState(int world, int body, const BodyState& state) noexcept;
  /// Sets the simulated time. Kinematic bodies move to their poses at that time.
  void SetTime(int world, double time_s) noexcept;
  /// Sets a cable's rest length [m] and its target at once, without the actuator's limits; stops
  /// its motor.
  void SetRestLength(int world, int cable, double rest_length_m) noexcept;
  /// Returns the reason why `SetParameter` refuses a value ("must be a positive number [kg], got
  /// -1"); empty if the value is valid. Limits are the same as in model files. For a fixed body any
  /// mass is valid, and has no effect.
  std::string ParameterError(Parameter parameter, int index, double value) const;
  /// Returns false and changes nothing if `ParameterError` returns a reason.
  bool SetParameter(int world, Parameter parameter, int index, double value) noexcept;
  double GetParameter(int world, Parameter parameter, int index) const noexcept;

  /// Serializes all data that determine a world's future, commands and parameters included.
  std::vector<std::uint8_t> Save(int world) const;
  /// Restores a serialized world into any world. Returns false, without a change, if the snapshot
  /// belongs to another model.
  bool Restore(int world, const std::vector<std::uint8_t>& snapshot) noexcept;
  std::uint64_t Hash(int world) const noexcept;
  WorldStatus Status(int world) const noexcept;
  void ClearStatus(int world) noexcept;
  /// Returns the memory per additional world [bytes].
  std::size_t BytesPerWorld() const noexcept;

 private:
  friend struct BatchInside;  ///< For measurements (benchmarks/).
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
