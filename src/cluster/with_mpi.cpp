#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "cluster/alone.h"
#include "cluster/message.h"
#include "cluster/started.h"

namespace taut {
namespace {

using cluster::Bytes;

constexpr int kTrialsTag = 1;
/// How long rank 0 waits for the others once it was told to stop.
constexpr auto kPatience = std::chrono::seconds(5);

/// From rank 0 to all.
void Broadcast(Bytes& bytes) {
  auto size = static_cast<long long>(bytes.size());
  MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
  bytes.resize(static_cast<std::size_t>(size));
  MPI_Bcast(bytes.data(), static_cast<int>(size), MPI_CHAR, 0, MPI_COMM_WORLD);
}

/// The candidates of a rank: even, contiguous shares, so that lanes are filled.
std::pair<std::size_t, std::size_t> Share(std::size_t count, int rank, int size) {
  const auto at = [&](int r) {
    return count * static_cast<std::size_t>(r) / static_cast<std::size_t>(size);
  };
  return {at(rank), at(rank + 1)};
}

std::vector<Evaluator::Trial> TryAll(std::span<const Evaluator::Candidate> candidates,
                                     Evaluator& local, const Evaluator::Done& done) {
  std::vector<Evaluator::Trial> trials(candidates.size());
  local.Evaluate(candidates, [&](std::size_t i, const Evaluator::Trial& trial) {
    trials[i] = trial;
    return !done || done(i, trial);
  });
  return trials;
}

class Spreader final : public Evaluator {
 public:
  Spreader(Evaluator& local, const std::atomic<bool>* stop, int size)
      : local_(local), stop_(stop), size_(size) {}
  ~Spreader() override {
    Bytes nothing;  // tells the others to go home
    if (error_.empty()) Broadcast(nothing);
  }

  bool Evaluate(std::span<const Candidate> candidates, const Done& done) override {
    Bytes all = cluster::Pack(candidates);
    Broadcast(all);
    bool go_on = true, complete = true;
    const auto take = [&](std::size_t i, const Trial& trial) {
      if (trial.done) {
        go_on = done(i, trial) && go_on;
      } else {
        complete = false;
      }
      return go_on;
    };
    const auto [first, last] = Share(candidates.size(), 0, size_);
    const auto own = TryAll(candidates.subspan(first, last - first), local_, take);
    for (const Trial& trial : own) complete = complete && trial.done;
    for (int left = size_ - 1; left > 0; --left) {
      int rank = 0;
      const auto trials = Receive(rank);
      if (!error_.empty()) return false;
      const std::size_t from = Share(candidates.size(), rank, size_).first;
      for (std::size_t i = 0; i < trials.size(); ++i) take(from + i, trials[i]);
    }
    return complete && go_on;
  }
  std::string error() const override { return error_; }

 private:
  /// From whichever rank is ready. Looks rather than waits, so that it can be stopped.
  std::vector<Trial> Receive(int& rank) {
    MPI_Status status;
    std::chrono::steady_clock::time_point told{};
    for (int there = 0;;) {
      MPI_Iprobe(MPI_ANY_SOURCE, kTrialsTag, MPI_COMM_WORLD, &there, &status);
      if (there != 0) break;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      if (stop_ == nullptr || !stop_->load()) continue;
      const auto now = std::chrono::steady_clock::now();
      if (told.time_since_epoch().count() == 0) told = now;
      if (now - told < kPatience) continue;
      error_ = "other processes of the cluster do not answer";
      return {};
    }
    int size = 0;
    MPI_Get_count(&status, MPI_CHAR, &size);
    Bytes bytes(static_cast<std::size_t>(size));
    rank = status.MPI_SOURCE;
    MPI_Recv(bytes.data(), size, MPI_CHAR, rank, kTrialsTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return cluster::UnpackTrials(bytes);
  }

  Evaluator& local_;
  const std::atomic<bool>* stop_;
  int size_;
  std::string error_;
};

class MpiCluster final : public Cluster {
 public:
  MpiCluster() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiCluster() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  bool Agree(const std::string& text) override {
    Bytes theirs(text.begin(), text.end());
    Broadcast(theirs);
    int same = std::equal(theirs.begin(), theirs.end(), text.begin(), text.end()) ? 1 : 0, all = 0;
    MPI_Allreduce(&same, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all == 1;
  }

  std::unique_ptr<Evaluator> Spread(Evaluator& local, const std::atomic<bool>* stop) override {
    return std::make_unique<Spreader>(local, stop, size_);
  }

  void Serve(Evaluator& local) override {
    for (Bytes work;;) {
      Broadcast(work);
      if (work.empty()) return;
      const auto candidates = cluster::UnpackCandidates(work);
      const auto [first, last] = Share(candidates.size(), rank_, size_);
      const std::span<const Evaluator::Candidate> all(candidates);
      const Bytes bytes = cluster::Pack(TryAll(all.subspan(first, last - first), local, {}));
      MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, 0, kTrialsTag,
               MPI_COMM_WORLD);
    }
  }

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace

std::unique_ptr<Cluster> Cluster::Join(Diagnostics&) {
  if (!cluster::StartedByLauncher()) return cluster::MakeAlone();
  return std::make_unique<MpiCluster>();
}

}  // namespace taut
