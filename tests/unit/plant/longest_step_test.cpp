// Longest step of a run, against the steps of actual runs
#include <gtest/gtest.h>

#include <algorithm>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut {
namespace {

/// Measures the longest step between rows of a run that records every step.
class LongestRow final : public test::RowWatch {
 public:
  bool Append(double time_s, const double*) override {
    longest_s_ = std::max(longest_s_, time_s - time_s_);
    time_s_ = time_s;
    return true;
  }
  double longest_s() const { return longest_s_; }

 private:
  double time_s_ = 0, longest_s_ = 0;
};

ExperimentSpec LoadLongest(const char* name) {
  Diagnostics out;
  auto experiment =
      LoadExperiment(std::string(TAUT_SOURCE_DIR "/share/experiments/") + name, {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  experiment->start = StartKind::kAsDescribed;
  experiment->duration_s = 0.12;  // whole steps of each length below
  experiment->record = {};
  experiment->record.rate_hz = 0;
  return std::move(*experiment);
}

double LongestStepOfRun(const ExperimentSpec& experiment) {
  Diagnostics out;
  LongestRow trace;
  RunOptions options;
  options.traces = {&trace};
  EXPECT_TRUE(RunExperiment(experiment, options, out)) << out.Format();
  return trace.longest_s();
}

std::string WarningOf(const ExperimentSpec& experiment) {
  Diagnostics out;
  WarnOfStep(experiment, out);
  EXPECT_TRUE(out.ok());
  return out.warnings().empty() ? "" : out.warnings().front().what;
}

TEST(LongestStepTest, IsThatOfTheRun) {
  for (const char* const name : {"push_20n.yaml", "hang.yaml", "puppy_trot.yaml"}) {
    ExperimentSpec experiment = LoadLongest(name);
    for (const double step_s : {0.0003, 0.001, 0.004, 0.02}) {
      experiment.step_s = step_s;
      EXPECT_NEAR(LongestStep(experiment), LongestStepOfRun(experiment), 1e-12)
          << name << " " << step_s;
    }
  }
}

TEST(LongestStepTest, OfAStepWithoutEffectThereIsAWarning) {
  ExperimentSpec experiment = LoadLongest("push_20n.yaml");
  EXPECT_EQ(WarningOf(experiment), "");
  experiment.step_s = 0.0003;
  EXPECT_EQ(WarningOf(experiment), "");
  experiment.step_s = 0.004;
  EXPECT_EQ(WarningOf(experiment), "step_s 0.004 has no effect: controller \"" +
                                       experiment.controllers[0].name +
                                       "\" has a period of 0.001 s, and steps are shortened to end "
                                       "at every tick");
  experiment.sensors.emplace();
  experiment.sensors->period_s = 0.0005;
  experiment.step_s = 0.001;
  EXPECT_EQ(WarningOf(experiment),
            "step_s 0.001 has no effect: the sensors have a period of 0.0005 s, and steps are "
            "shortened to end at every tick");
}

}  // namespace
}  // namespace taut
