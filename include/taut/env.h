/// Vectorized reinforcement-learning environments: thousands of worlds of one experiment, each in a
/// separate episode, with actions, observations and rewards (docs/environments.md). Worlds are SIMD
/// lanes with separate clocks; groups of lanes run on a thread pool. The bits of a world depend
/// only on its seed and its actions, not on other worlds, the number of threads, the instruction
/// set, or `float` or `double` arrays. With actions of zero they equal the bits of `RunExperiment`
/// of `Env::Experiment`.
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

/// Start of the next episode after the end of one, as in Gymnasium's `AutoresetMode`.
enum class Autoreset {
  kNextStep,  ///< In the next step, which ignores its action and has reward 0.
  kSameStep,  ///< In the same step, which returns the first observation of the next episode.
  kDisabled,  ///< At a call of `Reset`. Until then the world runs on with actions and rewards of 0.
};

/// Reason for the end of an episode.
enum class EpisodeEnd : std::uint8_t {
  kNone,         ///< The episode is running.
  kTime,         ///< Truncation after the experiment's `duration_s`. All others are terminations.
  kFell,         ///< A fall by the reward's `FallSpec`.
  kNotFinite,    ///< The state is not finite. The world keeps its last finite state.
  kTooFast,      ///< A body is faster than `max_speed_m_per_s` of the reward.
  kFellOff,      ///< A body is below all of its terrain.
  kTooTense,     ///< A cable's tension exceeds `max_tension_n`.
  kWrongAction,  ///< A number of the action was not finite; it counted as 0.
  kCalled,  ///< A callback ended it, or returned a reward that is not finite, which counts as 0.
};
/// Returns whether the end is a failure: any but time and a fall.
constexpr bool Failed(EpisodeEnd end) noexcept { return end > EpisodeEnd::kFell; }

/// State of a running or finished episode.
struct EpisodeState {
  std::uint64_t seed = 0;  ///< Effective seed (modulo `EnvironmentVariation::starts`).
  std::int64_t steps = 0;  ///< Number of actions.
  double reward = 0;       ///< Sum over all steps.
  EpisodeEnd end = EpisodeEnd::kNone;
};

class Env;

/// View of all worlds for callbacks. Of the `f32` and `f64` arrays, only the type that the caller
/// of `Step` or `Reset` uses is filled; the other one is empty.
struct EnvView {
  const Env& env;
  std::span<const std::uint8_t> rows;  ///< Per world: whether its row is valid.
  std::span<float> observations_f32;   ///< (worlds, observations): may be written.
  std::span<double> observations_f64;
  // Only in `judge`:
  std::span<const float> actions_f32;  ///< (worlds, actions), as the caller gave them.
  std::span<const double> actions_f64;
  std::span<double> rewards;           ///< (worlds): may be written.
  std::span<std::uint8_t> terminated;  ///< (worlds): may be set to 1.
};

struct EnvOptions {
  int worlds = 1;
  int threads = 1;                ///< 0: one per core.
  std::optional<Simd> simd = {};  ///< Absent: `BestSimd()`, or scalar for a single world.
  Autoreset autoreset = Autoreset::kNextStep;
  bool randomise = true;  ///< False: no domain randomization (`randomise`).
  /// World i starts with this seed plus i; absent: the experiment's seed.
  std::optional<std::uint64_t> seed = {};
  /// Number of custom observations, behind the channels; `observe` fills them.
  int own_observations = 0;
  /// Called on the thread of `Step` or `Reset` when rows have new observations of channels; may
  /// change them, too. Values that are not finite count as 0.
  std::function<void(const EnvView&)> observe = {};
  /// Called in every step after `observe` and before new episodes begin, for the rows that took
  /// their action. `rewards` contains the rewards by the experiment's objective.
  std::function<void(const EnvView&)> judge = {};
  /// Polled about ten times a second during the physics steps of `Step`, on the caller's thread.
  /// Return false to stop the step.
  std::function<bool()> keep_going = {};
};

/// Output arrays of a step. A span of the wrong size is a programming error and ends the program,
/// like a wrong index in `WorldBatch`. All values are finite.
template <class T>
struct EnvStep {
  std::span<T> observations;           ///< (worlds, observations)
  std::span<double> rewards;           ///< (worlds)
  std::span<std::uint8_t> terminated;  ///< (worlds): 0 or 1.
  std::span<std::uint8_t> truncated;   ///< (worlds): 0 or 1.
  /// (worlds, observations); required with `kSameStep`, unused otherwise: last observations of
  /// worlds whose episode is over.
  std::span<T> final_observations = {};
};

/// Checks the experiment's `environment`: it is present, its channels exist, and its period is a
/// whole multiple of the step and of all clocks and divides `duration_s`, with all events on its
/// steps. Returns false and adds an error for each fault.
bool CheckEnvironment(const ExperimentSpec& experiment, Diagnostics& out);

/// Loads an experiment like `LoadExperiment`. If that fails, nonexistent channels in `record` and
/// `environment` are reported as well, where the readable part of the file suffices to find them.
/// (If it succeeds, `CheckRecord` and `CheckEnvironment` report them.)
std::optional<ExperimentSpec> LoadExperimentAndChannels(const std::string& path,
                                                        const Overrides& overrides,
                                                        Diagnostics& out);

/// Returns the channels that an experiment's environment observes, in order. The experiment must be
/// valid.
std::vector<ChannelInfo> ObservedChannels(const ExperimentSpec& experiment);

/// Vectorized environment.
///
/// Threads: it has an internal thread pool. Callers: one thread at a time, any number in const
/// functions. Environments are independent of each other. A step without the start of an episode
/// allocates no memory, unless observed channels collect contacts, loads or parts of cables.
class Env {
 public:
  /// Creates an environment with all worlds at the start of an episode. Returns null and adds
  /// diagnostics if `CheckEnvironment` fails, the model does not compile, or a start is invalid.
  static std::unique_ptr<Env> Create(const ExperimentSpec& experiment, const EnvOptions& options,
                                     Diagnostics& out);
  virtual ~Env() = default;

  virtual int worlds() const noexcept = 0;
  virtual int lanes() const noexcept = 0;
  /// Returns names and units of the action's components, such as cable/NAME/rest_length_m.
  /// Components are clipped to -1..1.
  virtual const std::vector<ChannelInfo>& action_channels() const noexcept = 0;
  /// Returns, per component of the action, the value of an action of 1 in the channel's unit.
  virtual const std::vector<double>& action_scales() const noexcept = 0;
  /// Returns the observed trace channels, followed by own/0, own/1 ...
  virtual const std::vector<ChannelInfo>& observation_channels() const noexcept = 0;
  virtual double period_s() const noexcept = 0;
  virtual std::int64_t episode_steps() const noexcept = 0;  ///< Steps until truncation.

  /// Begins new episodes in all worlds, or in the worlds with `mask` != 0, and writes their rows of
  /// `observations` (worlds, observations). `seeds`: one per world, or empty; then each world's
  /// next seed is derived from its last one. Returns false and adds diagnostics if a seed has no
  /// valid start; such a world keeps its present episode.
  virtual bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                     std::span<float> observations, Diagnostics& out) = 0;
  virtual bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                     std::span<double> observations, Diagnostics& out) = 0;

  /// Advances all worlds by one period under `actions` (worlds, actions). An automatic reset skips
  /// seeds without a valid start; after eight such seeds the last episode starts again. Returns
  /// false if `keep_going` stopped it: `out` is then undefined, worlds are at different times, and
  /// further steps return false until all worlds are reset.
  virtual bool Step(std::span<const float> actions, const EnvStep<float>& out) = 0;
  virtual bool Step(std::span<const double> actions, const EnvStep<double>& out) = 0;

  /// Serializes a world with its episode: state, clocks, memory of controllers, sensors and
  /// rewards, delayed actions and observations. For searches of several futures from one state.
  virtual std::vector<std::uint8_t> Save(int world) = 0;
  /// Restores a serialized world into any world of an environment with the same experiment and
  /// options (worlds, threads, registers and seeds may differ); the continuation is bit-identical.
  /// Returns false, adds an error and changes nothing if the snapshot is damaged or belongs to
  /// another experiment.
  virtual bool Restore(int world, std::span<const std::uint8_t> snapshot, Diagnostics& out) = 0;

  virtual EpisodeState Episode(int world) const = 0;  ///< The present episode.
  virtual EpisodeState Last(int world) const = 0;     ///< The previous episode; 0 steps: none.
  /// Returns the present episode as an experiment, with its factors, start, slope and seed.
  virtual ExperimentSpec Experiment(int world) const = 0;
  virtual double Time(int world) const = 0;  ///< Since the start of the episode [s].
  virtual BodyState Body(int world, int body) const = 0;
  virtual CableState Cable(int world, int cable) const = 0;
  virtual WorldStatus Status(int world) const = 0;
  virtual std::uint64_t Hash(int world) const = 0;
};

}  // namespace taut
