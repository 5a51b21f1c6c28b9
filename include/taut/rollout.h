/// Rollouts: parallel runs of many variants of one experiment, scored without traces. Each SIMD
/// lane runs a world, each thread a group of lanes. A variant's run is bit-identical to
/// `RunExperiment` of its `ExperimentOf`, independent of the other variants.
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
  bool done = false;   ///< False if the evaluation was stopped before its end.
  double score = 0;    ///< Measure minus penalties; NaN if the world failed.
  std::string failed;  ///< Reason of a failure; else empty.
  double distance_m = 0;
  double along_m = 0;   ///< Along the objective's direction.
  double energy_j = 0;  ///< Work of the motors in winding in, whole run.
  double max_tension_n = 0;
  double tracking_n = 0;         ///< Root mean square of tension minus set point.
  std::optional<double> fell_s;  ///< Time of a fall.
  std::uint64_t state_hash = 0;  ///< Of the world at the end.
};

/// Custom measure for all lanes of a plant.
///
/// Threads: a score is used by one thread; several scores are used concurrently.
class Score {
 public:
  virtual ~Score() = default;
  /// Called at the start, with steps of 0, and after every step of `step_s[lane]`.
  virtual void Take(const Observation& now, const Commands& commands, const World& world,
                    const double* step_s) = 0;
  /// Returns the score of a lane; more is better. Not finite: failed.
  virtual double Result(int lane) const = 0;
};

struct RolloutOptions {
  int threads = 1;  ///< 0: one per core.
  std::optional<Simd> simd;
  const std::atomic<bool>* stop = nullptr;  ///< Once true, unfinished worlds are abandoned.
  /// Custom controllers and sensors in addition to the experiment's. Factories are called from
  /// several threads concurrently.
  Extensions extensions;
  /// Replaces the objective's measure; penalties still apply. Called from several threads
  /// concurrently.
  std::function<std::unique_ptr<Score>(const ControlSetup&)> score;
};

/// Runner of rollouts, with a pool of threads.
///
/// Threads: call `Run` from one thread at a time; it calls `Done` from its threads. `lanes` and
/// `parallel_worlds` may be called, and `RolloutOptions::stop` set, from any thread. Rollouts are
/// independent of each other.
class Rollouts {
 public:
  /// Returns null, with diagnostics, if the experiment's model does not compile.
  static std::unique_ptr<Rollouts> Create(const ExperimentSpec& experiment,
                                          const ObjectiveSpec& objective,
                                          const RolloutOptions& options, Diagnostics& out);
  virtual ~Rollouts() = default;

  /// Called with the index of a finished world, by one thread at a time, in any order. Return false
  /// to abandon all worlds that have not begun.
  using Done = std::function<bool(std::size_t world, const RolloutResult&)>;

  /// Runs all worlds from start to end. Returns results in the order of `worlds`; a result depends
  /// only on its world.
  virtual std::vector<RolloutResult> Run(std::span<const RolloutWorld> worlds,
                                         const Done& done = {}) = 0;

  /// Returns the number of lanes of a group.
  virtual int lanes() const noexcept = 0;
  /// Returns the number of worlds that run concurrently: lanes times threads. Multiples of it are
  /// the most efficient batch sizes.
  virtual int parallel_worlds() const noexcept = 0;
};

}  // namespace taut
