/// Controller and plant interface: a plant provides observations and a clock and takes commands.
/// Controllers, recorders, learners and displays do not depend on the kind of plant: a simulated
/// world, the worlds that share a SIMD register, a recording, or a real robot. A plant consists of
/// one or more equal robots, its lanes.
///
/// Rows (arrays of a plant) contain cable c of lane j at index [c * lanes + j].
///
/// Threads: the thread that advances a plant has exclusive access to the plant, its controllers and
/// its sensors. Plants are independent of each other.
///
/// Commands of custom controllers, and readings of plants other than simulations, must be finite.
/// Others are refused: runs end with an error, rollouts fail, and a `Simulation` reports them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "taut/cable_readings.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "taut/world_batch.h"

namespace taut {

namespace plant {
class LaneState;
}

/// Set of lanes: lane j is bit j.
using Lanes = std::uint32_t;

/// Returns whether a set contains a lane.
constexpr bool Has(Lanes lanes, int lane) noexcept { return (lanes >> lane & 1u) != 0; }
/// Returns the set of lanes 0 to `count` - 1.
constexpr Lanes AllLanes(int count) noexcept { return static_cast<Lanes>((1ull << count) - 1); }

// --- observations --------------------------------------------------------------------------------

/// Fault bits of a cable's sensors and actuator; 0: none.
enum FaultBits : std::uint32_t {
  kFaultNone = 0,
  kFaultNoReading = 1u << 0,  ///< No new reading: the last one is kept.
  kFaultSensor = 1u << 1,     ///< Impossible reading.
  kFaultActuator = 1u << 2,   ///< The actuator does not follow its command.
};

/// Poses and velocities of bodies. Available in simulations and in recordings that contain them,
/// but usually not for a real robot.
class Bodies {
 public:
  virtual ~Bodies() = default;
  /// Returns the state of a body: SI units, in W.
  virtual BodyState Body(int lane, int body) const = 0;
  virtual Vec3 NodePosition(int lane, int node) const = 0;  ///< [m], in W.
  virtual Vec3 NodeVelocity(int lane, int node) const = 0;  ///< [m/s], in W.
};

/// Observation: measured quantities of a plant at one time. Its pointers refer to data of the
/// plant.
struct Observation {
  int lanes = 1;
  const double* time_s = nullptr;  ///< Per lane: time of its clock [s].
  ReadingRows cables;              ///< Rows: readings of the cables.
  /// Row: rest lengths by the angle of the motors' shafts [m], which differ from the rest lengths
  /// if gears have backlash; null: equal.
  const double* shaft_m = nullptr;
  const std::uint32_t* faults = nullptr;  ///< Row: `FaultBits`; null: faults are not detected.
  const Bodies* bodies = nullptr;         ///< Null: not known.
  /// Horizontal unit vector toward the goal in the frame of `GoalSpec::frame`, as measured with a
  /// compass and a beacon (`GoalSpec`): x of lane j at [j], y at [lanes + j]; null: not measured.
  const double* goal = nullptr;

  /// Returns the readings of one cable in one lane.
  CableState Cable(int cable, int lane = 0) const {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(cable) * lanes + lane;
    return MapReadings([at](const double* row) { return row[at]; }, cables);
  }
};

// --- commands ------------------------------------------------------------------------------------

/// Command mode of a cable's actuator.
enum class CommandMode : unsigned char {
  kRestLength,  ///< Move to `rest_length_m`.
  kTension,  ///< Control the tension to `set_point_n`, if the actuator has a controller for that,
             ///< as a board has; else move to `rest_length_m`.
  kHold,     ///< Keep the present rest length.
  kOff,  ///< No power: a `dc_motor` slows down, or its cable drives it back. Actuators that cannot
         ///< be back-driven keep their rest length.
};

/// Commands of controllers to the plant and to subsequent controllers, as rows of the plant. Values
/// persist until changed.
struct Commands {
  int lanes = 1;
  double* rest_length_m = nullptr;  ///< Set points of the rest lengths [m].
  /// Set points of the tensions [N]; the values are 0 if the control law has none.
  double* set_point_n = nullptr;
  /// V0 of impedance control [m/s], including a gait's part.
  double* velocity_input_m_per_s = nullptr;
  double* signal = nullptr;     ///< Output of a gait: velocity [m/s] or length [m]; else 0.
  CommandMode* mode = nullptr;  ///< Initially `kRestLength`.
  /// Per lane: number of the gait that controllers play (`GaitInputSpec`); -1: as in the
  /// experiment.
  int* gait = nullptr;
};

// --- plants --------------------------------------------------------------------------------------

/// External force on a node [N], in W.
struct ExternalForce {
  int node = 0;
  Vec3 force_n;
};

/// Additional quantities and functions of a simulated plant; units and frames as in `WorldBatch`.
class World : public Bodies {
 public:
  /// As `WorldBatch::SetNodeForce`.
  virtual void SetNodeForce(int lane, int node, const Vec3& force_n) = 0;
  virtual Vec3 NodeForce(int lane, int node) const = 0;
  virtual double BodyMass(int lane, int body) const = 0;  ///< In kg.
  virtual Energy TotalEnergy(int lane) const = 0;
  virtual MotorState Motor(int lane, int cable) const = 0;  ///< Of a cable with a `dc_motor`.
  virtual std::vector<ContactState> Contacts(int lane) const = 0;
  // As in `WorldBatch`:
  virtual double CableFrictionLoss(int lane, int cable) const = 0;
  virtual std::vector<double> CableSpanTensions(int lane, int cable) const = 0;
  virtual double WheelAngle(int lane, int cable, int wheel) const = 0;
  virtual std::vector<CablePoint> CablePath(int lane, int cable) const = 0;
  virtual std::vector<Vec3> CableBendPlaces(int lane, int cable) const = 0;
  virtual double CableWrap(int lane, int cable) const = 0;
  virtual JointState Joint(int lane, int joint) const = 0;
  virtual MotionState Motion(int lane, int motion) const = 0;
  virtual WorldStatus Status(int lane) const = 0;
  virtual std::uint64_t Hash(int lane) const = 0;
};

/// System under control.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Returns the present observation; valid until `Advance`.
  virtual const Observation& Observe() = 0;
  /// Returns the commands, for controllers to change.
  virtual Commands& commands() = 0;

  /// Advances the clock of lane j by `step_s[j]` to `to_s[j]` (which is more exact than a sum)
  /// under the present commands. A simulation computes, a robot waits, a recording moves to a later
  /// row. Lanes with step 0 do not advance.
  virtual void Advance(const double* step_s, const double* to_s) = 0;

  /// Sets a lane's clock to 0 and its commands to their initial values. The caller has set the
  /// lane's state before.
  virtual void Restart(int lane) = 0;

  /// Saves or restores a lane's clock and commands, like `Controller::Serialize`. It does not
  /// include the state of the simulated world.
  virtual void Serialize(plant::LaneState& state) { (void)state; }

  /// Returns whether a lane is running. False if its state is not finite, its recording has ended,
  /// or its robot does not answer.
  virtual bool IsRunning(int lane) const = 0;

  /// Returns the simulated world, or null if the plant is not a simulation.
  virtual World* world() noexcept { return nullptr; }
};

/// Returns a simulated plant: the lanes of a batch with one group. All clocks start at 0. The batch
/// must outlive it.
std::unique_ptr<Plant> PlantOf(WorldBatch& batch);

/// Returns a plant of one lane that replays a recording: its observations are the recorded readings
/// of the robot's cables (`cable/NAME/...`) and, if all bodies were recorded, bodies; commands have
/// no effect. Use it to compute the commands that a controller would have issued. A quantity that
/// is missing or not finite in a row keeps its previous value and sets `kFaultNoReading`. Times
/// count from the first row. Trace and robot must outlive it. Returns null with an error if the
/// recording has no row or no channel of these cables.
std::unique_ptr<Plant> ReplayOf(const Trace& trace, const RobotSpec& robot, Diagnostics& out);

// --- custom controllers and sensors --------------------------------------------------------------

/// Lanes in which a controller or sensor acts now.
struct Tick {
  Lanes due = 0;
  /// Per lane: number of previous ticks since its start. 0: first tick; discard all memory of the
  /// lane, since it belongs to an earlier run.
  const std::int64_t* number = nullptr;
};

/// Context for the construction of controllers and sensors. The variants in `lanes` exist only
/// during construction.
struct ControlSetup {
  const ExperimentSpec& experiment;
  std::span<const RolloutWorld* const> lanes;  ///< Variant of the experiment, one per lane.
  int first_world = 0;  ///< Index of the first lane's world in a `Simulation`; else 0.
  /// Number of lanes whose results are used; the others repeat the first lane. -1: all lanes.
  int worlds = -1;
};

/// Controller: computes commands from observations at the ticks of a clock that does not depend on
/// the physics step. It processes all lanes at once, and must write only lanes of `tick.due`: the
/// plant does not protect commands of other lanes.
class Controller {
 public:
  virtual ~Controller() = default;
  virtual ClockSpec clock() const = 0;
  /// Computes the commands of the lanes in `tick.due`.
  virtual void Act(const Tick& tick, const Observation& seen, Commands& commands) = 0;
  /// Restarts a lane as another variant. Its next tick is its first.
  virtual void Restart(int lane, const RolloutWorld& world) { (void)lane, (void)world; }
  /// Changes parameters of a lane: `controllers` differ from the experiment's in numbers only. The
  /// lane's memory is kept, and phases continue without a jump. Called before a tick; allocates
  /// nothing.
  virtual void Retune(int lane, const std::vector<ControllerSpec>& controllers) {
    (void)lane, (void)controllers;
  }
  /// Saves or restores a lane's memory, for `Simulation::Save` and `Env::Save`. All controllers of
  /// taut implement it.
  virtual void Serialize(plant::LaneState& state) { (void)state; }

  // --- interactive changes in a lane; controllers without such quantities keep these defaults ----
  /// Returns the gains of a cable, if it has any.
  virtual std::optional<ImpedanceGains> Gains(int lane, int cable) const {
    return (void)lane, (void)cable, std::nullopt;
  }
  /// Sets the gains of a cable. Returns false if it has none.
  virtual bool SetGains(int lane, const ImpedanceGains& gains) {
    return (void)lane, (void)gains, false;
  }
  /// Holds a cable at a rest length [m] from the next tick on, instead of its program. Returns
  /// false if not supported.
  virtual bool Hold(int lane, int cable, double rest_length_m) {
    return (void)lane, (void)cable, (void)rest_length_m, false;
  }
};

/// Sensor model between a plant and its controllers. Samples at the ticks of its clock.
class SensorModel {
 public:
  virtual ~SensorModel() = default;
  virtual ClockSpec clock() const = 0;
  /// Samples the lanes in `tick.due`. `exact`: observation of the plant.
  virtual void Sample(const Tick& tick, const Observation& exact) = 0;
  /// Returns the controllers' observation; valid until the next sample.
  virtual const Observation& seen() const = 0;
  virtual void Restart(int lane, const RolloutWorld& world) { (void)lane, (void)world; }
  virtual void Serialize(plant::LaneState& state) { (void)state; }  ///< As in `Controller`.
};

using ControllerFactory = std::function<std::unique_ptr<Controller>(const ControlSetup&)>;

/// Custom controllers, which act in this order after the experiment's controllers and may overrule
/// them, and custom sensors, whose input is the output of the experiment's sensors. Factories are
/// called once per plant, from the thread that runs it.
struct Extensions {
  std::vector<ControllerFactory> controllers;
  std::function<std::unique_ptr<SensorModel>(const ControlSetup&)> sensors;
};

/// Returns factories of the library's controllers for a specification, as in an experiment file,
/// for `Extensions::controllers`: a gait and the control law that it feeds, or one of the two.
/// Their parameters are the same in all variants. The cable indices of `spec` must be those of the
/// robot that the controllers are used with.
std::vector<ControllerFactory> ControllersOf(const ControllerSpec& spec);

using Brought [[deprecated("Extensions")]] = Extensions;

}  // namespace taut
