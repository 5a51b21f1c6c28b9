/// Vectorized simulation of many worlds of one model, without controllers and events. For
/// experiments, use `Simulation` (taut/simulation.h). Each SIMD lane contains one world; a thread
/// pool steps groups of lanes. The number of worlds, the lane, the number of threads and the
/// instruction set do not change any bit of a world's results (docs/determinism.md).
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

/// Compiled model, checked and ready for stepping. Immutable; all worlds of a batch and any number
/// of threads share it.
class Model {
 public:
  /// Checks the numbers of `def` and compiles it. Returns null and adds diagnostics (without file
  /// positions) if a number is invalid, such as a negative mass, NaN or an index out of range. Also
  /// returns null if the environment variable TAUT_SIMD does not name an instruction set. Adds a
  /// warning if `def` belongs to an experiment with controllers, events or a settled start, which a
  /// `WorldBatch` ignores.
  static std::shared_ptr<const Model> Compile(const ModelDef& def, Diagnostics& out);
  /// Same as `Compile`, but without this warning, for programs that run the controllers and events.
  static std::shared_ptr<const Model> CompileForExperiment(const ModelDef& def, Diagnostics& out);

  virtual ~Model() = default;
  const ModelDef& def() const noexcept { return def_; }

 protected:
  explicit Model(ModelDef def) : def_(std::move(def)) {}
  ModelDef def_;
};

/// Instruction set. The value is the number of worlds per SIMD register: 1, 2 (SSE2; NEON on
/// AArch64; SIMD128 in WebAssembly), 4 (AVX2) or 8 (AVX-512).
enum class Simd { kScalar = 1, kSse2 = 2, kNeon = 2, kSimd128 = 2, kAvx2 = 4, kAvx512 = 8 };

/// Returns the widest instruction set of this machine, limited by the environment variable
/// TAUT_SIMD (scalar, sse2, neon, simd128, avx2, avx512). If the machine lacks the named
/// instruction set, returns a supported one. Other values are ignored here; `Model::Compile`
/// reports them as errors. Thread safe while no thread changes the environment.
Simd BestSimd();

class ContactFriction;  // taut/friction.h

struct WorldBatchOptions {
  int worlds = 1;
  int threads = 1;                ///< Number of threads; 0: one per core.
  std::optional<Simd> simd = {};  ///< Absent: scalar for one world, else `BestSimd()`.
  /// Maximum number of linear solves per island and step. An island that needs more sets
  /// `kStatusNotConverged`.
  int max_linear_solves = 1000;
  double tolerance_m_per_s = 1e-10;  ///< Residual at which the contact solver stops.
  /// Custom friction law; null: the law of the model.
  std::shared_ptr<const ContactFriction> friction = nullptr;
};

/// Returns the instruction set of a batch with these options; its value is the number of lanes.
Simd SimdOf(const WorldBatchOptions& options);

/// Condition bits of a world; 0: no problem. Bits remain set until `ClearStatus`.
enum StatusBits : std::uint32_t {
  kStatusOk = 0,
  kStatusNonFinite = 1u << 0,     ///< A state is NaN or infinite; the world is frozen.
  kStatusNotConverged = 1u << 1,  ///< Contacts or stiff cables were not solved to the tolerance.
  /// The contact buffer is full. If `WorldStatus::cable` is set instead: the cable touches more
  /// edges and rods than it can bend around (docs/theory/cables.md, section 6).
  kStatusContactOverflow = 1u << 2,
  /// The step is too long for at least one of:
  ///  - transverse motion under the tension of a cable (docs/theory/cables.md, eq. 12);
  ///  - the substeps of stiff cables (eq. 12i);
  ///  - a bend that a turning rod moves along its axis (section 6);
  ///  - the joint forces of a body (docs/theory/joints.md, section 6);
  ///  - the rotation of a body about a hinge away from its center of mass (same section).
  kStatusStepTooLong = 1u << 3,
  /// The center of mass of a body is below the whole terrain, which has a height field or a mesh
  /// but no plane. The body left the terrain and falls forever.
  kStatusFellOff = 1u << 4,
  /// A member exceeded its strength, yield or buckling limit (taut/safety.h). Only runs check these
  /// limits, not a WorldBatch.
  kStatusOverloaded = 1u << 5,
};

struct WorldStatus {
  std::uint32_t bits = kStatusOk;
  double first_time_s = 0.0;  ///< Time at which the first bit was set.
  int body = kWorld;          ///< Affected body, or kWorld.
  int cable = -1;             ///< Affected cable, or -1.
  /// For a body that left the terrain: index of the nearest height field or mesh, seen from above.
  /// Meshes are numbered after the height fields. Otherwise -1.
  int ground = -1;
  double residual_m_per_s = 0;  ///< Residual of the last solve.
  /// Number of linear solves in the last step: those shared by all lanes, and those of each island,
  /// including position projection.
  int linear_solves = 0;
  /// Largest relaxation of the contact equations in the last step, as a velocity; at most 1e-6 m/s,
  /// and usually 0. Contact equations that are inconsistent around a loop of bodies are relaxed
  /// (docs/theory/contact.md, section 5). `residual_m_per_s` refers to the relaxed equations.
  double contact_relaxation_m_per_s = 0;
};

/// State of a cable at the current time.
using CableState = CableReadings<double>;

/// Readings of all cables of a group (the worlds that share a SIMD register). Cable c of world
/// `first_world + j` is at [c * lanes + j]. The pointers refer to memory of the batch. After a step
/// or change, call `WorldBatch::Sense` to update the readings.
struct CableRows : ReadingRows {
  int lanes = 1, first_world = 0;
  double* rest_length_target_m = nullptr;  ///< Writable; see `SetRestLengthTarget`.
};

/// Point on the path of a cable.
struct CablePoint {
  int body = kWorld;
  Vec3 position_m;  ///< Position of the point, in W.
  Vec3 force_n;     ///< Force of the cable on the body at this point, in W.
};

/// State of a cable span: part of a cable between successive points with friction or ends.
struct CableSpanState {
  double length_m = 0;       ///< Includes half of the wrapped arc at each end.
  double rest_length_m = 0;  ///< The sum over all spans is the rest length of the cable.
  double tension_n = 0;      ///< Average over the last step.
};

struct BodyState {
  Vec3 position_m;        ///< Position of the center of mass, in W.
  Quat orientation;       ///< Rotation from the orientation at t = 0, in W; identity at t = 0.
  Vec3 velocity_m_per_s;  ///< Velocity of the center of mass, in W.
  Vec3 angular_velocity_rad_per_s;  ///< Angular velocity, in W.
};

struct Energy {
  double kinetic_j = 0, gravity_j = 0, elastic_j = 0;
};

/// Contact point of the last step.
struct ContactState {
  int body_a = 0, body_b = kWorld;  ///< `force_n` acts on A, its opposite on B.
  Vec3 point_m, normal;             ///< In W; normal points from B to A.
  Vec3 force_n;                     ///< Force on A, in W.
  double gap_m = 0;
};

/// Reference to a shape or a part of the terrain in a `ModelDef`: list, and index in the list.
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
  /// Half the thickness of the thinner shape: its radius, half the smallest edge of a box, or the
  /// distance from the center of a hull to its nearest face. If `b` is a plane: half the thickness
  /// of `a`. If `depth_m` is larger, contacts may push the shapes apart on the wrong side.
  double half_thickness_m = 0;
};

/// State of a joint at the current time. Forces are from the last step.
struct JointState {
  double coordinate = 0;  ///< Defined at `JointDef` [rad] or [m]; 0 if the joint has none.
  double rate = 0;        ///< Time derivative of `coordinate` [rad/s] or [m/s].
  Vec3 force_n;           ///< Force of the joint on body b at b's joint point, in W.
  Vec3 torque_n_m;        ///< Torque of the joint on body b about that point, in W.
  /// Largest violation of the joint's constraints, as a length. A rotation error is multiplied by
  /// the radius of gyration of the bodies.
  double gap_m = 0;
  double turned_rad = 0;  ///< Rotation angle of b relative to a since the described pose, 0..pi.
};

/// State of the motion of a kinematic body at the current time. Force and torque are from the last
/// step.
struct MotionState {
  double slide_m = 0, slide_rate_m_per_s = 0;
  double turn_rad = 0, turn_rate_rad_per_s = 0;
  // Force and torque of the motion on the body, against all other forces on the body, in W. The
  // body's weight and inertia are not included.
  Vec3 force_n;
  Vec3 torque_n_m;    ///< About the body's origin (`BodyDef::com_m`).
  double work_j = 0;  ///< Work of the motion on the other bodies since the start.
};

/// Parameters that `SetParameter` changes per world. The argument `index` is a body, a cable or 0.
enum class Parameter {
  kBodyMass,        ///< Mass of a body [kg]; its inertia is scaled by the same factor.
  kCableStiffness,  ///< Stiffness k of a cable [N/m].
  kCableDamping,    ///< Damping coefficient b of a cable [N s/m].
  kFrictionScale,   ///< Factor on all friction coefficients of the world [1]; index 0.
  kGravityX,        ///< Gravity along x, y and z [m/s^2], in W; index 0.
  kGravityY,
  kGravityZ,
};

/// Worlds of one model, stepped together. A batch has no controllers, sensors, events or settling:
/// worlds begin in the described pose and move under the commands of the caller.
///
/// Errors: an index out of range (world, group, body, cable, joint, node) is a programming error.
/// The program prints it on stderr and calls abort().
///
/// Threads: any number may call const functions of a batch concurrently. Non-const functions, and
/// writing through the pointers of `Cables`, need exclusive access to the batch. Batches are
/// independent of each other, even if they share a model.
class WorldBatch {
 public:
  WorldBatch(std::shared_ptr<const Model> model, const WorldBatchOptions& options);
  ~WorldBatch();
  WorldBatch(WorldBatch&&) noexcept;
  WorldBatch& operator=(WorldBatch&&) noexcept;

  const Model& model() const noexcept;
  int worlds() const noexcept;
  int lanes() const noexcept;

  /// Advances every world by `count` steps of `step_s` [s]. Allocates no memory.
  void Step(double step_s, int count = 1) noexcept;
  /// Sets the rest length targets [m] of all cables of all worlds, cable c of world w at [w *
  /// cables + c]. Then advances every world by `count` steps of `step_s`. The threads that step the
  /// worlds also set the targets in parallel, in contrast to separate calls of
  /// `SetRestLengthTarget`.
  void Step(double step_s, int count, std::span<const double> rest_length_targets_m) noexcept;

  /// Advances the worlds with `mask[world]` != 0 by one step; other worlds do not change. Takes as
  /// long as a step of all worlds, and allocates memory.
  void StepMasked(double step_s, std::span<const std::uint8_t> mask);
  [[deprecated("StepMasked")]] void StepSome(double step_s, std::span<const std::uint8_t> mask) {
    StepMasked(step_s, mask);
  }

  /// Returns the simulated time of a world [s].
  double Time(int world) const noexcept;

  // --- commands: valid until changed ------------------------------------------------------
  /// Sets the rest length target [m] for the actuator of a cable.
  void SetRestLengthTarget(int world, int cable, double rest_length_m) noexcept;
  double RestLengthTarget(int world, int cable) const noexcept;
  /// Sets the duty of a cable's motor: fraction of the supply voltage, clipped to -1..1; positive
  /// winds in. NaN halts the world. From this call on, the motor ignores rest length targets until
  /// `SetRestLengthTarget` for this cable reactivates its servo. Functions that set targets of many
  /// cables do not reactivate the servo. In this and the next two functions, a cable without a
  /// `dc_motor` counts as an index out of range.
  void SetDuty(int world, int cable, double duty) noexcept;
  /// Switches the motor driver on (initial state) or off. While the driver is off, no current flows
  /// at any duty or target, and friction decelerates the motor.
  void SetMotorEnabled(int world, int cable, bool enabled) noexcept;
  MotorState Motor(int world, int cable) const noexcept;
  /// Sets the force on a node [N], in W, for all following steps.
  void SetNodeForce(int world, int node, const Vec3& force_n) noexcept;
  Vec3 NodeForce(int world, int node) const noexcept;

  // --- observation -------------------------------------------------------------------------
  CableState Cable(int world, int cable) const noexcept;
  /// Returns the number of spans of a cable: parts between points with friction, with possibly
  /// different tensions. For a cable with friction that wraps around obstacles (`touches`), returns
  /// the largest possible number; all values of spans beyond CableBends() + 1 are 0.
  int CableSpans(int cable) const noexcept;
  CableSpanState CableSpan(int world, int cable, int span) const noexcept;
  /// Returns the tensions [N] of the present spans of a cable, from its first end. The number of
  /// spans is one more than the number of CableBendPlaces(), or of points with friction on the
  /// path.
  std::vector<double> CableSpanTensions(int world, int cable) const;
  /// Returns the energy dissipated by friction along a cable since the start [J].
  double CableFrictionLoss(int world, int cable) const noexcept;
  /// Returns the wrap angle [rad] of a cable about one of its wheels (the first is 0): from the
  /// point before the wheel to the point after it, including full turns, counterclockwise about the
  /// wheel's axis.
  double WheelAngle(int world, int cable, int wheel) const noexcept;
  /// Returns the number of edges and rods that bend a `touches` cable.
  int CableBends(int world, int cable) const;
  /// Returns the points at which edges and rods bend a cable, from its first end: the middle of
  /// each arc [m], in W.
  std::vector<Vec3> CableBendPlaces(int world, int cable) const;
  /// Returns the total wrap angle of a cable on wheels, edges and rods [rad].
  double CableWrap(int world, int cable) const;
  /// Returns the points at which a cable exerts forces on bodies: its attachments, and the points
  /// where it reaches and leaves wheels, edges and rods.
  std::vector<CablePoint> CablePath(int world, int cable) const;
  /// Returns the readings and commands of all cables of a group of `lanes()` worlds, as rows for
  /// vectorized controllers. Group g begins with world g * lanes(). The rows of the last group
  /// include unused lanes after the last world.
  CableRows Cables(int group) noexcept;
  /// Updates the readings in the rows from `Cables`. Call it after steps.
  void Sense(int group) const noexcept;
  int groups() const noexcept;
  BodyState Body(int world, int body) const noexcept;
  Vec3 NodePosition(int world, int node) const noexcept;  ///< Position [m], in W.
  Vec3 NodeVelocity(int world, int node) const noexcept;  ///< Velocity [m/s], in W.
  JointState Joint(int world, int joint) const noexcept;
  MotionState Motion(int world, int motion) const noexcept;
  Energy TotalEnergy(int world) const noexcept;
  Vec3 Momentum(int world) const noexcept;              ///< Total momentum [kg m/s], in W.
  Vec3 AngularMomentum(int world) const noexcept;       ///< About the origin of W [kg m^2/s].
  std::vector<ContactState> Contacts(int world) const;  ///< Contacts of the last step.
  /// Returns the overlaps in the current pose. The list contains one overlap per pair of bodies,
  /// and per body and plane: the overlap with the largest ratio of depth to half thickness.
  std::vector<Overlap> Overlaps(int world) const;

  // --- state -------------------------------------------------------------------------------
  /// Sets the state of a body. Not for kinematic bodies, whose motion determines their state. If
  /// the model has joints, the next step first projects the velocities onto the joint constraints
  /// (docs/theory/joints.md, eq. 7a).
  void SetBodyState(int world, int body, const BodyState& state) noexcept;
  /// Sets the simulated time. Kinematic bodies move to their poses at that time.
  void SetTime(int world, double time_s) noexcept;
  /// Sets the rest length [m] of a cable and its target immediately, ignoring the limits of the
  /// actuator. If the actuator is a motor, the motor stops.
  void SetRestLength(int world, int cable, double rest_length_m) noexcept;
  /// Returns the reason why `SetParameter` rejects a value ("must be a positive number [kg], got
  /// -1"), or an empty text if the value is valid. The limits are the same as in model files. For a
  /// fixed body, any mass is valid and has no effect.
  std::string ParameterError(Parameter parameter, int index, double value) const;
  /// Sets a parameter. Returns false and changes nothing if `ParameterError` returns a reason.
  bool SetParameter(int world, Parameter parameter, int index, double value) noexcept;
  double GetParameter(int world, Parameter parameter, int index) const noexcept;

  /// Serializes all data that determine the future of a world, including commands and parameters.
  std::vector<std::uint8_t> Save(int world) const;
  /// Restores a serialized world into any world. If the snapshot belongs to another model, returns
  /// false and changes nothing.
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
