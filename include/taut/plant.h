/// The wall between what controls and what is controlled: an observation in, a command out, a
/// clock. Who controls, records, learns or shows sees a plant and cannot tell whether a simulated
/// world, the worlds that share a register, a log or a robot is behind it. A plant may be several
/// robots alike, side by side: its lanes. One robot is one lane.
///
/// Rows hold cable c of lane j at [c * lanes + j].
///
/// Threads: whoever moves a plant on has it, its controllers and its sensors for himself. Plants do
/// not know of each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "taut/batch.h"
#include "taut/cable_readings.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut {

namespace plant {
class LaneState;
}

/// Some lanes: lane j is bit j.
using Lanes = std::uint32_t;

constexpr bool Has(Lanes lanes, int lane) noexcept { return (lanes >> lane & 1u) != 0; }
constexpr Lanes AllLanes(int count) noexcept { return static_cast<Lanes>((1ull << count) - 1); }

// --- what is seen -------------------------------------------------------------------------------

/// What is wrong with a cable's sensors or its actuator. Bits; 0 is good.
enum FaultBits : std::uint32_t {
  kFaultNone = 0,
  kFaultNoReading = 1u << 0,  ///< No reading came: the last one stands there.
  kFaultSensor = 1u << 1,     ///< A reading that cannot be true.
  kFaultActuator = 1u << 2,   ///< The actuator does not do what it was told.
};

/// Where bodies are, for those who know: a simulation, a log that has them; hardly a robot.
class Bodies {
 public:
  virtual ~Bodies() = default;
  virtual BodyState Body(int lane, int body) const = 0;
  virtual Vec3 NodePosition(int lane, int node) const = 0;  ///< [m], in W.
  virtual Vec3 NodeVelocity(int lane, int node) const = 0;  ///< [m/s], in W.
};

/// What is known of a plant at a moment. Points into the plant.
struct Observation {
  int lanes = 1;
  const double* time_s = nullptr;  ///< Of each lane's clock.
  ReadingRows cables;
  /// A row: what the shafts of motors say of the rest lengths, which differs from them where gears
  /// have backlash; null: nothing else.
  const double* shaft_m = nullptr;
  const std::uint32_t* faults = nullptr;  ///< `FaultBits`, a row; null: nobody looks for any.
  const Bodies* bodies = nullptr;         ///< Null: nobody knows.
  /// Two rows, x and y of lane j at [j] and [lanes + j]: the horizontal unit vector towards the
  /// goal, as a compass and a beacon say it (`GoalSpec`); null: nobody senses it.
  const double* goal = nullptr;

  CableState Cable(int cable, int lane = 0) const {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(cable) * lanes + lane;
    return MapReadings([at](const double* row) { return row[at]; }, cables);
  }
};

// --- what is commanded --------------------------------------------------------------------------

/// What a cable's actuator is to do.
enum class CommandMode : unsigned char {
  kRestLength,  ///< Go to `rest_length_m`.
  kTension,     ///< Bring the tension to `set_point_n`, if it has a law of its own for that, as a
                ///< board has; else go to `rest_length_m`.
  kHold,        ///< Stay where it is.
  kOff,         ///< No power: a `dc_motor` runs down, or its cable drives it back. What nothing can
                ///< turn from outside stays where it is.
};

/// What controllers say to the plant and to each other. Held until changed. Rows of the plant.
struct Commands {
  int lanes = 1;
  double* rest_length_m = nullptr;           ///< Set points of the rest lengths.
  double* set_point_n = nullptr;             ///< Of the tension, where a law has one; else 0.
  double* velocity_input_m_per_s = nullptr;  ///< V0 of that law, a gait's part included.
  double* signal = nullptr;     ///< What a gait says: a velocity [m/s] or a length [m]; else 0.
  CommandMode* mode = nullptr;  ///< At first `kRestLength`.
  /// Per lane: which of their gaits controllers play (`GaitInputSpec`); -1: as the experiment has
  /// it.
  int* gait = nullptr;
};

// --- what is controlled -------------------------------------------------------------------------

/// A simulation, and what nobody else knows or can do.
class World : public Bodies {
 public:
  virtual void SetNodeForce(int lane, int node, const Vec3& force_n) = 0;  ///< As `Batch` has it.
  virtual Vec3 NodeForce(int lane, int node) const = 0;
  virtual double BodyMass(int lane, int body) const = 0;  ///< [kg]
  virtual Energy TotalEnergy(int lane) const = 0;
  virtual MotorState Motor(int lane, int cable) const = 0;  ///< Of a cable with a `dc_motor`.
  virtual std::vector<ContactState> Contacts(int lane) const = 0;
  virtual double CableFrictionLoss(int lane, int cable) const = 0;  ///< As `Batch`:
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

class Plant {
 public:
  virtual ~Plant() = default;

  /// As it is now; valid until `Advance`.
  virtual const Observation& Observe() = 0;
  virtual Commands& commands() = 0;

  /// Moves every lane's clock on by `step_s[lane]`, to `to_s[lane]` (which is more exact than a
  /// sum), under the commands as they are. A simulation computes, a robot waits, a log turns pages.
  /// A lane whose step is 0 stands still.
  virtual void Advance(const double* step_s, const double* to_s) = 0;

  /// The lane's clock is at 0 again, its commands are those of a start. (Its state is who knows
  /// where: whoever calls has put it there.)
  virtual void Restart(int lane) = 0;

  /// A lane's clock and its commands, as a controller's `Carry`; its state is for who asks.
  virtual void Carry(plant::LaneState& state) { (void)state; }

  /// False: this lane goes on no more. Its state is not finite, its log is over, nobody answers.
  virtual bool Goes(int lane) const = 0;

  /// Null where the plant is no simulation.
  virtual World* world() noexcept { return nullptr; }
};

/// A simulated plant: the lanes of a batch of one group, whose clocks all start at 0. The batch
/// outlives it.
std::unique_ptr<Plant> PlantOf(Batch& batch);

/// A log as a plant of one lane: it shows what was recorded of the robot's cables
/// (`cable/NAME/...`) and, where all of them were, bodies; commands go nowhere. So a controller
/// says what it would have done. A quantity that a row lacks, or that is not finite there, stays
/// what it was, with `kFaultNoReading`. Times count from the first row. Trace and robot outlive it.
/// Null and a complaint if the log has no row, or nothing of these cables.
std::unique_ptr<Plant> ReplayOf(const Trace& trace, const RobotSpec& robot, Diagnostics& out);

// --- what a program may bring -------------------------------------------------------------------

/// Who acts in which lanes now.
struct Tick {
  Lanes due = 0;
  /// Per lane, how many ticks it had before since its start. 0: the first, what it remembers of
  /// the lane is of somebody else.
  const std::int64_t* number = nullptr;
};

/// What controllers and sensors are made for. The lanes' variants are there while they are made.
struct ControlSetup {
  const ExperimentSpec& experiment;
  std::span<const RolloutWorld* const> lanes;  ///< One variant of the experiment a lane.
};

/// A control law. It acts at the ticks of its own clock, which the physics step does not change,
/// and sees all lanes at once; what it writes for lanes that are not due is not kept from the
/// plant, so it writes to `tick.due` only.
class Controller {
 public:
  virtual ~Controller() = default;
  virtual ClockSpec clock() const = 0;
  virtual void Act(const Tick& tick, const Observation& seen, Commands& commands) = 0;
  /// A lane begins anew, as this variant. Its next tick is its first.
  virtual void Restart(int lane, const RolloutWorld& world) { (void)lane, (void)world; }
  /// A lane goes on under other numbers of these controllers, which are the experiment's otherwise:
  /// what it remembers stays, phases go on without a jump. Called before a tick; allocates nothing.
  virtual void Retune(int lane, const std::vector<ControllerSpec>& controllers) {
    (void)lane, (void)controllers;
  }
  /// What a lane remembers, for environments that save and restore theirs. (taut's own do.)
  virtual void Carry(plant::LaneState& state) { (void)state; }

  // --- what a person may change while it runs, in lane 0; a law that has none of it leaves it ---
  /// The gains of a cable, if it has such.
  virtual std::optional<ImpedanceGains> Gains(int cable) const { return (void)cable, std::nullopt; }
  virtual bool SetGains(const ImpedanceGains& gains) { return (void)gains, false; }
  /// Holds a cable at a rest length from the next tick on, whatever its program said.
  virtual bool Hold(int cable, double rest_length_m) {
    return (void)cable, (void)rest_length_m, false;
  }
};

/// What stands between a plant and its controllers. Samples at the ticks of its clock.
class SensorModel {
 public:
  virtual ~SensorModel() = default;
  virtual ClockSpec clock() const = 0;
  virtual void Sample(const Tick& tick, const Observation& exact) = 0;
  /// What the controllers see; valid until the next sample.
  virtual const Observation& seen() const = 0;
  virtual void Restart(int lane, const RolloutWorld& world) { (void)lane, (void)world; }
  virtual void Carry(plant::LaneState& state) { (void)state; }  ///< As a controller's.
};

/// Controllers that act after the experiment's own, in this order, and may overrule them; sensors
/// that see what the experiment's sensors show. Makers are called once for every plant, from the
/// thread that runs it.
struct Brought {
  std::vector<std::function<std::unique_ptr<Controller>(const ControlSetup&)>> controllers;
  std::function<std::unique_ptr<SensorModel>(const ControlSetup&)> sensors;
};

}  // namespace taut
