/// Interface between controllers and plants. A plant provides observations and a clock, and
/// receives commands. A plant is a simulated world, several worlds that share a SIMD register, a
/// recording, or a real robot. Controllers, recorders, learners and displays work with all plants.
/// A plant contains one or more identical robots, called its lanes.
///
/// Rows are arrays of a plant with cable c of lane j at index [c * lanes + j].
///
/// Threads: the thread that advances a plant has exclusive access to the plant, its controllers and
/// its sensors. Plants are independent of each other.
///
/// Commands of custom controllers, and readings of plants other than simulations, must be finite.
/// If a value is not finite, runs end with an error, rollouts fail, and a `Simulation` reports the
/// problem.
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

/// Fault bits of sensors and actuator of a cable; 0: none.
enum FaultBits : std::uint32_t {
  kFaultNone = 0,
  kFaultNoReading = 1u << 0,  ///< No new reading; the last one remains.
  kFaultSensor = 1u << 1,     ///< The reading is impossible.
  kFaultActuator = 1u << 2,   ///< The actuator does not follow its command.
};

/// Poses and velocities of bodies. Simulations have them, recordings may contain them, real robots
/// usually lack them.
class Bodies {
 public:
  virtual ~Bodies() = default;
  /// Returns the state of a body in SI units, in W.
  virtual BodyState Body(int lane, int body) const = 0;
  virtual Vec3 NodePosition(int lane, int node) const = 0;  ///< Position [m], in W.
  virtual Vec3 NodeVelocity(int lane, int node) const = 0;  ///< Velocity [m/s], in W.
};

/// Observation: measured quantities of a plant at one time. The pointers refer to memory of the
/// plant.
struct Observation {
  int lanes = 1;
  const double* time_s = nullptr;  ///< Per lane: time of its clock [s].
  ReadingRows cables;              ///< Rows: readings of the cables.
  /// Row of rest lengths computed from motor shaft angles [m]. These rest lengths differ from the
  /// true ones if gears have backlash. Null: they do not differ.
  const double* shaft_m = nullptr;
  const std::uint32_t* faults = nullptr;  ///< Row of `FaultBits`; null: no fault detection.
  const Bodies* bodies = nullptr;         ///< States of the bodies; null if unknown.
  /// Measured horizontal unit vector toward the goal, from a compass and a beacon, in the frame
  /// `GoalSpec::frame`. x of lane j is at [j], y at [lanes + j]. Null: not measured.
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
  /// Control the tension to `set_point_n` if the actuator has a tension controller, as on a board.
  /// Otherwise like kRestLength.
  kTension,
  kHold,  ///< Keep the present rest length.
  /// No power. A `dc_motor` slows down or is driven back by its cable; other actuators keep their
  /// rest length.
  kOff,
  kDuty,  ///< Apply `Commands::duty` to a `dc_motor`; otherwise like kRestLength.
};

/// Commands of controllers to the plant and to later controllers, as rows. Values remain until they
/// are changed.
struct Commands {
  int lanes = 1;
  double* rest_length_m = nullptr;  ///< Targets of rest lengths [m].
  /// Set points of tensions [N]; 0 if the control law has none.
  double* set_point_n = nullptr;
  /// V0 of impedance control [m/s], including the signal of a gait.
  double* velocity_input_m_per_s = nullptr;
  double* signal = nullptr;     ///< Output of a gait: velocity [m/s] or length [m]; otherwise 0.
  CommandMode* mode = nullptr;  ///< Initially `kRestLength`.
  /// Per lane: number of the active gait (`GaitInputSpec`); -1: as in the experiment.
  int* gait = nullptr;
  /// Row: duties of DC motors in mode kDuty, -1 .. 1; positive winds in. Null: the plant accepts no
  /// duties.
  double* duty = nullptr;
};

// --- plants --------------------------------------------------------------------------------------

/// External force on a node [N], in W.
struct ExternalForce {
  int node = 0;
  Vec3 force_n;
};

/// Additional functions of a simulated plant. Units and frames: see `WorldBatch`.
class World : public Bodies {
 public:
  /// See `WorldBatch::SetNodeForce`.
  virtual void SetNodeForce(int lane, int node, const Vec3& force_n) = 0;
  virtual Vec3 NodeForce(int lane, int node) const = 0;
  virtual double BodyMass(int lane, int body) const = 0;  ///< Mass of a body [kg].
  virtual Energy TotalEnergy(int lane) const = 0;
  virtual MotorState Motor(int lane, int cable) const = 0;  ///< Motor of a cable with a `dc_motor`.
  virtual std::vector<ContactState> Contacts(int lane) const = 0;
  // See `WorldBatch`.
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

/// System under control: a simulation, a recording or a robot.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Returns the current observation; valid until `Advance`.
  virtual const Observation& Observe() = 0;
  /// Returns the commands, which controllers change.
  virtual Commands& commands() = 0;

  /// Advances the clock of lane j by `step_s[j]` under the current commands. `to_s[j]` is the time
  /// at the end of this step, more exact than a sum of steps. A simulation computes a step, a robot
  /// waits, a recording continues to a later row. Lanes with step 0 do not advance.
  virtual void Advance(const double* step_s, const double* to_s) = 0;

  /// Sets the clock of a lane to 0 and its commands to their initial values. Set the state of the
  /// lane before this call.
  virtual void Restart(int lane) = 0;

  /// Saves or restores clock and commands of a lane, like `Controller::Serialize`. The state of the
  /// simulated world is not included.
  virtual void Serialize(plant::LaneState& state) { (void)state; }

  /// Returns whether a lane is running: its state is finite, its recording has not ended, and its
  /// robot answers.
  virtual bool IsRunning(int lane) const = 0;

  /// Returns the simulated world, or null if the plant is not a simulation.
  virtual World* world() noexcept { return nullptr; }
};

/// Returns a simulated plant with the lanes of a batch that has one group. All clocks start at 0.
/// The batch must outlive the plant.
std::unique_ptr<Plant> PlantOf(WorldBatch& batch);

/// Returns a plant with one lane that replays a recording, for example to compute the commands of
/// another controller. Observations are the recorded cable readings (`cable/NAME/...`) and, if all
/// bodies were recorded, their poses and velocities. Commands have no effect. A quantity that is
/// missing or not finite in a row keeps its previous value and sets `kFaultNoReading`. Times count
/// from the first row. Trace and robot must outlive the plant. Returns null and adds an error if
/// the recording has no row, or no channel of the robot's cables.
std::unique_ptr<Plant> ReplayOf(const Trace& trace, const RobotSpec& robot, Diagnostics& out);

// --- custom controllers and sensors --------------------------------------------------------------

/// Lanes in which a controller or sensor acts in this step.
struct Tick {
  Lanes due = 0;
  /// Per lane: number of its previous ticks. At the first tick (0), discard the controller's memory
  /// of the lane, which belongs to an earlier run.
  const std::int64_t* number = nullptr;
};

/// Context for the construction of controllers and sensors. The variants in `lanes` exist only
/// during construction.
struct ControlSetup {
  const ExperimentSpec& experiment;
  std::span<const RolloutWorld* const> lanes;  ///< Variants of the experiment, one per lane.
  int first_world = 0;  ///< World index of the first lane in a `Simulation`; otherwise 0.
  /// Number of lanes in use; the remaining lanes repeat the first lane. -1: all lanes.
  int worlds = -1;
};

/// Controller: computes commands from observations at the ticks of a clock that is independent of
/// the physics step. A controller processes all lanes at once. It must write only lanes in
/// `tick.due`; the plant does not protect the commands of other lanes.
class Controller {
 public:
  virtual ~Controller() = default;
  virtual ClockSpec clock() const = 0;
  /// Computes the commands of the lanes in `tick.due`.
  virtual void Act(const Tick& tick, const Observation& seen, Commands& commands) = 0;
  /// Restarts a lane with another variant. The next tick of this lane is its first.
  virtual void Restart(int lane, const RolloutWorld& world) { (void)lane, (void)world; }
  /// Changes parameters of a lane. `controllers` differ from the experiment's in numbers only. The
  /// memory of the lane remains, and phases continue without a jump. Called before a tick;
  /// allocates no memory.
  virtual void Retune(int lane, const std::vector<ControllerSpec>& controllers) {
    (void)lane, (void)controllers;
  }
  /// Saves or restores the memory of a lane, for `Simulation::Save` and `Env::Save`. All
  /// controllers of taut implement it.
  virtual void Serialize(plant::LaneState& state) { (void)state; }
  /// Returns a text about the faults in a lane since its restart; empty if there are none.
  virtual std::string Faults(int lane) const { return (void)lane, std::string(); }

  // --- interactive changes of a lane: override the functions that the controller supports ---
  /// Returns the gains of a cable; nothing if it has none.
  virtual std::optional<ImpedanceGains> Gains(int lane, int cable) const {
    return (void)lane, (void)cable, std::nullopt;
  }
  /// Sets the gains of a cable. Returns false if it has none.
  virtual bool SetGains(int lane, const ImpedanceGains& gains) {
    return (void)lane, (void)gains, false;
  }
  /// Replaces the program of a cable by a constant rest length [m] from the next tick. Returns
  /// false if not supported.
  virtual bool Hold(int lane, int cable, double rest_length_m) {
    return (void)lane, (void)cable, (void)rest_length_m, false;
  }
};

/// Sensor model between a plant and its controllers, sampled at the ticks of its clock.
class SensorModel {
 public:
  virtual ~SensorModel() = default;
  virtual ClockSpec clock() const = 0;
  /// Samples the lanes in `tick.due`. `exact`: exact observation of the plant.
  virtual void Sample(const Tick& tick, const Observation& exact) = 0;
  /// Returns the observation for the controllers; valid until the next sample.
  virtual const Observation& seen() const = 0;
  virtual void Restart(int lane, const RolloutWorld& world) { (void)lane, (void)world; }
  /// See `Controller::Serialize`.
  virtual void Serialize(plant::LaneState& state) { (void)state; }
};

using ControllerFactory = std::function<std::unique_ptr<Controller>(const ControlSetup&)>;

/// Custom controllers and sensors. The controllers act in this order after the experiment's
/// controllers and may override their commands. The input of the sensors is the output of the
/// experiment's sensors. Factories are called once per plant, from the thread that runs it.
struct Extensions {
  std::vector<ControllerFactory> controllers;
  std::function<std::unique_ptr<SensorModel>(const ControlSetup&)> sensors;
};

/// Returns factories of taut's controllers for a specification as in an experiment file, for
/// `Extensions::controllers`. The specification contains a gait, a control law, or both. The
/// parameters are the same in all variants. The cable indices in `spec` must refer to the robot of
/// the simulation.
std::vector<ControllerFactory> ControllersOf(const ControllerSpec& spec);

using Brought [[deprecated("Extensions")]] = Extensions;

}  // namespace taut
