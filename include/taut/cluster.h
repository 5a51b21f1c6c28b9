/// Processes that search together: `mpirun -np N taut learn study.yaml`, or `taut fit fit.yaml`.
/// Rank 0 searches and keeps the log; all ranks try candidates. What is found does not depend on N.
///
/// Threads: all calls of one process come from the same thread.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "taut/learn.h"

namespace taut {

class Cluster {
 public:
  /// Joins the others if this process was started by mpirun or srun; else it is alone, rank 0 of 1.
  /// Null and a complaint if it was started so and this build knows no MPI.
  static std::unique_ptr<Cluster> Join(Diagnostics& out);
  /// Leaves in good order; to be called by all ranks.
  virtual ~Cluster() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// To be called by all ranks, also by one that has failed before (with an empty text): whether
  /// all have the same text. Different files on different machines must not search together.
  virtual bool Agree(const std::string& text) = 0;

  /// Rank 0: an evaluator that spreads candidates over all ranks, `local` being its own. `stop`
  /// makes it give up waiting for ranks.
  virtual std::unique_ptr<Evaluator> Spread(Evaluator& local, const std::atomic<bool>* stop) = 0;
  /// Other ranks: tries what rank 0 asks for until that has no more.
  virtual void Serve(Evaluator& local) = 0;

  /// Work of any kind: pieces that know nothing of each other, as texts that may hold any bytes,
  /// and what came of each, in their order. Fewer answers than pieces: it was stopped.
  using Work = std::function<std::vector<std::string>(std::span<const std::string> pieces)>;
  /// Rank 0: spreads pieces over all ranks, even shares in their order, `local` doing its own. The
  /// other ranks go home when what is returned, and all copies of it, are gone. `stop` as above.
  virtual Work Spread(Work local, const std::atomic<bool>* stop) = 0;
  /// Other ranks: does what rank 0 asks for until that has no more.
  virtual void Serve(const Work& local) = 0;
};

}  // namespace taut
