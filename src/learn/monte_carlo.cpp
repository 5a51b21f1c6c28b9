// Monte Carlo search (uniform random points).
#include "learn/optimizers.h"
#include "learn/random_points.h"

namespace taut::learn {
namespace {

/// Random search: evaluates the start, then uniform random points. Ignores scores.
class MonteCarlo final : public Optimizer {
 public:
  MonteCarlo(int batch, OptimizerStart start) : batch_(batch), start_(std::move(start)) {}

  std::vector<UnitPoint> Ask() override {
    std::vector<UnitPoint> points;
    if (!begun_ && !start_.score) points.push_back(start_.point);
    begun_ = true;
    while (points.size() < static_cast<std::size_t>(batch_)) {
      points.push_back(UniformPoint(start_.point.size(), DrawOf(start_, drawn_++)));
    }
    return points;
  }
  void Tell(const std::vector<double>&) override {}

 private:
  int batch_;
  OptimizerStart start_;
  std::uint64_t drawn_ = 0;
  bool begun_ = false;  ///< Whether the start was evaluated. In a batch of size one, the start uses
                        ///< no random number.
};

}  // namespace

std::unique_ptr<Optimizer> MakeMonteCarlo(int batch, const OptimizerStart& start) {
  return std::make_unique<MonteCarlo>(batch, start);
}

}  // namespace taut::learn
