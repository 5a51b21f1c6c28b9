/// Rollouts: parallel runs of many variants of one experiment, scored without traces. Each SIMD
/// lane runs a world, each thread runs groups of lanes. The run of a variant is bit-identical to
/// `RunExperiment` of its `ExperimentOf`, independent of other variants.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/objective.h"
#include "taut/plant.h"

namespace taut {

struct RolloutResult {
  bool done = false;   ///< False if the world was stopped before its end.
  double score = 0;    ///< Measure minus penalties; NaN if the world failed.
  std::string failed;  ///< Reason of a failure; otherwise empty.
  double distance_m = 0;
  double along_m = 0;   ///< Distance along the direction of the objective.
  double energy_j = 0;  ///< Motor work of winding in, over the whole run.
  double max_tension_n = 0;
  double tracking_n = 0;         ///< Root mean square of tension minus set point.
  std::optional<double> fell_s;  ///< Time of the fall, if any.
  std::uint64_t state_hash = 0;  ///< Hash of the state of the world at the end.
};

/// Custom measure for all lanes of a plant.
///
/// Threads: each object is used by one thread at a time; several objects are used concurrently.
class Score {
 public:
  virtual ~Score() = default;
  /// Called at the start with steps of 0, then after every step, of length `step_s[lane]`.
  virtual void Take(const Observation& now, const Commands& commands, const World& world,
                    const double* step_s) = 0;
  /// Returns the score of a lane; higher is better. A value that is not finite is a failure.
  virtual double Result(int lane) const = 0;
};

struct RolloutOptions {
  int threads = 1;  ///< Number of threads; 0: one per core.
  std::optional<Simd> simd;
  const std::atomic<bool>* stop = nullptr;  ///< Set it to true to stop unfinished worlds.
  /// Custom controllers and sensors in addition to the experiment's. Several threads call the
  /// factories concurrently.
  Extensions extensions;
  /// Replaces the measure of the objective; penalties still apply. Several threads call it
  /// concurrently.
  std::function<std::unique_ptr<Score>(const ControlSetup&)> score;
};

/// Runner of rollouts with a thread pool.
///
/// Threads: call `Run` from one thread at a time; it calls `Done` from its own threads. Any thread
/// may call `lanes` and `parallel_worlds` or set `RolloutOptions::stop`. Different objects are
/// independent.
class Rollouts {
 public:
  /// Returns null and adds diagnostics if the model of the experiment does not compile.
  static std::unique_ptr<Rollouts> Create(const ExperimentSpec& experiment,
                                          const ObjectiveSpec& objective,
                                          const RolloutOptions& options, Diagnostics& out);
  virtual ~Rollouts() = default;

  /// Called with the index of each finished world, in any order, by one thread at a time. Return
  /// false to skip all worlds that have not begun.
  using Done = std::function<bool(std::size_t world, const RolloutResult&)>;

  /// Runs all worlds from start to end. Returns the results in order of `worlds`. A result depends
  /// only on its world.
  virtual std::vector<RolloutResult> Run(std::span<const RolloutWorld> worlds,
                                         const Done& done = {}) = 0;

  /// Returns the number of lanes of a group.
  virtual int lanes() const noexcept = 0;
  /// Returns the number of worlds that run concurrently: lanes times threads. Multiples of this
  /// number are the most efficient batch sizes.
  virtual int parallel_worlds() const noexcept = 0;
};

}  // namespace taut
