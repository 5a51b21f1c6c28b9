// Time-weighted means of the phases of a run, for steps of any length
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut {
namespace {

/// Means of one column between two times, weighted by time and by rows, if a run records each step
class ColumnMeans final : public test::RowWatch {
 public:
  ColumnMeans(std::size_t column, double from_s, double to_s)
      : column_(column), from_s_(from_s), to_s_(to_s) {}
  bool Append(double time_s, const double* values) override {
    if (time_s > from_s_ - 1e-9 && time_s < to_s_ + 1e-9) {
      integral_ += values[column_] * (time_s - before_s_);
      length_s_ += time_s - before_s_;
      sum_ += values[column_];
      ++rows_;
    }
    before_s_ = time_s;
    return true;
  }
  double over_time() const { return integral_ / length_s_; }
  double over_rows() const { return sum_ / rows_; }

 private:
  std::size_t column_;
  double from_s_, to_s_, before_s_ = 0, integral_ = 0, length_s_ = 0, sum_ = 0, rows_ = 0;
};

TEST(PhaseMean, IsOverTimeAndNotOverSteps) {
  Diagnostics out;
  auto experiment = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml", {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  experiment->start = StartKind::kAsDescribed;  // not settled: tensions change
  experiment->duration_s = 0.06;
  experiment->sensors.emplace();
  experiment->sensors->period_s = 0.0007;  // with the controller's 1 ms: steps of 0.1 to 0.7 ms
  experiment->record = {};
  experiment->record.rate_hz = 0;
  experiment->phases = {{"part", 0.02, 0.05}};
  const std::vector<ChannelInfo> channels = RunChannels(*experiment);
  const std::string cable = experiment->robot.def.cables[0].name;
  const auto column = std::find_if(channels.begin(), channels.end(), [&](const ChannelInfo& one) {
    return one.name == "cable/" + cable + "/tension_n";
  });
  ASSERT_NE(column, channels.end());
  ColumnMeans means(static_cast<std::size_t>(column - channels.begin()), 0.02, 0.05);
  RunOptions options;
  options.traces = {&means};
  const auto run = RunExperiment(*experiment, options, out);
  ASSERT_TRUE(run) << out.Format();
  const double mean_n = run->cables[0].tension.phases[0].mean;
  EXPECT_NEAR(mean_n, means.over_time(), 1e-9 * mean_n);
  EXPECT_GT(std::fabs(mean_n - means.over_rows()), 1e-6 * mean_n) << "the two differ here";
}

}  // namespace
}  // namespace taut
