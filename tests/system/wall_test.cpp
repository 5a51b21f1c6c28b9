// Twelve segments that crawl over a wall (docs/validation/wall.md)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut {
namespace {

constexpr double kFarSideM = 1.20;
constexpr double kReachM = 0.25;  // no point of a segment is further from its center of mass

/// x of the rearmost segment in the last row, and the largest lateral displacement of any segment
class Watch final : public test::RowWatch {
 public:
  explicit Watch(std::size_t segments) : segments_(segments) {}
  bool Append(double, const double* values) override {
    rearmost_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < segments_; ++i) {
      rearmost_m = std::min(rearmost_m, values[2 * i]);
      aside_m = std::max(aside_m, std::fabs(values[2 * i + 1]));
    }
    return true;
  }
  double rearmost_m = 0, aside_m = 0;

 private:
  std::size_t segments_;
};

void ExpectOver(const std::string& height_m, double within_s, const std::string& name = "wall") {
  Diagnostics out;
  auto experiment = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/" + name + ".yaml",
                                   {{"wall_height_m", height_m}}, out);
  ASSERT_TRUE(experiment) << out.Format();
  experiment->duration_s = within_s;
  experiment->record.rate_hz = 4;
  experiment->record.channels = {"body/*/position_x_m", "body/*/position_y_m"};
  ASSERT_EQ(RunChannels(*experiment).size(), 24u);
  Watch watch(12);
  RunOptions options;
  options.traces = {&watch};
  const auto summary = RunExperiment(*experiment, options, out);
  ASSERT_TRUE(summary) << out.Format();
  EXPECT_EQ(summary->status_text, "");
  EXPECT_GT(watch.rearmost_m, kFarSideM + kReachM);
  EXPECT_LT(watch.aside_m, 2.5);  // not around the wall, which extends 3 m to either side
}

TEST(Wall, TwelveSegmentsCrawlOverAWallAsHighAsNtrts) { ExpectOver("0.02", 40); }
TEST(Wall, AndOverOneThreeTimesAsHigh) { ExpectOver("0.06", 52); }
TEST(Wall, AlsoIfItsCablesLieOverTheEdges) { ExpectOver("0.04", 48, "wall_touching"); }
TEST(Wall, AndOverHalfItsHeightByWhatTheyFeel) { ExpectOver("0.16", 48, "wall_sensing_high"); }

}  // namespace
}  // namespace taut
