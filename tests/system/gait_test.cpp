// The paper's two gait experiments compared with NTRT's runs: the main figures of
// docs/validation/gaits.md
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "system/columns.h"
#include "taut/run.h"
#include "taut/spec.h"

namespace taut {
namespace {

const std::string kGaitRoot = TAUT_SOURCE_DIR "/";
constexpr double kRowS = 0.04;  // period of NTRT's traces in tests/data

ExperimentSpec LoadGaitExperiment(const std::string& name) {
  Diagnostics out;
  auto experiment = LoadExperiment(kGaitRoot + "share/experiments/" + name + ".yaml", {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  return experiment.value_or(ExperimentSpec{});
}

struct GaitOutcome {
  Columns columns;
  double largest_n = 0;
};

GaitOutcome Simulate(ExperimentSpec experiment) {
  experiment.record.rate_hz = 1 / kRowS;
  experiment.record.channels = {"cable/*/elastic_n", "system/com_*_m", "body/*/position_*_m"};
  Rows rows(experiment);
  RunOptions options;
  options.traces = {&rows};
  Diagnostics out;
  const auto summary = RunExperiment(experiment, options, out);
  EXPECT_TRUE(summary) << out.Format();
  if (!summary) return {};
  EXPECT_EQ(summary->status_text, "");
  GaitOutcome outcome{std::move(rows.columns), 0};
  for (const auto& cable : summary->cables) {
    outcome.largest_n = std::max(outcome.largest_n, cable.elastic.max_n);
  }
  return outcome;
}

/// Returns the rows from 30 to 60 s.
std::vector<double> Walking(const std::vector<double>& values) {
  EXPECT_EQ(values.size(), 1501u);
  return {values.begin() + 750, values.begin() + 1500};
}

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Returns the frequency of the strongest spectral line [Hz]: the best of the window's grid, then
/// refined between its neighbors.
double Strongest(const std::vector<double>& values) {
  const double mean = Mean(values), count = static_cast<double>(values.size());
  const auto size = [&](double hz) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double at = static_cast<double>(i);
      const double hann = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (at + 0.5) / count);
      sum += hann * (values[i] - mean) * std::polar(1.0, -2 * std::numbers::pi * hz * kRowS * at);
    }
    return std::abs(sum);
  };
  const double grid = 1 / (kRowS * count);
  double best = grid;
  for (double hz = 6 * grid; hz < 6.0; hz += grid) {
    if (size(hz) > size(best)) best = hz;
  }
  double low = best - grid, high = best + grid;
  while (high - low > 1e-4) {
    const double third = (high - low) / 3;
    if (size(low + third) < size(high - third)) {
      low += third;
    } else {
      high -= third;
    }
  }
  return (low + high) / 2;
}

double ComMoved(const Columns& columns, const char* axis, double time_s) {
  const auto& values = columns.at(std::string("system/com_") + axis + "_m");
  return values[static_cast<std::size_t>(std::lround(time_s / kRowS))] - values[0];
}

/// Returns the heading from the rear to the front segment, relative to the start; positive to the
/// left [rad].
double Turned(const Columns& columns) {
  const auto at = [&](const char* segment, const char* axis) {
    return columns.at(std::string("body/") + segment + "/position_" + axis + "_m").back();
  };
  return std::atan2(at("segment_0", "y") - at("segment_2", "y"),
                    at("segment_0", "x") - at("segment_2", "x"));
}

/// Returns NTRT's tensions under taut's channel names.
Columns NtrtTensions(const std::string& file) {
  Diagnostics out;
  const auto trace = ReadTrace(kGaitRoot + "tests/data/ntrt/" + file, out);
  EXPECT_TRUE(trace) << out.Format();
  Columns columns;
  const std::string ending = "_tension_N";
  for (std::size_t i = 0; trace && i < trace->channels.size(); ++i) {
    const std::string& name = trace->channels[i].name;
    if (!name.ends_with(ending)) continue;
    columns["cable/" + name.substr(0, name.size() - ending.size()) + "/elastic_n"] =
        trace->values[i];
  }
  EXPECT_EQ(columns.size(), 12u);
  return columns;
}

/// Expects means within `mean_percent` of NTRT's largest tension, and strongest lines within 1 %.
void ExpectLikeNtrt(const GaitOutcome& outcome, const Columns& ntrt, double largest_n,
                    double mean_percent) {
  EXPECT_NEAR(outcome.largest_n, largest_n, 0.005 * largest_n);
  for (const auto& [name, values] : ntrt) {
    const std::vector<double> its = Walking(values), own = Walking(outcome.columns.at(name));
    EXPECT_NEAR(Mean(own), Mean(its), mean_percent / 100 * largest_n) << name;
    const double its_hz = Strongest(its), own_hz = Strongest(own);
    // The hand-tuned gait causes two lines of equal strength in outer left 1 and outer right 1.
    const bool two_lines = own_hz > 2 * its_hz && Mean(its) < 5.0;
    EXPECT_NEAR(own_hz, (two_lines ? 3 : 1) * its_hz, 0.01 * own_hz) << name;
  }
}

// NTRT's largest tensions are from 100 Hz samples (26.93 N and 30.27 N).
TEST(Gaits, TheHandTunedGaitUnderNtrtsLawsIsNtrts) {
  const GaitOutcome outcome = Simulate(LoadGaitExperiment("sine_hand_tuned_ntrt"));
  ExpectLikeNtrt(outcome, NtrtTensions("sine_hand_tuned_1000hz.csv.gz"), 26.9256, 0.3);
  // NTRT: 18.2 cm straight ahead; 17.0 to 25.0 cm with other steps and solvers
  EXPECT_GT(ComMoved(outcome.columns, "x", 60), 0.17);
  EXPECT_LT(ComMoved(outcome.columns, "x", 60), 0.27);
  EXPECT_NEAR(ComMoved(outcome.columns, "y", 60), 0.0, 0.005);
  EXPECT_NEAR(Turned(outcome.columns), 0.0, 0.01);
}

TEST(Gaits, TheLearnedGaitUnderNtrtsLawsIsNtrts) {
  const GaitOutcome outcome = Simulate(LoadGaitExperiment("cpg_learned_ntrt"));
  ExpectLikeNtrt(outcome, NtrtTensions("cpg_learned_1000hz.csv.gz"), 30.2723, 0.3);
  // NTRT: 20.0 cm to the left in 20 s and 57.5 cm in 60 s, turning to the right
  EXPECT_NEAR(ComMoved(outcome.columns, "y", 20), 0.20, 0.03);
  EXPECT_NEAR(ComMoved(outcome.columns, "y", 60), 0.575, 0.1);
  EXPECT_LT(Turned(outcome.columns), -0.4);
}

TEST(Gaits, UnderTautsOwnLawsTheyGoTheSameWays) {
  const GaitOutcome sine = Simulate(LoadGaitExperiment("sine_hand_tuned"));
  ExpectLikeNtrt(sine, NtrtTensions("sine_hand_tuned_1000hz.csv.gz"), 26.9256, 0.3);
  EXPECT_NEAR(ComMoved(sine.columns, "x", 60), 0.21, 0.03);
  const GaitOutcome learned = Simulate(LoadGaitExperiment("cpg_learned"));
  EXPECT_NEAR(learned.largest_n, 31.46, 0.1);  // the gait is sampled at 100 Hz
  EXPECT_NEAR(ComMoved(learned.columns, "y", 60), 0.62, 0.06);
  EXPECT_LT(Turned(learned.columns), -0.4);
}

/// Returns the distance of the center of mass in 20 s, mean over starts a micrometer apart [m].
double Distance(const std::string& name, double step_s, int starts) {
  double sum = 0;
  for (int start = 0; start < starts; ++start) {
    ExperimentSpec experiment = LoadGaitExperiment(name);
    experiment.step_s = step_s;
    experiment.duration_s = 20;
    experiment.phases.clear();
    for (auto& controller : experiment.controllers) {
      controller.clock.period_s = 0.004;
      controller.velocity_input->clock.period_s = 0.02;
      controller.impedance->differenced_rate = true;
    }
    for (auto& cable : experiment.robot.def.cables) cable.rest_length_m += 1e-6 * start;
    const GaitOutcome outcome = Simulate(experiment);
    sum += std::hypot(ComMoved(outcome.columns, "x", 20), ComMoved(outcome.columns, "y", 20));
  }
  return sum / starts;
}

// With one controller clock, and rates from differences as on a board.
TEST(Gaits, DistanceHardlyDependsOnTheStep) {
  const double learned_m = Distance("cpg_learned", 0.00025, 1);
  for (const double step_s : {0.001, 0.004}) {
    EXPECT_NEAR(Distance("cpg_learned", step_s, 1), learned_m, 0.01 * learned_m) << step_s;
  }
  const double sine_m = Distance("sine_hand_tuned", 0.00025, 4);
  for (const double step_s : {0.001, 0.004}) {
    EXPECT_NEAR(Distance("sine_hand_tuned", step_s, 4), sine_m, 0.03 * sine_m) << step_s;
  }
}

}  // namespace
}  // namespace taut
