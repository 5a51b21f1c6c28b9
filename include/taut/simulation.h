/// Simulation of an experiment: the robot with its start, controllers, sensors and events, in one
/// or many worlds, stepped from a program that reads and commands it.
///
///   taut::Diagnostics found;
///   const auto sim = taut::Simulation::Load("experiments/push_20n.yaml", {}, {}, found);
///   if (!sim) return std::fputs(found.Format().c_str(), stderr), 1;
///   sim->RunUntil(1.0);
///   std::printf("%g N\n", sim->Cable("outer_right_1").tension_n);
///
/// A world has the bits of `RunExperiment` (taut/run.h), whatever the other worlds, the number of
/// threads and the instruction set, as long as the program changes nothing. Related classes:
/// `WorldBatch` (taut/world_batch.h) steps a model without controllers and events, `Rollouts`
/// (taut/rollout.h) score many variants from start to end, and `Env` (taut/env.h) is an environment
/// for reinforcement learning.
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
  int worlds = 1;                               ///< Worlds of the experiment as it is.
  std::span<const RolloutWorld> variants = {};  ///< One world per variant, instead of `worlds`.
  int threads = 1;                              ///< 0: one per core.
  std::optional<Simd> simd = {};                ///< As in `WorldBatchOptions`.
  Extensions extensions = {};                   ///< Custom controllers and sensors.
  std::shared_ptr<const ContactFriction> friction = nullptr;  ///< Null: the model's law.
  /// Polled while starts are prepared; once it returns false, `Create` returns null.
  std::function<bool()> keep_going = {};
};

/// Element of a model, by name or by index: "outer_top_1", 3. A name is looked up at each call;
/// `FindCable` and its relatives (taut/find.h) return the index for use in a loop.
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
/// Worlds are numbered from 0; `world` is the last argument of each function and defaults to the
/// first world. Units and frames are those of `WorldBatch`.
///
/// Errors: a name or an index that does not exist is a programming error: a line on stderr names it
/// and the closest name, and the program ends by abort(). Look up names that users enter with
/// taut/find.h.
///
/// Threads: it has an internal thread pool. Callers need exclusive access. Simulations are
/// independent of each other.
class Simulation {
 public:
  /// Brings all worlds to their start. Returns null, with diagnostics, if the model does not
  /// compile, a start does not exist, or `record` selects channels that do not exist. Warns as
  /// `RunExperiment` does.
  static std::unique_ptr<Simulation> Create(const ExperimentSpec& experiment,
                                            const SimulationOptions& options, Diagnostics& out);
  /// Creates a simulation of a robot without controllers and events, which starts as described.
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
  /// Advances each world by one step. Steps are at most `step_s` long and end at the ticks of
  /// sensors and controllers and at the corners of pushes. They continue after the experiment's
  /// `duration_s`.
  void Step();
  /// Steps each world whose time is less than `time_s` until it is not; the length of steps does
  /// not depend on `time_s`, so a world may stop up to one step later.
  /// `keep_going`, polled before each step of each group, by the thread that steps it: once it
  /// returns false, no group takes a further step.
  void RunUntil(double time_s, const std::function<bool()>& keep_going = {});
  double Time(int world = 0) const;  ///< [s], since the start.
  /// Returns false once a state is not finite; the world keeps its last state.
  bool IsRunning(int world = 0) const;

  // --- readings ----------------------------------------------------------------------------------
  CableState Cable(const ElementRef& cable, int world = 0) const;
  BodyState Body(const ElementRef& body, int world = 0) const;
  Vec3 NodePosition(const ElementRef& node, int world = 0) const;
  Vec3 NodeVelocity(const ElementRef& node, int world = 0) const;
  JointState Joint(const ElementRef& joint, int world = 0) const;
  MotionState Motion(const ElementRef& motion, int world = 0) const;
  MotorState Motor(const ElementRef& cable, int world = 0) const;  ///< Of a `dc_motor`.
  Energy TotalEnergy(int world = 0) const;
  std::vector<ContactState> Contacts(int world = 0) const;
  WorldStatus Status(int world = 0) const;
  /// Describes the status with the names of body and cable; empty if there is no problem.
  std::string StatusText(int world = 0) const;
  std::uint64_t Hash(int world = 0) const;  ///< Of the state, as `RunSummary::state_hash`.

  // --- commands ----------------------------------------------------------------------------------
  /// Commands a cable's rest length [m]. Position controllers keep it instead of their program;
  /// other controllers that drive the cable overwrite it at their next tick.
  void SetRestLength(const ElementRef& cable, double rest_length_m, int world = 0);
  double RestLengthCommand(const ElementRef& cable, int world = 0) const;
  void SetMode(const ElementRef& cable, CommandMode mode, int world = 0);
  /// Returns the gains of a cable under impedance control; nothing without.
  std::optional<ImpedanceGains> Gains(const ElementRef& cable, int world = 0) const;
  /// Sets the gains of the cable `gains.cable`. Returns false if it has none.
  bool SetGains(const ImpedanceGains& gains, int world = 0);
  /// Sets an external force on a node [N], in W, from the next step on, in addition to the
  /// experiment's pushes and drags. It acts until it is changed.
  void SetNodeForce(const ElementRef& node, const Vec3& force_n, int world = 0);
  /// Replaces all external forces that the program has set.
  void SetExternalForces(std::span<const ExternalForce> forces, int world = 0);
  /// Returns the forces of the last step by pushes and drags, without zeros, and the forces that
  /// the program has set.
  std::vector<ExternalForce> ExternalForces(int world = 0) const;

  // --- state and parameters ----------------------------------------------------------------------
  /// As `WorldBatch::SetBodyState`.
  void SetBodyState(const ElementRef& body, const BodyState& state, int world = 0);
  /// `of`: a body or a cable; ignored for parameters of the whole world.
  double GetParameter(Parameter parameter, const ElementRef& of, int world = 0) const;
  /// Returns false and changes nothing if `WorldBatch::ParameterError` has a reason.
  bool SetParameter(Parameter parameter, const ElementRef& of, double value, int world = 0);

  /// Brings a world back to its start.
  void Reset(int world = 0);
  /// Brings a world to the start of another variant. Returns false, with an error and without a
  /// change, if it has none.
  bool Reset(const RolloutWorld& variant, Diagnostics& out, int world = 0);
  /// Serializes a world with its clocks, controllers and sensors. Custom controllers and sensors
  /// take part by `Serialize`.
  std::vector<std::uint8_t> Save(int world = 0);
  /// Restores a serialized world, with its variant, into any world of a simulation of the same
  /// experiment and extensions; the continuation is bit-identical. Returns false, with an error and
  /// without a change, if the snapshot is damaged, of another experiment or of other controllers.
  bool Restore(std::span<const std::uint8_t> snapshot, Diagnostics& out, int world = 0);

  // --- recording ---------------------------------------------------------------------------------
  /// Returns the channels that the experiment's `record` selects.
  const std::vector<ChannelInfo>& channels() const noexcept;
  /// Returns their present values; valid until the next call.
  const std::vector<double>& Row(int world = 0);
  /// Appends the present row, and from now on each row that is due by `record.rate_hz`, to a
  /// writer of `channels()`; null ends the recording, as `Reset` and `Restore` of the world do. The
  /// caller finishes and destroys the writer after that. A failed writer gets no more rows; see
  /// `TraceWriter::error`.
  void Record(TraceWriter* writer, int world = 0);

  // --- groups: worlds that share a SIMD register, for controllers and learners -------------------
  int groups() const noexcept;
  int lanes() const noexcept;  ///< Worlds of a group; world w is lane w % lanes of w / lanes.
  /// Returns the observation of all lanes of a group; valid until the next step.
  const Observation& Observe(int group = 0) const;
  Commands& commands(int group = 0);
  /// Returns the worlds of a group, for recorders and displays.
  const World& world(int group = 0) const;
  /// Returns the batch of a group, whose worlds are the lanes, for all other readings. Step the
  /// simulation, not the batch.
  WorldBatch& batch(int group = 0);

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
