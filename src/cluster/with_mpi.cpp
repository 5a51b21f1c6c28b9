// Cluster of MPI processes. Rank 0 distributes candidates and work; all ranks evaluate them.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "cluster/cluster_message.h"
#include "cluster/single_process.h"
#include "cluster/started.h"

namespace taut {
namespace {

using cluster::Bytes;

constexpr int kAnswersTag = 1;
/// Time that rank 0 waits for other ranks after a request to stop.
constexpr auto kPatience = std::chrono::seconds(5);

/// Broadcasts bytes from rank 0 to all ranks.
void Broadcast(Bytes& bytes) {
  auto size = static_cast<long long>(bytes.size());
  MPI_Bcast(&size, 1, MPI_LONG_LONG, 0, MPI_COMM_WORLD);
  bytes.resize(static_cast<std::size_t>(size));
  MPI_Bcast(bytes.data(), static_cast<int>(size), MPI_CHAR, 0, MPI_COMM_WORLD);
}

/// Returns a rank's range of candidates or jobs. Ranges are even and contiguous, to fill SIMD
/// lanes.
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

/// Connection of rank 0 to the other ranks. Distributes work and collects results. Its destructor
/// ends the other ranks' service.
class Others {
 public:
  Others(const std::atomic<bool>* stop, int size) : stop_(stop), size_(size) {}
  ~Others() {
    Bytes nothing;
    if (error_.empty()) Broadcast(nothing);
  }
  Others(const Others&) = delete;
  Others& operator=(const Others&) = delete;

  void HandOut(Bytes work) const { Broadcast(work); }
  /// Receives the results of the next rank that has finished. Polls, so that it can be stopped.
  /// Sets an error kPatience after a request to stop.
  Bytes Take(int& rank) {
    MPI_Status status;
    std::chrono::steady_clock::time_point told{};
    for (int there = 0;;) {
      MPI_Iprobe(MPI_ANY_SOURCE, kAnswersTag, MPI_COMM_WORLD, &there, &status);
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
    Bytes bytes(static_cast<std::size_t>(size), '\0');
    rank = status.MPI_SOURCE;
    MPI_Recv(bytes.data(), size, MPI_CHAR, rank, kAnswersTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return bytes;
  }
  int size() const { return size_; }
  const std::string& error() const { return error_; }

 private:
  const std::atomic<bool>* stop_;
  int size_;
  std::string error_;
};

void Answer(const Bytes& bytes) {
  MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_CHAR, 0, kAnswersTag, MPI_COMM_WORLD);
}

class Spreader final : public Evaluator {
 public:
  Spreader(Evaluator& local, const std::atomic<bool>* stop, int size)
      : local_(local), others_(stop, size) {}

  bool Evaluate(std::span<const Candidate> candidates, const Done& done) override {
    others_.HandOut(cluster::Pack(candidates));
    bool go_on = true, complete = true;
    const auto take = [&](std::size_t i, const Trial& trial) {
      if (trial.done) {
        go_on = done(i, trial) && go_on;
      } else {
        complete = false;
      }
      return go_on;
    };
    const auto [first, last] = Share(candidates.size(), 0, others_.size());
    const auto own = TryAll(candidates.subspan(first, last - first), local_, take);
    for (const Trial& trial : own) complete = complete && trial.done;
    for (int left = others_.size() - 1; left > 0; --left) {
      int rank = 0;
      const auto trials = cluster::UnpackTrials(others_.Take(rank));
      if (!others_.error().empty()) return false;
      const std::size_t from = Share(candidates.size(), rank, others_.size()).first;
      for (std::size_t i = 0; i < trials.size(); ++i) take(from + i, trials[i]);
    }
    return complete && go_on;
  }
  std::string error() const override { return others_.error(); }

 private:
  Evaluator& local_;
  Others others_;
};

std::vector<std::string> DoSpread(std::span<const std::string> pieces, const Cluster::Work& local,
                                  Others& others) {
  others.HandOut(cluster::PackTexts(pieces));
  std::vector<std::string> answers(pieces.size());
  std::size_t there = 0;
  const auto put = [&](int rank, std::vector<std::string> part) {
    const std::size_t from = Share(pieces.size(), rank, others.size()).first;
    std::move(part.begin(), part.end(), answers.begin() + static_cast<std::ptrdiff_t>(from));
    there += part.size();
  };
  const auto [first, last] = Share(pieces.size(), 0, others.size());
  put(0, local(pieces.subspan(first, last - first)));
  for (int left = others.size() - 1; left > 0; --left) {
    int rank = 0;
    const Bytes bytes = others.Take(rank);
    if (!others.error().empty()) return {};
    put(rank, cluster::UnpackTexts(bytes));
  }
  if (there < pieces.size()) return {};
  return answers;
}

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
      Answer(cluster::Pack(TryAll(all.subspan(first, last - first), local, {})));
    }
  }

  Work Spread(Work local, const std::atomic<bool>* stop) override {
    const auto others = std::make_shared<Others>(stop, size_);
    return [others, local = std::move(local)](std::span<const std::string> pieces) {
      return DoSpread(pieces, local, *others);
    };
  }

  void Serve(const Work& local) override {
    for (Bytes work;;) {
      Broadcast(work);
      if (work.empty()) return;
      const auto pieces = cluster::UnpackTexts(work);
      const auto [first, last] = Share(pieces.size(), rank_, size_);
      Answer(cluster::PackTexts(local(std::span(pieces).subspan(first, last - first))));
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
