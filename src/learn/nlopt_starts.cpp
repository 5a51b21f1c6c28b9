// Optimizers of the NLopt library with several starts.
#include <nlopt.h>

#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>

#include "learn/optimizers.h"
#include "learn/random_points.h"

namespace taut::learn {
namespace {

nlopt_algorithm AlgorithmOf(const std::string& name) {
  if (name == "subplex") return NLOPT_LN_SBPLX;
  if (name == "bobyqa") return NLOPT_LN_BOBYQA;
  if (name == "cobyla") return NLOPT_LN_COBYLA;
  return NLOPT_LN_NELDERMEAD;
}

/// Repeated runs of NLopt, each from another point. NLopt requests values one at a time by a
/// callback and cannot be suspended. So each start has a thread, which waits for the score in the
/// callback.
class Start {
 public:
  Start(const NloptSpec& spec, const OptimizerStart& start, int number)
      : spec_(spec), start_(start), number_(number), thread_([this] { Work(); }) {}
  ~Start() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Start(const Start&) = delete;
  Start& operator=(const Start&) = delete;

  /// Waits for the next point to evaluate.
  UnitPoint Ask() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return asks_; });
    return point_;
  }
  void Tell(double score) {
    {
      const std::lock_guard lock(mutex_);
      score_ = score;
      asks_ = false;
    }
    changed_.notify_all();
  }

 private:
  /// Publishes a point and waits for its score; called in the thread. Returns nothing if the search
  /// was ended.
  std::optional<double> Evaluate(UnitPoint point) {
    std::unique_lock lock(mutex_);
    point_ = std::move(point);
    asks_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return !asks_ || over_; });
    if (asks_) return std::nullopt;
    if (!std::isnan(score_)) {
      worst_ = std::isnan(worst_) ? score_ : std::fmin(worst_, score_);
      most_ = std::isnan(most_) ? score_ : std::fmax(most_, score_);
      return score_;
    }
    // NLopt needs a number for a failure: slightly below all scores of this start so far. A much
    // lower number would distort NLopt's model of the scores.
    if (std::isnan(worst_)) return -1.0;
    return worst_ - 0.1 * std::fmax(most_ - worst_, 1e-3);
  }

  static double Call(unsigned n, const double* x, double*, void* self) {
    auto& start = *static_cast<Start*>(self);
    UnitPoint point(x, x + n);
    for (double& value : point) value = std::fmin(std::fmax(value, 0.0), 1.0);
    const std::optional<double> score = start.Evaluate(std::move(point));
    if (!score) {
      nlopt_force_stop(start.optimizer_);
      return 0.0;
    }
    ++start.calls_;
    return *score;
  }

  bool IsOver() {
    const std::lock_guard lock(mutex_);
    return over_;
  }

  void Work() {
    const auto n = static_cast<unsigned>(start_.point.size());
    for (std::uint64_t run = 0; !IsOver(); ++run) {
      UnitPoint from = start_.point;
      if (number_ > 0 || run > 0) {
        from = UniformPoint(n, DrawOf(start_, (run << 16) + static_cast<std::uint64_t>(number_)));
      }
      optimizer_ = nlopt_create(AlgorithmOf(spec_.algorithm), n);
      nlopt_set_lower_bounds1(optimizer_, 0.0);
      nlopt_set_upper_bounds1(optimizer_, 1.0);
      nlopt_set_initial_step1(optimizer_, spec_.initial_step);
      nlopt_set_max_objective(optimizer_, Call, this);
      nlopt_set_xtol_abs1(optimizer_, 1e-5);  // share of the bounds; the next run begins at
                                              // convergence
      nlopt_set_maxeval(optimizer_, 100'000);
      calls_ = 0;
      UnitPoint end = from;
      double score = 0;
      nlopt_optimize(optimizer_, end.data(), &score);
      nlopt_destroy(optimizer_);
      // Prevents an endless loop if an algorithm rejects its start point.
      if (calls_ == 0 && !IsOver() && !Evaluate(from)) return;
    }
  }

  const NloptSpec spec_;
  const OptimizerStart start_;
  const int number_;
  nlopt_opt optimizer_ = nullptr;
  int calls_ = 0;
  double worst_ = std::numeric_limits<double>::quiet_NaN();
  double most_ = std::numeric_limits<double>::quiet_NaN();

  std::mutex mutex_;
  std::condition_variable changed_;
  bool asks_ = false, over_ = false;
  UnitPoint point_;
  double score_ = 0;
  std::thread thread_;
};

class NloptStarts final : public Optimizer {
 public:
  NloptStarts(const NloptSpec& spec, const OptimizerStart& start) {
    for (int i = 0; i < spec.starts; ++i) {
      starts_.push_back(std::make_unique<Start>(spec, start, i));
    }
  }

  std::vector<UnitPoint> Ask() override {
    std::vector<UnitPoint> points;
    for (const auto& start : starts_) points.push_back(start->Ask());
    return points;
  }
  void Tell(const std::vector<double>& scores) override {
    for (std::size_t i = 0; i < starts_.size(); ++i) starts_[i]->Tell(scores[i]);
  }

 private:
  std::vector<std::unique_ptr<Start>> starts_;
};

}  // namespace

std::unique_ptr<Optimizer> MakeNlopt(const NloptSpec& spec, const OptimizerStart& start) {
  return std::make_unique<NloptStarts>(spec, start);
}

}  // namespace taut::learn
