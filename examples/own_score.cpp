// Example of a user-defined score: the remaining motion of a robot after a push.
//
//   own_score share/experiments/push_20n.yaml
//
// Sixteen variants of the experiment run in parallel, with the velocity gain B of its impedance
// control from a quarter to twice the file's value. Each score is minus the time integral of the
// speed of the fastest node after the push. The example asserts that the scores are finite, differ,
// and do not depend on the number of worlds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "taut/rollout.h"

namespace {

class Stillness final : public taut::Score {
 public:
  explicit Stillness(const taut::ControlSetup& setup)
      : nodes_(static_cast<int>(setup.experiment.robot.def.nodes.size())),
        way_m_(setup.lanes.size()) {
    for (const taut::PushSpec& push : setup.experiment.pushes) {
      from_s_ = std::max(from_s_, push.force_n.back().first);
    }
  }

  void Take(const taut::Observation& now, const taut::Commands&, const taut::World& world,
            const double* step_s) override {
    for (int lane = 0; lane < static_cast<int>(way_m_.size()); ++lane) {
      if (now.time_s[lane] < from_s_) continue;
      double fastest = 0.0;
      for (int node = 0; node < nodes_; ++node) {
        const taut::Vec3 v = world.NodeVelocity(lane, node);
        fastest = std::max(fastest, v.x * v.x + v.y * v.y + v.z * v.z);
      }
      way_m_[static_cast<std::size_t>(lane)] += step_s[lane] * std::sqrt(fastest);
    }
  }
  double Result(int lane) const override { return -way_m_[static_cast<std::size_t>(lane)]; }

 private:
  int nodes_;
  double from_s_ = 0.0;
  std::vector<double> way_m_;
};

std::vector<double> Scores(const taut::ExperimentSpec& experiment, taut::Simd simd,
                           taut::Diagnostics& out) {
  taut::RolloutOptions options;
  options.threads = 0;  // one per core
  options.simd = simd;
  options.score = [](const taut::ControlSetup& setup) {
    return std::make_unique<Stillness>(setup);
  };
  const auto rollouts = taut::Rollouts::Create(experiment, {}, options, out);
  if (!rollouts) return {};
  std::vector<taut::RolloutWorld> worlds(16, taut::WorldOf(experiment));
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    for (taut::ControllerSpec& controller : worlds[i].controllers) {
      if (!controller.impedance) continue;
      for (taut::ImpedanceGains& gains : controller.impedance->cables) {
        gains.velocity_gain_n_s_per_m *= std::pow(2.0, -2.0 + 0.2 * static_cast<double>(i));
      }
    }
  }
  std::vector<double> scores;
  for (const taut::RolloutResult& result : rollouts->Run(worlds)) scores.push_back(result.score);
  return scores;
}

}  // namespace

int main(int argc, char** argv) {
  taut::Diagnostics out;
  auto experiment = argc == 2 ? taut::LoadExperiment(argv[1], {}, out) : std::nullopt;
  if (!experiment) {
    std::fprintf(stderr, "usage: own_score share/experiments/push_20n.yaml\n%s",
                 out.Format().c_str());
    return 2;
  }
  const std::vector<double> scores = Scores(*experiment, taut::BestSimd(), out);
  if (scores.empty()) return 1;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    std::printf("B times %.2f: %.5f m\n", std::pow(2.0, -2.0 + 0.2 * static_cast<double>(i)),
                scores[i]);
  }
  const bool finite = std::all_of(scores.begin(), scores.end(),
                                  [](double score) { return std::isfinite(score) && score < 0; });
  const bool differ = *std::max_element(scores.begin(), scores.end()) >
                      *std::min_element(scores.begin(), scores.end());
  const bool same = scores == Scores(*experiment, taut::Simd::kScalar, out);
  std::printf("%s\n", same ? "one by one: the same" : "one by one: others");
  return finite && differ && same ? 0 : 1;
}
