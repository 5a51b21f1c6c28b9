/// Simulation of an experiment with its start, controllers, sensors and events. A program can step,
/// read and command its one or many worlds.
///
///   taut::Diagnostics found;
///   const auto sim = taut::Simulation::Load("experiments/push_20n.yaml", {}, {}, found);
///   if (!sim) return std::fputs(found.Format().c_str(), stderr), 1;
///   sim->RunUntil(1.0);
///   std::printf("%g N\n", sim->Cable("outer_right_1").tension_n);
///
/// While the program changes nothing, the results of a world are bit-identical to `RunExperiment`
/// (taut/run.h). Other worlds, the number of threads and the instruction set do not affect these
/// results.
///
/// Related classes: `WorldBatch` (taut/world_batch.h) steps a model without controllers and events.
/// `Rollouts` (taut/rollout.h) score many variants from start to end. `Env` (taut/env.h) is a
/// reinforcement-learning environment.
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
  std::span<const RolloutWorld> variants = {};  ///< One world per variant; replaces `worlds`.
  int threads = 1;                              ///< Number of threads; 0: one per core.
  std::optional<Simd> simd = {};                ///< See `WorldBatchOptions`.
  Extensions extensions = {};                   ///< Custom controllers and sensors.
  std::shared_ptr<const ContactFriction> friction = nullptr;  ///< Null: the law of the model.
  /// Called repeatedly during the preparation of the starts. Return false to cancel; `Create` then
  /// returns null.
  std::function<bool()> keep_going = {};
};

/// Element of a model, by name or index: "outer_top_1" or 3. A name is searched in each call; in
/// loops, use the index from taut/find.h. The name is not copied and must exist during the call.
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

/// Running simulation of an experiment.
///
/// Worlds are numbered from 0. `world`, the last argument of functions of a single world, defaults
/// to 0. Units and frames: see `WorldBatch`.
///
/// Errors: a nonexistent name or index is a programming error. The function prints it and the most
/// similar name to stderr and calls abort(). For names from users, call the functions of
/// taut/find.h, which return errors. Rest lengths, gains, forces, body states and values in
/// `commands` must be finite. A value that is not finite is rejected: the previous value remains.
/// Until `Reset` or `Restore`, `IsRunning` of the world then returns false and `StatusText`
/// describes the first rejected value.
///
/// Threads: a simulation has an internal thread pool. All functions, including const ones, need
/// exclusive access. Simulations are independent of each other.
class Simulation {
 public:
  /// Creates a simulation with all worlds at their starts. Returns null and adds diagnostics if the
  /// model does not compile, a start cannot be found (no equilibrium, overlapping bodies), `worlds`
  /// is below 1, or `record` selects nonexistent channels. Adds the same warnings as
  /// `RunExperiment`.
  static std::unique_ptr<Simulation> Create(const ExperimentSpec& experiment,
                                            const SimulationOptions& options, Diagnostics& out);
  /// Creates a simulation of a robot in its described pose, without controllers and events.
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
  /// Advances each world by one step of at most `step_s`. Steps end at the ticks of sensors and
  /// controllers, at the points of push profiles and at `duration_s`. Worlds can continue beyond
  /// `duration_s` of the experiment.
  void Step();
  /// Steps each world until its time is at least `time_s`. The last step is not shortened, so a
  /// world may end up to one step later. Each thread calls `keep_going` before each step of a
  /// group; it must be thread safe. Return false to stop the group.
  void RunUntil(double time_s, const std::function<bool()>& keep_going = {});
  double Time(int world = 0) const;  ///< Time since the start [s].
  /// Returns false if the state is not finite (the world is then frozen) or a command was rejected.
  bool IsRunning(int world = 0) const;

  // --- readings ----------------------------------------------------------------------------------
  CableState Cable(const ElementRef& cable, int world = 0) const;
  BodyState Body(const ElementRef& body, int world = 0) const;
  Vec3 NodePosition(const ElementRef& node, int world = 0) const;
  Vec3 NodeVelocity(const ElementRef& node, int world = 0) const;
  JointState Joint(const ElementRef& joint, int world = 0) const;
  MotionState Motion(const ElementRef& motion, int world = 0) const;
  /// Returns the state of a cable's motor. Only for cables with a `dc_motor`.
  MotorState Motor(const ElementRef& cable, int world = 0) const;
  Energy TotalEnergy(int world = 0) const;
  std::vector<ContactState> Contacts(int world = 0) const;
  WorldStatus Status(int world = 0) const;
  /// Returns a description of the status and of the first rejected command, with the names of the
  /// affected body and cable. Empty without problems.
  std::string StatusText(int world = 0) const;
  /// Returns the hash of the state; equal to `RunSummary::state_hash` after the same run.
  std::uint64_t Hash(int world = 0) const;

  // --- commands ----------------------------------------------------------------------------------
  /// Commands the rest length [m] of a cable. From this call on, a position controller of the cable
  /// holds this length instead of following its program. Other controllers of the cable overwrite
  /// it at their next tick.
  void SetRestLength(const ElementRef& cable, double rest_length_m, int world = 0);
  double RestLengthCommand(const ElementRef& cable, int world = 0) const;
  void SetMode(const ElementRef& cable, CommandMode mode, int world = 0);
  /// Returns the gains of a cable under impedance control; nothing for other cables.
  std::optional<ImpedanceGains> Gains(const ElementRef& cable, int world = 0) const;
  /// Sets the gains of the cable with index `gains.cable`. Returns false without a change if the
  /// cable is not under impedance control or a gain is not finite.
  bool SetGains(const ImpedanceGains& gains, int world = 0);
  /// Sets an external force on a node [N], in W, from the next step. The force adds to pushes and
  /// drags of the experiment, and acts until it is changed or the world is reset.
  void SetNodeForce(const ElementRef& node, const Vec3& force_n, int world = 0);
  /// Replaces all external forces set by the program.
  void SetExternalForces(std::span<const ExternalForce> forces, int world = 0);
  /// Returns the nonzero forces of pushes and drags in the last step and the forces set by the
  /// program.
  std::vector<ExternalForce> ExternalForces(int world = 0) const;

  // --- state and parameters ----------------------------------------------------------------------
  /// See `WorldBatch::SetBodyState`.
  void SetBodyState(const ElementRef& body, const BodyState& state, int world = 0);
  /// Returns a parameter. `of`: a body or a cable, depending on the parameter. `of` is ignored for
  /// parameters of the whole world.
  double GetParameter(Parameter parameter, const ElementRef& of, int world = 0) const;
  /// Sets a parameter. Returns false and changes nothing if the value is invalid
  /// (`WorldBatch::ParameterError` returns the reason).
  bool SetParameter(Parameter parameter, const ElementRef& of, double value, int world = 0);

  /// Resets a world to its start.
  void Reset(int world = 0);
  /// Replaces the variant of a world and resets the world to the start of the new variant. If this
  /// start cannot be found, returns false, adds an error and changes nothing.
  bool Reset(const RolloutWorld& variant, Diagnostics& out, int world = 0);
  /// Serializes a world with its clocks, controllers, sensors and external forces. Custom
  /// controllers and sensors are included if they implement `Serialize`.
  std::vector<std::uint8_t> Save(int world = 0);
  /// Restores a serialized world into any world of a simulation with the same experiment and
  /// extensions. The continuation is bit-identical. The variant of the snapshot must have been
  /// passed to the simulation at its creation or to `Reset`. Otherwise, or if the snapshot is
  /// damaged or from another experiment or other controllers, returns false, adds an error and
  /// changes nothing.
  bool Restore(std::span<const std::uint8_t> snapshot, Diagnostics& out, int world = 0);

  // --- recording ---------------------------------------------------------------------------------
  /// Returns the channels selected by `record` of the experiment.
  const std::vector<ChannelInfo>& channels() const noexcept;
  /// Returns the current values of `channels()`; valid until the next call for a world of the same
  /// group.
  const std::vector<double>& Row(int world = 0);
  /// Records a world: appends the current row to a writer of `channels()`, then further rows at
  /// `record.rate_hz`. Null ends the recording; so do `Reset` and `Restore` of the world. The
  /// caller then finishes and destroys the writer. After a failure (`TraceWriter::error`), a writer
  /// receives no more rows.
  void Record(TraceWriter* writer, int world = 0);

  // --- groups of worlds that share a SIMD register -----------------------------------------------
  int groups() const noexcept;
  /// Worlds per group. World w is lane w % lanes() of group w / lanes().
  int lanes() const noexcept;
  /// Returns the observation of all lanes of a group; valid until the next step.
  const Observation& Observe(int group = 0) const;
  Commands& commands(int group = 0);
  /// Returns the worlds of a group, for recorders and displays.
  const World& world(int group = 0) const;
  /// Returns the batch of a group, for readings that this class lacks. World j of the batch is lane
  /// j. Do not step the batch; step the simulation.
  WorldBatch& batch(int group = 0);

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
