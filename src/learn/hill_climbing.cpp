// Hill climbing with adaptive step size.
#include <cmath>
#include <limits>

#include "learn/optimizers.h"
#include "learn/random_points.h"
#include "math/elementary.h"

namespace taut::learn {
namespace {

/// Hill climbing: each step adds Gaussian noise to the best point so far. The best point of a batch
/// becomes the best point so far if its score is higher. With `adapt: false`, `batch: 1` and
/// `deviation: 0.005`, this is NTRT's AnnealEvolution, except at bounds: taut mirrors points there,
/// NTRT clamps them.
///
/// With `adapt`, sigma follows the share p of successful steps:
///   p' = (1 - c) p' + c p,   sigma <- sigma exp((p' - p*) / (d (1 - p*)))
/// with lambda steps per batch, n dimensions, p* = 1 / (5 + sqrt(lambda) / 2),
/// c = p* lambda / (2 + p* lambda), d = 1 + n / (2 lambda). Source: the (1 + lambda) strategy of
/// C. Igel, N. Hansen, S. Roth, "Covariance matrix adaptation for multi-objective optimization",
/// Evolutionary Computation 15(1), 2007, section 2.1.
class HillClimbing final : public Optimizer {
 public:
  HillClimbing(const HillClimbingSpec& spec, int batch, OptimizerStart start)
      : spec_(spec),
        batch_(batch),
        start_(std::move(start)),
        best_(start_.point),
        best_score_(start_.score.value_or(std::numeric_limits<double>::quiet_NaN())),
        sigma_(spec.deviation),
        target_(1.0 / (5.0 + 0.5 * std::sqrt(static_cast<double>(batch)))),
        success_(target_) {}

  std::vector<UnitPoint> Ask() override {
    asked_.clear();
    if (drawn_ == 0 && !start_.score) asked_.push_back(start_.point);
    while (asked_.size() < static_cast<std::size_t>(batch_)) {
      math::Random random = DrawOf(start_, drawn_++);
      if (std::isnan(best_score_) &&
          start_.score) {  // all points failed so far, so draw a uniform one
        asked_.push_back(UniformPoint(best_.size(), random));
        continue;
      }
      UnitPoint point = best_;
      for (double& x : point) x = Reflect(x + sigma_ * random.Normal());
      asked_.push_back(std::move(point));
    }
    return asked_;
  }

  void Tell(const std::vector<double>& scores) override {
    const double before = best_score_;
    int successes = 0;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      if (Better(scores[i], before)) ++successes;
      if (!Better(scores[i], best_score_)) continue;
      best_score_ = scores[i];
      best_ = asked_[i];
    }
    const bool first = !start_.score;
    start_.score = best_score_;
    if (!spec_.adapt || first) return;  // the first batch has no previous score
    const double lambda = batch_, n = static_cast<double>(best_.size());
    const double c = target_ * lambda / (2.0 + target_ * lambda);
    success_ = (1.0 - c) * success_ + c * (successes / lambda);
    const double d = 1.0 + n / (2.0 * lambda);
    sigma_ *= math::Exp((success_ - target_) / (d * (1.0 - target_)));
    sigma_ = std::fmin(sigma_, 1.0);
  }

 private:
  HillClimbingSpec spec_;
  int batch_;
  OptimizerStart start_;
  UnitPoint best_;
  double best_score_, sigma_, target_, success_;
  std::vector<UnitPoint> asked_;
  std::uint64_t drawn_ = 0;
};

}  // namespace

std::unique_ptr<Optimizer> MakeHillClimbing(const HillClimbingSpec& spec, int batch,
                                            const OptimizerStart& start) {
  return std::make_unique<HillClimbing>(spec, batch, start);
}

}  // namespace taut::learn

namespace taut {

std::unique_ptr<Optimizer> MakeOptimizer(const SearchSpec& search, const OptimizerStart& start) {
  if (const auto* hill = std::get_if<HillClimbingSpec>(&search.method)) {
    return learn::MakeHillClimbing(*hill, search.batch, start);
  }
  if (const auto* nlopt = std::get_if<NloptSpec>(&search.method)) {
    return learn::MakeNlopt(*nlopt, start);
  }
  if (const auto* cma = std::get_if<CmaEsSpec>(&search.method)) {
    return learn::MakeCmaEs(*cma, search.batch, start);
  }
  return learn::MakeMonteCarlo(search.batch, start);
}

}  // namespace taut
