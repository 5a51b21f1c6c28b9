// Step size for integrating the learned network: the errors of docs/theory/gaits.md
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "taut/play.h"

namespace taut::test {
namespace {

const std::string kIntegratorRoot = TAUT_SOURCE_DIR "/";
constexpr double kPlayedS = 10.0, kRateHz = 100.0;  // of the shipped experiment

GaitSpec LoadShippedGait(const std::string& name) {
  Diagnostics out;
  const auto gait = LoadGait(kIntegratorRoot + "share/gaits/" + name + ".yaml", out);
  if (!gait) throw std::runtime_error(out.Format());
  return *gait;
}

/// Returns the network's commands when it is integrated in steps of `step_s`.
std::vector<std::vector<double>> Play(double step_s, double played_s = kPlayedS) {
  Diagnostics out;
  const auto robot = LoadRobot(kIntegratorRoot + "share/models/tetraspine3.yaml", {}, out);
  GaitSpec gait = LoadShippedGait("cpg_learned");
  gait.cpg->integrator_step_s = step_s;
  const auto table = robot ? PlayGait(gait, *robot, kRateHz, played_s, out) : std::nullopt;
  if (!table) throw std::runtime_error(out.Format());
  return table->rows;
}

/// Returns the largest difference of any cable's velocity up to a time [m/s].
double Worst(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b,
             double until_s) {
  double worst = 0.0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(until_s * kRateHz + 0.5); ++i) {
    for (std::size_t c = 0; c < a[i].size(); ++c) {
      worst = std::max(worst, std::fabs(a[i][c] - b[i][c]));
    }
  }
  return worst;
}

class GaitIntegrator : public testing::Test {
 protected:
  /// In steps of 1/16 ms, whose error is 1/256 of the error at 1/4 ms.
  const std::vector<std::vector<double>> exact_ = Play(0.0000625);
  double Error(double step_s) const { return Worst(Play(step_s), exact_, kPlayedS); }
};

// Halving the step divides the error by 16. The next order contributes 4 % at 2 ms, and less below.
TEST_F(GaitIntegrator, TheErrorIsOfFourthOrder) {
  double coarser = Error(0.002);
  for (const double step_s : {0.001, 0.0005, 0.00025}) {
    const double error = Error(step_s);
    EXPECT_NEAR(coarser / error, 16.0, 0.8) << step_s;
    coarser = error;
  }
}

// The phases drift: the error grows linearly with time, here by a factor of three. It is random
// which tick falls on the steepest part of a wave, hence a tolerance of a tenth. The finer step
// counts as exact: its error is 1/4096.
TEST(GaitIntegratorInTime, TheErrorGrowsWithTimeAndNoFaster) {
  const auto played = Play(0.002, 30.0), exact = Play(0.00025, 30.0);
  EXPECT_NEAR(Worst(played, exact, 30.0) / Worst(played, exact, 10.0), 3.0, 0.3);
}

// Relative to the amplitude of 0.515 m/s, at the step of the shipped gait; at NTRT's step it is
// 4000 times smaller.
TEST_F(GaitIntegrator, AtTheShippedStepItIsATenthOfAPercent) {
  const double amplitude = LoadShippedGait("cpg_learned").cpg->amplitude;
  EXPECT_LT(Error(LoadShippedGait("cpg_learned").cpg->integrator_step_s), 0.00125 * amplitude);
  EXPECT_LT(Error(LoadShippedGait("cpg_learned_ntrt").cpg->integrator_step_s), 1e-6 * amplitude);
  EXPECT_GT(Error(0.005), 0.04 * amplitude) << "so far the step can be too long";
}

// Apart from the step the fine gait equals the shipped one.
TEST_F(GaitIntegrator, OnlyTheStepIsNtrts) {
  GaitSpec fine = LoadShippedGait("cpg_learned_ntrt");
  const GaitSpec shipped = LoadShippedGait("cpg_learned");
  EXPECT_EQ(fine.cpg->integrator_step_s, shipped.cpg->integrator_step_s / 8);
  fine.cpg->integrator_step_s = shipped.cpg->integrator_step_s;
  fine.name = shipped.name;
  fine.description = shipped.description;
  EXPECT_EQ(GaitYaml(fine), GaitYaml(shipped));
}

}  // namespace
}  // namespace taut::test
