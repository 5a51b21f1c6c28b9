/// Searches and fits with several processes (MPI): `mpirun -np N taut learn study.yaml`, or `taut
/// fit fit.yaml`. Rank 0 searches and writes the log; all ranks evaluate candidates. The results
/// are independent of N.
///
/// Threads: call all functions of a process from the same thread.
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
  /// one process. Returns null and adds an error if a launcher started the process but this build
  /// has no MPI.
  static std::unique_ptr<Cluster> Join(Diagnostics& out);
  /// Leaves the cluster. Collective: all ranks must call it.
  virtual ~Cluster() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Returns whether all ranks pass the same text, to detect different input files on different
  /// machines. Collective: all ranks must call it. After an earlier failure, a rank passes an empty
  /// text.
  virtual bool Agree(const std::string& text) = 0;

  /// Rank 0: returns an evaluator that distributes candidates over all ranks. `local` evaluates the
  /// share of rank 0. Setting `stop` ends the wait for other ranks.
  virtual std::unique_ptr<Evaluator> Spread(Evaluator& local, const std::atomic<bool>* stop) = 0;
  /// Other ranks: evaluates candidates from rank 0 until rank 0 has no more.
  virtual void Serve(Evaluator& local) = 0;

  /// Function that processes independent pieces of work; pieces and results are texts with
  /// arbitrary bytes. The function returns one result per piece, in order, or fewer results if it
  /// was stopped.
  using Work = std::function<std::vector<std::string>(std::span<const std::string> pieces)>;
  /// Rank 0: returns a function that distributes pieces over all ranks in equal, contiguous shares.
  /// `local` processes the share of rank 0; `stop` is as above. `Serve` returns on the other ranks
  /// after all copies of the returned function are destroyed.
  virtual Work Spread(Work local, const std::atomic<bool>* stop) = 0;
  /// Other ranks: processes pieces from rank 0 until rank 0 has no more.
  virtual void Serve(const Work& local) = 0;
};

}  // namespace taut
