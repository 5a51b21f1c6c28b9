/// Many variants of one experiment, run side by side and scored without traces: a world a SIMD
/// lane, a group of lanes a thread. A variant goes through the same bits as `RunExperiment` of
/// `ExperimentOf(it)` does, whatever runs beside it.
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
  double score = 0;    ///< Measure less penalties; NaN if the world failed.
  std::string failed;  ///< Why it failed; empty if it did not.
  double distance_m = 0;
  double along_m = 0;   ///< Along the objective's direction.
  double energy_j = 0;  ///< Of the motors, winding in, whole run.
  double max_tension_n = 0;
  double tracking_n = 0;         ///< Root mean square of tension less set point.
  std::optional<double> fell_s;  ///< When it fell.
  std::uint64_t state_hash = 0;  ///< Of the world at the end.
};

/// A measure of one's own for all lanes of a plant.
///
/// Threads: a score belongs to one thread; several scores are at work at once.
class Score {
 public:
  virtual ~Score() = default;
  /// At the start, where steps are 0, and after every step, of `step_s[lane]`.
  virtual void Take(const Observation& now, const Commands& commands, const World& world,
                    const double* step_s) = 0;
  /// What a lane came to: more is better. Not finite: it failed.
  virtual double Result(int lane) const = 0;
};

struct RolloutOptions {
  int threads = 1;  ///< 0: one a core.
  std::optional<Simd> simd;
  const std::atomic<bool>* stop = nullptr;  ///< Once true, unfinished worlds are given up.
  /// Controllers and sensors that act beside the experiment's. Makers are called from any thread,
  /// several at once.
  Brought brought;
  /// In place of the objective's measure; penalties stay. Called from any thread, several at once.
  std::function<std::unique_ptr<Score>(const ControlSetup&)> score;
};

/// Threads: it has its own. Callers' threads: one at a time in `Run`, which calls `Done` from its
/// threads; `lanes` and `parallel_worlds` from any, and `RolloutOptions::stop` may be set by any.
/// Rollouts do not know of each other.
class Rollouts {
 public:
  /// Nothing, and diagnostics, if the experiment's model does not compile.
  static std::unique_ptr<Rollouts> Create(const ExperimentSpec& experiment,
                                          const ObjectiveSpec& objective,
                                          const RolloutOptions& options, Diagnostics& out);
  virtual ~Rollouts() = default;

  /// Called with the index of a world that is done, by one thread at a time, in any order. False
  /// gives up all that has not begun.
  using Done = std::function<bool(std::size_t world, const RolloutResult&)>;

  /// Runs all worlds from start to end. Results in the order of `worlds`; they depend on each world
  /// alone.
  virtual std::vector<RolloutResult> Run(std::span<const RolloutWorld> worlds,
                                         const Done& done = {}) = 0;

  virtual int lanes() const noexcept = 0;
  /// Worlds that run at once: lanes times threads. Batches of a multiple of this waste nothing.
  virtual int parallel_worlds() const noexcept = 0;
};

}  // namespace taut
