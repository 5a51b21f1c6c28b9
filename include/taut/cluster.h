/// Searches and fits on several processes (MPI): `mpirun -np N taut learn study.yaml`, or `taut fit
/// fit.yaml`. Rank 0 searches and writes the log; all ranks evaluate candidates. Results do not
/// depend on N.
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
  /// Joins the other ranks if mpirun or srun started this process; otherwise returns a cluster of
  /// one process (rank 0 of 1). Returns null and adds an error if a launcher started the process
  /// and this build has no MPI.
  static std::unique_ptr<Cluster> Join(Diagnostics& out);
  /// Leaves the cluster. Collective: all ranks must call it.
  virtual ~Cluster() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Returns whether all ranks pass the same text. Collective: all ranks must call it, also after
  /// an earlier failure (with an empty text). Ranks with different input files on different
  /// machines must not search together.
  virtual bool Agree(const std::string& text) = 0;

  /// Rank 0: returns an evaluator that spreads candidates over all ranks; `local` evaluates rank
  /// 0's share. Setting `stop` ends the wait for other ranks.
  virtual std::unique_ptr<Evaluator> Spread(Evaluator& local, const std::atomic<bool>* stop) = 0;
  /// Other ranks: evaluates the candidates that rank 0 sends, until it has no more.
  virtual void Serve(Evaluator& local) = 0;

  /// General work: independent pieces, as texts that may contain any bytes. Returns the result of
  /// each piece, in their order; fewer results than pieces if it was stopped.
  using Work = std::function<std::vector<std::string>(std::span<const std::string> pieces)>;
  /// Rank 0: returns a function that spreads pieces over all ranks, in even, contiguous shares;
  /// `local` does rank 0's share. `Serve` returns on the other ranks once the returned function and
  /// all copies of it are destroyed. `stop` as above.
  virtual Work Spread(Work local, const std::atomic<bool>* stop) = 0;
  /// Other ranks: does the work that rank 0 sends, until it has no more.
  virtual void Serve(const Work& local) = 0;
};

}  // namespace taut
