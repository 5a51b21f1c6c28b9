/// Simulation of an experiment: the robot with its start, controllers, sensors and events, in one
/// or many worlds. A program steps, reads and commands it.
///
///   taut::Diagnostics found;
///   const auto sim = taut::Simulation::Load("experiments/push_20n.yaml", {}, {}, found);
///   if (!sim) return std::fputs(found.Format().c_str(), stderr), 1;
///   sim->RunUntil(1.0);
///   std::printf("%g N\n", sim->Cable("outer_right_1").tension_n);
///
/// As long as the program changes nothing, the results of a world are bit-identical to
/// `RunExperiment` (taut/run.h), independent of the other worlds, the number of threads and the
/// instruction set.
/// Related classes: `WorldBatch` (taut/world_batch.h) steps a model without controllers and events,
/// `Rollouts` (taut/rollout.h) score many variants from start to end, and `Env` (taut/env.h) is an
/// environment for reinforcement learning.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "taut/plant.h"
#include "taut/trace.h"
#include "taut/world_batch.h"

namespace taut {

struct SimulationOptions {
  int worlds = 1;                               ///< Number of identical worlds.
  std::span<const RolloutWorld> variants = {};  ///< One world per variant, instead of `worlds`.
  int threads = 1;                              ///< 0: one per core.
  std::optional<Simd> simd = {};                ///< As in `WorldBatchOptions`.
  Extensions extensions = {};                   ///< Custom controllers and sensors.
  std::shared_ptr<const ContactFriction> friction = nullptr;  ///< Null: the model's law.
  /// Polled while the starts are computed; once it returns false, `Create` returns null.
  std::function<bool()> keep_going = {};
};

/// Element of a model, by name or by index: "outer_top_1" or 3. Each call looks the name up; in
/// loops use the index, which the functions of taut/find.h return. A name is not copied and must
/// exist during the call.
class ElementRef {
 public:
  template <class Integer>
  requires std::is_integral_v<Integer> ElementRef(Integer index)
      : index_(std::in_range<int>(index) ? static_cast<int>(index)
                                         : std::numeric_limits<int>::max()) {}
  ElementRef(std::string_view name) : name_(name) {}
  ElementRef(const char* name) : name_(name) {}
  ElementRef(const std::string& name) : name_(name) {}

  bool has_name() const noexcept { return index_ < 0 && name_.data() != nullptr; }
  std::string_view name() const noexcept { return name_; }
  int index() const noexcept { return index_; }

 private:
  std::string_view name_;
  int index_ = -1;
};

/// Running simulation.
///
/// Worlds are numbered from 0. `world`, the last argument of functions of a single world, defaults
/// to the first one. Units and frames are those of `WorldBatch`.
///
/// Errors: a name or an index that does not exist is a programming error: the function prints it
/// and the closest name to stderr and calls abort(). For names that users enter, use taut/find.h,
/// which reports errors instead. A rest length, gain, force, state of a body or value in `commands`
/// that is not finite, from the program or a custom controller, is refused: the previous value
/// stays, `IsRunning` of its world returns false, and `StatusText` contains the name, until `Reset`
/// or `Restore`.
///
/// Threads: a simulation has an internal thread pool. All functions, const ones too, need exclusive
/// access. Simulations are independent of each other.
class Simulation {
 public:
  /// Creates a simulation with all worlds at their start. Returns null, with diagnostics, if the
  /// model does not compile, a start cannot be found (no equilibrium, overlapping bodies), `worlds`
  /// is below 1, or `record` selects channels that do not exist. Warns as `RunExperiment` does.
  static std::unique_ptr<Simulation> Create(const ExperimentSpec& experiment,
                                            const SimulationOptions& options, Diagnostics& out);
  /// Creates a simulation of a robot without controllers and events, which starts in the described
  /// pose.
  static std::unique_ptr<Simulation> Create(const RobotSpec& robot,
                                            const SimulationOptions& options, Diagnostics& out);
  /// Creates a simulation of an experiment file or a model file.
  static std::unique_ptr<Simulation> Load(const std::string& path, const Overrides& overrides,
                                          const SimulationOptions& options, Diagnostics& out);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const ExperimentSpec& experiment() const noexcept;
  const ModelDef& def() const noexcept;
  int worlds() const noexcept;

  // --- time --------------------------------------------------------------------------------------
  /// Advances each world by one step. Steps are at most `step_s` long. They end at the ticks of
  /// sensors and controllers, at the corners of push profiles and at `duration_s`. Worlds can be
  /// stepped beyond the experiment's `duration_s`.
  void Step();
  /// Steps each world until its time is at least `time_s`. Steps are not shortened to end there, so
  /// a world may stop up to one step later. Each thread polls `keep_going` before each step of a
  /// group, so it must be thread-safe; a group for which it returns false takes no further step.
  void RunUntil(double time_s, const std::function<bool()>& keep_going = {});
  double Time(int world = 0) const;  ///< [s], since the start.
  /// Returns false once the state is not finite (the world is then frozen) or a command was
  /// refused.
  bool IsRunning(int world = 0) const;

  // --- readings ----------------------------------------------------------------------------------
  CableState Cable(const ElementRef& cable, int world = 0) const;
  BodyState Body(const ElementRef& body, int world = 0) const;
  Vec3 NodePosition(const ElementRef& node, int world = 0) const;
  Vec3 NodeVelocity(const ElementRef& node, int world = 0) const;
  JointState Joint(const ElementRef& joint, int world = 0) const;
  MotionState Motion(const ElementRef& motion, int world = 0) const;
  /// The cable needs a `dc_motor`.
  MotorState Motor(const ElementRef& cable, int world = 0) const;
  Energy TotalEnergy(int world = 0) const;
  std::vector<ContactState> Contacts(int world = 0) const;
  WorldStatus Status(int world = 0) const;
  /// Returns a description of the status and of the first refused command, with the names of the
  /// affected body and cable; empty if there is no problem.
  std::string StatusText(int world = 0) const;
  std::uint64_t Hash(int world = 0) const;  ///< As `RunSummary::state_hash`.

  // --- commands ----------------------------------------------------------------------------------
  /// Commands a cable's rest length [m]. A position controller of the cable holds it instead of
  /// following its program; other controllers of the cable overwrite it at their next tick.
  void SetRestLength(const ElementRef& cable, double rest_length_m, int world = 0);
  double RestLengthCommand(const ElementRef& cable, int world = 0) const;
  void SetMode(const ElementRef& cable, CommandMode mode, int world = 0);
  /// Returns the gains of a cable under impedance control; nothing for other cables.
  std::optional<ImpedanceGains> Gains(const ElementRef& cable, int world = 0) const;
  /// Sets the gains of the cable with index `gains.cable`. Returns false, without a change, if it
  /// is not under impedance control or a gain is not finite.
  bool SetGains(const ImpedanceGains& gains, int world = 0);
  /// Sets an external force on a node [N], in W, from the next step on. It adds to the experiment's
  /// pushes and drags, and acts until it is changed or the world is reset.
  void SetNodeForce(const ElementRef& node, const Vec3& force_n, int world = 0);
  /// Replaces all external forces that the program has set.
  void SetExternalForces(std::span<const ExternalForce> forces, int world = 0);
  /// Returns the nonzero forces by pushes and drags in the last step, and the forces that the
  /// program has set.
  std::vector<ExternalForce> ExternalForces(int world = 0) const;

  // --- state and parameters ----------------------------------------------------------------------
  /// As `WorldBatch::SetBodyState`.
  void SetBodyState(const ElementRef& body, const BodyState& state, int world = 0);
  /// Returns a parameter. `of`: a body or a cable, depending on the parameter; ignored for
  /// parameters of the whole world.
  double GetParameter(Parameter parameter, const ElementRef& of, int world = 0) const;
  /// Sets a parameter. Returns false and changes nothing if the value is invalid
  /// (`WorldBatch::ParameterError` returns the reason).
  bool SetParameter(Parameter parameter, const ElementRef& of, double value, int world = 0);

  /// Brings a world back to its start.
  void Reset(int world = 0);
  /// Replaces the variant of a world and brings the world to the start of the new one. Returns
  /// false, with an error and without a change, if this start cannot be found.
  bool Reset(const RolloutWorld& variant, Diagnostics& out, int world = 0);
  /// Serializes a world with its clocks, controllers, sensors and external forces. The memory of
  /// custom controllers and sensors is included if they implement `Serialize`.
  std::vector<std::uint8_t> Save(int world = 0);
  /// Restores a serialized world into any world of a simulation of the same experiment and
  /// extensions; the continuation is bit-identical. The variant of the snapshot must be one of
  /// the simulation, from its creation or set by `Reset`. Returns false, with an error and without
  /// a change, if it is not, or if the snapshot is damaged or belongs to another
  /// experiment or to other controllers.
  bool Restore(std::span<const std::uint8_t> snapshot, Diagnostics& out, int world = 0);

  // --- recording ---------------------------------------------------------------------------------
  /// Returns the channels that the experiment's `record` selects.
  const std::vector<ChannelInfo>& channels() const noexcept;
  /// Returns the present values of `channels()`; valid until the next call for a world of the same
  /// group.
  const std::vector<double>& Row(int world = 0);
  /// Records a world: appends the present row to a writer of `channels()`, and further rows at
  /// `record.rate_hz`. Null ends the recording, as `Reset` and `Restore` of the world do; the
  /// caller then finishes and destroys the writer. A writer that failed receives no more rows
  /// (`TraceWriter::error`).
  void Record(TraceWriter* writer, int world = 0);

  // --- groups of worlds that share a SIMD register -----------------------------------------------
  int groups() const noexcept;
  int lanes() const noexcept;  ///< Worlds per group; world w is lane w % lanes of group w / lanes.
  /// Returns the observation of all lanes of a group; valid until the next step.
  const Observation& Observe(int group = 0) const;
  Commands& commands(int group = 0);
  /// Returns the worlds of a group, for recorders and displays.
  const World& world(int group = 0) const;
  /// Returns the batch of a group, for readings that this class lacks; world j of the batch is lane
  /// j. Step the simulation, not the batch.
  WorldBatch& batch(int group = 0);

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
