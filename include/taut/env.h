/// Vectorized reinforcement-learning environments: thousands of worlds of one experiment with
/// actions, observations and rewards (docs/environments.md). Each world has a separate episode and
/// clock. Worlds are SIMD lanes; a thread pool steps groups of lanes. The results of a world depend
/// only on its seed and its actions, bit for bit. Other worlds, the number of threads, the
/// instruction set, and `float` or `double` arrays do not change them. With zero actions, the
/// results equal `RunExperiment` of the world's `Env::Experiment`, bit for bit.
///
/// Arrays are row-major, with one row per world. `action_channels()` and `observation_channels()`
/// describe the columns.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "taut/world_batch.h"

namespace taut {

/// Time at which a world starts its next episode, as in Gymnasium's `AutoresetMode`.
enum class Autoreset {
  kNextStep,  ///< In the next step, which ignores the action and has reward 0.
  kSameStep,  ///< In the same step, which returns the first observation of the new episode.
  /// At the next `Reset`. Until then, the world continues with zero actions and rewards.
  kDisabled,
};

/// Reason for the end of an episode.
enum class EpisodeEnd : std::uint8_t {
  kNone,  ///< The episode is running.
  kTime,  ///< Truncation after `duration_s` of the experiment. All other ends are terminations.
  kFell,  ///< Fall as defined by the `FallSpec` of the reward.
  kNotFinite,    ///< The state is not finite. The world keeps its last finite state.
  kTooFast,      ///< A body is faster than `max_speed_m_per_s` of the reward.
  kFellOff,      ///< A body is below all of the terrain.
  kTooTense,     ///< A cable's tension exceeds `max_tension_n`.
  kWrongAction,  ///< A component of the action was not finite; 0 was used instead.
  /// A callback ended the episode or returned a reward that is not finite, replaced by 0.
  kCalled,
};
/// Returns whether an episode failed: any end except time and a fall.
constexpr bool Failed(EpisodeEnd end) noexcept { return end > EpisodeEnd::kFell; }

/// State of a running or finished episode.
struct EpisodeState {
  std::uint64_t seed = 0;  ///< Seed after the modulo by `EnvironmentVariation::starts`.
  std::int64_t steps = 0;  ///< Number of actions.
  double reward = 0;       ///< Sum of the rewards of all steps.
  EpisodeEnd end = EpisodeEnd::kNone;
};

class Env;

/// View of all worlds for callbacks. Only the arrays with the element type of the `Step` or `Reset`
/// call (`f32` or `f64`) are filled; the others are empty.
struct EnvView {
  const Env& env;
  std::span<const std::uint8_t> rows;  ///< Per world: whether its row is valid.
  std::span<float> observations_f32;   ///< Shape (worlds, observations); writable.
  std::span<double> observations_f64;
  // The next four are filled only in calls of `judge`.
  std::span<const float> actions_f32;  ///< Shape (worlds, actions), as passed to `Step`.
  std::span<const double> actions_f64;
  std::span<double> rewards;           ///< Shape (worlds); writable.
  std::span<std::uint8_t> terminated;  ///< Shape (worlds); may be set to 1.
};

struct EnvOptions {
  int worlds = 1;
  int threads = 1;                ///< Number of threads; 0: one per core.
  std::optional<Simd> simd = {};  ///< Absent: `BestSimd()`; scalar for a single world.
  Autoreset autoreset = Autoreset::kNextStep;
  bool randomise = true;  ///< False disables domain randomization (`randomise`).
  /// World i starts with this seed plus i. Absent: the seed of the experiment.
  std::optional<std::uint64_t> seed = {};
  /// Number of custom observations after the observed channels, filled by `observe`.
  int own_observations = 0;
  /// Called on the thread of `Step` or `Reset` when rows contain new channel observations. The
  /// callback may also change the channel observations. Values that are not finite become 0.
  std::function<void(const EnvView&)> observe = {};
  /// Called in every step after `observe` and before new episodes begin, for the worlds that
  /// applied their action. `rewards` contains the rewards of the experiment's objective.
  std::function<void(const EnvView&)> judge = {};
  /// Called about ten times per second during the physics of `Step`, on the thread of the caller.
  /// Return false to stop the step.
  std::function<bool()> keep_going = {};
};

/// Output arrays of a step. A span of wrong size aborts the program, like a wrong index in
/// `WorldBatch`. All values are finite.
template <class T>
struct EnvStep {
  std::span<T> observations;           ///< Shape (worlds, observations).
  std::span<double> rewards;           ///< Shape (worlds).
  std::span<std::uint8_t> terminated;  ///< Shape (worlds): 0 or 1.
  std::span<std::uint8_t> truncated;   ///< Shape (worlds): 0 or 1.
  /// (worlds, observations): last observations of ended episodes. Required with `kSameStep`, unused
  /// otherwise.
  std::span<T> final_observations = {};
};

/// Checks the section `environment` of the experiment. Adds an error per fault and returns false if
/// there are any. Conditions: the section exists; its channels exist; its period is a whole
/// multiple of the step and of all clocks; `duration_s` is a whole multiple of the period; all
/// events are at steps of the environment.
bool CheckEnvironment(const ExperimentSpec& experiment, Diagnostics& out);

/// Loads an experiment like `LoadExperiment`. If loading fails, it also reports nonexistent
/// channels in `record` and `environment`, so that all errors appear at once. This works only if
/// the valid part of the file suffices to find the channels. If loading succeeds, it does not check
/// the channels: call `CheckRecord` and `CheckEnvironment`.
std::optional<ExperimentSpec> LoadExperimentAndChannels(const std::string& path,
                                                        const Overrides& overrides,
                                                        Diagnostics& out);

/// Returns the channels observed by the environment of a valid experiment, in order.
std::vector<ChannelInfo> ObservedChannels(const ExperimentSpec& experiment);

/// Vectorized environment.
///
/// Threads: only one thread at a time may call non-const functions; any number may call const
/// functions. Different environments are independent. Each has an internal thread pool. A step that
/// starts no episode allocates no memory, unless observed channels collect contacts, loads or parts
/// of cables.
class Env {
 public:
  /// Creates an environment in which each world starts an episode. Returns null and adds
  /// diagnostics if `CheckEnvironment` fails, the model does not compile, or a start is invalid.
  static std::unique_ptr<Env> Create(const ExperimentSpec& experiment, const EnvOptions& options,
                                     Diagnostics& out);
  virtual ~Env() = default;

  virtual int worlds() const noexcept = 0;
  virtual int lanes() const noexcept = 0;
  /// Returns names and units of the action components, such as cable/NAME/rest_length_m. Components
  /// are clipped to -1..1.
  virtual const std::vector<ChannelInfo>& action_channels() const noexcept = 0;
  /// Returns, for each action component, the change that an action of 1 causes, in the unit of the
  /// channel.
  virtual const std::vector<double>& action_scales() const noexcept = 0;
  /// Returns the observed trace channels, followed by the custom ones: own/0, own/1 ...
  virtual const std::vector<ChannelInfo>& observation_channels() const noexcept = 0;
  virtual double period_s() const noexcept = 0;
  virtual std::int64_t episode_steps() const noexcept = 0;  ///< Steps until truncation.

  /// Starts new episodes in all worlds, or in those with `mask` != 0, and writes their rows of
  /// `observations` (worlds, observations). `seeds`: one per world; if empty, each world derives
  /// its next seed from its last one. Returns false and adds diagnostics if a seed has no valid
  /// start; the affected world keeps its present episode.
  virtual bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                     std::span<float> observations, Diagnostics& out) = 0;
  virtual bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                     std::span<double> observations, Diagnostics& out) = 0;

  /// Advances all worlds by one period with `actions` (worlds, actions). Automatic resets skip
  /// seeds without a valid start; after eight such seeds in a row, the last episode starts again.
  /// Returns false if `keep_going` stopped the step. `out` is then undefined, worlds are at
  /// different times, and further steps return false until all worlds are reset.
  virtual bool Step(std::span<const float> actions, const EnvStep<float>& out) = 0;
  virtual bool Step(std::span<const double> actions, const EnvStep<double>& out) = 0;

  /// Serializes a world and its episode: state, clocks, memory of controllers, sensors and rewards,
  /// and delayed actions and observations. For searches that continue one state in several ways.
  virtual std::vector<std::uint8_t> Save(int world) = 0;
  /// Restores a serialized world, which then continues with bit-identical results. The target may
  /// be any world of an environment with the same experiment and options; numbers of worlds and
  /// threads, SIMD registers and seeds may differ. If the snapshot is damaged or from another
  /// experiment, returns false, adds an error and changes nothing.
  virtual bool Restore(int world, std::span<const std::uint8_t> snapshot, Diagnostics& out) = 0;

  virtual EpisodeState Episode(int world) const = 0;  ///< The present episode.
  virtual EpisodeState Last(int world) const = 0;     ///< The previous episode; 0 steps: none.
  /// Returns the present episode as an experiment, including its random factors, start, slope and
  /// seed.
  virtual ExperimentSpec Experiment(int world) const = 0;
  virtual double Time(int world) const = 0;  ///< Since the start of the episode [s].
  virtual BodyState Body(int world, int body) const = 0;
  virtual CableState Cable(int world, int cable) const = 0;
  virtual WorldStatus Status(int world) const = 0;
  virtual std::uint64_t Hash(int world) const = 0;
};

}  // namespace taut
