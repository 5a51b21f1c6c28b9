// Shipped experiments on terrain of many boxes
#include <gtest/gtest.h>

#include <algorithm>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut {
namespace {

/// Positions of the bodies in the first and the last row, and the lowest height of any body
class Places final : public test::RowWatch {
 public:
  explicit Places(std::size_t bodies) : bodies_(bodies) {}
  bool Append(double, const double* values) override {
    if (rows_++ == 0) first.assign(values, values + 3 * bodies_);
    last.assign(values, values + 3 * bodies_);
    for (std::size_t b = 0; b < bodies_; ++b) lowest_m = std::min(lowest_m, values[3 * b + 2]);
    return true;
  }
  /// Returns the mean over the bodies of coordinate `axis`.
  double Mean(const std::vector<double>& row, std::size_t axis) const {
    double sum = 0;
    for (std::size_t b = 0; b < bodies_; ++b) sum += row[3 * b + axis];
    return sum / static_cast<double>(bodies_);
  }
  std::vector<double> first, last;
  double lowest_m = 1e9;

 private:
  std::size_t bodies_;
  int rows_ = 0;
};

Places Drive(const std::string& name, std::size_t bodies, double duration_s) {
  Diagnostics out;
  auto experiment = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/" + name + ".yaml", {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  Places places(bodies);
  if (!experiment) return places;
  EXPECT_LE(experiment->duration_s, duration_s);
  experiment->duration_s = duration_s;
  experiment->record.channels = {"body/*/position_*"};
  EXPECT_EQ(RunChannels(*experiment).size(), 3 * bodies);
  RunOptions options;
  options.traces = {&places};
  const auto summary = RunExperiment(*experiment, options, out);
  EXPECT_TRUE(summary) << out.Format();
  EXPECT_EQ(out.items().size(), 0u) << out.Format();
  EXPECT_EQ(summary ? summary->status_text : "no run", "");
  return places;
}

TEST(ManyBoxes, TwelveSegmentsCrawlOverABlockField) {
  const Places places = Drive("block_field", 12, 20);
  EXPECT_GT(places.Mean(places.last, 0), places.Mean(places.first, 0) + 0.3);
  // The rods, 6 mm thick, lie on the ground or on blocks of 25 mm; the centers of mass are higher.
  EXPECT_GT(places.lowest_m, 0.02);
  EXPECT_LT(places.Mean(places.last, 2), 0.3);
}

TEST(ManyBoxes, SixStrutsFallDownStairs) {
  const Places places = Drive("stairs", 6, 5);
  EXPECT_GT(places.Mean(places.first, 2), 3);
  EXPECT_LT(places.Mean(places.last, 0), -1);  // off the stairs, whose foot is at 0
  EXPECT_LT(places.Mean(places.last, 2), 1);
  EXPECT_GT(places.lowest_m, 0);
}

}  // namespace
}  // namespace taut
