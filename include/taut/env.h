/// Experiments as environments for learners: thousands of worlds, each with an episode of its own,
/// that take an action and give an observation and a reward (docs/environments.md). Worlds are
/// lanes of registers, groups of lanes run on a thread pool, and each lane has clocks of its own. A
/// world's bits depend on its seed and its actions alone: on no other world, no number of threads,
/// no instruction set, no kind of number. Under actions of zero it goes through the bits of
/// `RunExperiment` of `Env::Experiment`.
///
/// Arrays are row-major: one row a world. What rows of an action and of an observation mean:
/// `action_channels()`, `observation_channels()`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/batch.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut {

/// When a world whose episode is over begins its next one: as Gymnasium's `AutoresetMode` has it.
enum class Autoreset {
  kNextStep,  ///< In the step after, which ignores its action and is worth 0.
  kSameStep,  ///< In the same step, which returns the first observation of the next episode.
  kDisabled,  ///< When `Reset` says so. Until then it stands as it ended, each step worth 0.
};

/// Why an episode is over.
enum class EpisodeEnd : std::uint8_t {
  kNone,         ///< It goes on.
  kTime,         ///< The experiment's `duration_s`: truncated. All others: terminated.
  kFell,         ///< `FallSpec` of the reward.
  kNotFinite,    ///< The state is not finite any more. The world stands where it last was so.
  kTooFast,      ///< A body is faster than `max_speed_m_per_s` of the reward.
  kFellOff,      ///< A body is below all of its terrain.
  kTooTense,     ///< A cable pulls more than `max_tension_n`.
  kWrongAction,  ///< A number of the action was not finite; it counted as 0.
  kCalled,       ///< A callback said so, or gave a reward that is not finite; that counts as 0.
};
constexpr bool Failed(EpisodeEnd end) noexcept { return end > EpisodeEnd::kFell; }

/// An episode, so far or over.
struct EpisodeState {
  std::uint64_t seed = 0;  ///< As it counts (`EnvironmentVariation::starts`).
  std::int64_t steps = 0;  ///< Actions that it took.
  double reward = 0;       ///< Of all steps together.
  EpisodeEnd end = EpisodeEnd::kNone;
};

class Env;

/// All worlds at once, for callbacks. Of two arrays that differ in their numbers one is empty, as
/// the caller of `Step` or `Reset` chose.
struct EnvView {
  const Env& env;
  std::span<const std::uint8_t> rows;  ///< Per world: whether its row is to be looked at.
  std::span<float> observations_f32;   ///< (worlds, observations): may be written.
  std::span<double> observations_f64;
  // In `judge` only.
  std::span<const float> actions_f32;  ///< (worlds, actions), as the caller gave them.
  std::span<const double> actions_f64;
  std::span<double> rewards;           ///< (worlds): may be written.
  std::span<std::uint8_t> terminated;  ///< (worlds): may be set to 1.
};

struct EnvOptions {
  int worlds = 1;
  int threads = 1;                ///< 0: one a core.
  std::optional<Simd> simd = {};  ///< Nothing: `BestSimd()`, or scalar for a single world.
  Autoreset autoreset = Autoreset::kNextStep;
  bool randomise = true;  ///< False: without `randomise` of the environment.
  /// World i begins with this plus i; nothing: the experiment's own.
  std::optional<std::uint64_t> seed = {};
  /// Observations of one's own, behind those of channels; `observe` fills them.
  int own_observations = 0;
  /// Called on the thread that called `Step` or `Reset`, when rows have new observations of their
  /// channels, which it may change, too. What is not finite counts as 0.
  std::function<void(const EnvView&)> observe = {};
  /// Called in every step after `observe`, before episodes begin anew: rewards are those of the
  /// experiment's objective. Rows are those that took their action.
  std::function<void(const EnvView&)> judge = {};
};

/// What a step gives. Spans of another size than needed are a mistake of the program that calls, as
/// a wrong index is to `Batch`. Nothing in it is ever NaN or infinite.
template <class T>
struct EnvStep {
  std::span<T> observations;             ///< (worlds, observations)
  std::span<double> rewards;             ///< (worlds)
  std::span<std::uint8_t> terminated;    ///< (worlds): 0 or 1.
  std::span<std::uint8_t> truncated;     ///< (worlds): 0 or 1.
  std::span<T> final_observations = {};  ///< (worlds, observations); with `kSameStep` only, there
                                         ///< needed: rows of worlds whose episode is over.
};

/// False, and a complaint each, unless the experiment has an `environment` whose channels exist and
/// whose period fits: a whole multiple of the step and of all clocks, on whose steps everything
/// happens that happens.
bool CheckEnvironment(const ExperimentSpec& experiment, Diagnostics& out);

/// `LoadExperiment`. If something is wrong, channels that `record` and `environment` name and that
/// do not exist are told with it, where the rest is clear enough to know. (If nothing is, that is
/// for `CheckRecord` and `CheckEnvironment`.)
std::optional<ExperimentSpec> LoadExperimentAndChannels(const std::string& path,
                                                        const Overrides& overrides,
                                                        Diagnostics& out);

/// The channels that an experiment's environment observes, in order; its experiment is good.
std::vector<ChannelInfo> ObservedChannels(const ExperimentSpec& experiment);

/// Threads: it has its own. Callers' threads: one at a time, any number in const functions.
/// Environments do not know of each other. A step in which no episode begins allocates nothing,
/// unless a channel is observed that gathers contacts, loads or parts of cables.
class Env {
 public:
  /// All worlds at the start of an episode. Nothing and diagnostics as from `CheckEnvironment`, or
  /// if the model does not compile or there is no such start.
  static std::unique_ptr<Env> Create(const ExperimentSpec& experiment, const EnvOptions& options,
                                     Diagnostics& out);
  virtual ~Env() = default;

  virtual int worlds() const noexcept = 0;
  virtual int lanes() const noexcept = 0;
  /// Numbers of an action, -1..1 (what is beyond counts as the end): what 1 stands for has this
  /// name and unit, as cable/NAME/rest_length_m.
  virtual const std::vector<ChannelInfo>& action_channels() const noexcept = 0;
  /// What 1 stands for, by number of the action, in the channel's unit.
  virtual const std::vector<double>& action_scales() const noexcept = 0;
  /// Those of trace channels, then own/0, own/1 ...
  virtual const std::vector<ChannelInfo>& observation_channels() const noexcept = 0;
  virtual double period_s() const noexcept = 0;
  virtual std::int64_t episode_steps() const noexcept = 0;  ///< After which it is truncated.

  /// Begins episodes: of all worlds, or of those whose `mask` is not 0; `seeds` has one a world or
  /// is empty: then each goes on with the seed that follows from its last. Writes the rows of
  /// `observations` (worlds, observations) of those. False and diagnostics if a seed has no start:
  /// those worlds go on as they were.
  virtual bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                     std::span<float> observations, Diagnostics& out) = 0;
  virtual bool Reset(std::span<const std::uint64_t> seeds, std::span<const std::uint8_t> mask,
                     std::span<double> observations, Diagnostics& out) = 0;

  /// One period of all worlds under `actions` (worlds, actions). An episode that has no start when
  /// it should begin is passed over: the next seed's begins (after eight of them the last one
  /// again).
  virtual void Step(std::span<const float> actions, const EnvStep<float>& out) = 0;
  virtual void Step(std::span<const double> actions, const EnvStep<double>& out) = 0;

  /// A world with its episode: state, clocks, what controllers, sensors and rewards remember,
  /// actions and observations that are under way. For who tries several futures from one present.
  virtual std::vector<std::uint8_t> Save(int world) = 0;
  /// Goes on from there, in any world of this environment or of another one of the same experiment
  /// and options (worlds, threads, registers and seeds may differ), through the bits that would
  /// have followed. False and a complaint, and nothing has changed, if the snapshot is of something
  /// else or damaged.
  virtual bool Restore(int world, std::span<const std::uint8_t> snapshot, Diagnostics& out) = 0;

  virtual EpisodeState Episode(int world) const = 0;  ///< Now.
  virtual EpisodeState Last(int world) const = 0;     ///< The one before; 0 steps: there was none.
  /// The present episode as an experiment: with its factors, start, slope and seed.
  virtual ExperimentSpec Experiment(int world) const = 0;
  virtual double Time(int world) const = 0;  ///< Of the episode [s].
  virtual BodyState Body(int world, int body) const = 0;
  virtual CableState Cable(int world, int cable) const = 0;
  virtual WorldStatus Status(int world) const = 0;
  virtual std::uint64_t Hash(int world) const = 0;
};

}  // namespace taut
