#include <cstdlib>

#include "cluster/single_process.h"
#include "cluster/started.h"

namespace taut::cluster {

bool StartedByLauncher() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "PMI_RANK"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

namespace {

/// Evaluator that passes all candidates to the local evaluator.
class Same final : public Evaluator {
 public:
  explicit Same(Evaluator& local) : local_(local) {}
  bool Evaluate(std::span<const Candidate> candidates, const Done& done) override {
    return local_.Evaluate(candidates, done);
  }
  std::string error() const override { return local_.error(); }

 private:
  Evaluator& local_;
};

class Alone final : public Cluster {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  bool Agree(const std::string&) override { return true; }
  std::unique_ptr<Evaluator> Spread(Evaluator& local, const std::atomic<bool>*) override {
    return std::make_unique<Same>(local);
  }
  void Serve(Evaluator&) override {}
  Work Spread(Work local, const std::atomic<bool>*) override { return local; }
  void Serve(const Work&) override {}
};

}  // namespace

std::unique_ptr<Cluster> MakeAlone() { return std::make_unique<Alone>(); }

}  // namespace taut::cluster
