// The hand-tuned gait with the amplitudes of the simulation and of the robot: two cells of
// docs/validation/sine_amplitude.md
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut {
namespace {

constexpr std::size_t kSegments = 3, kPerSegment = 5;  // x, y, z, and x, y of the orientation

/// Least distance of neighboring segments and least uprightness
class SineWatch final : public test::RowWatch {
 public:
  bool Append(double, const double* values) override {
    for (std::size_t i = 0; i < kSegments; ++i) {
      const double* const at = values + kPerSegment * i;
      const double* const next = at + kPerSegment;
      uprightness = std::min(uprightness, 1 - 2 * (at[3] * at[3] + at[4] * at[4]));
      if (i + 1 == kSegments) break;
      const double apart_m = std::hypot(at[0] - next[0], at[1] - next[1], at[2] - next[2]);
      nearest_m = std::min(nearest_m, apart_m);
    }
    return true;
  }
  double nearest_m = 1, uprightness = 1;  ///< Uprightness: cosine of the tilt.
};

SineWatch Walk(double factor, const std::string& ground_friction) {
  Diagnostics out;
  auto experiment = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/sine_hand_tuned.yaml",
                                   {{"ground_friction", ground_friction}}, out);
  SineWatch watch;
  EXPECT_TRUE(experiment) << out.Format();
  if (!experiment) return watch;
  for (SineWave& wave : experiment->controllers[0].velocity_input->gait.sine->waves) {
    wave.amplitude *= factor, wave.offset *= factor;
  }
  experiment->duration_s = 15;
  experiment->phases.clear();
  experiment->record.rate_hz = 25;
  experiment->record.channels = {"body/*/position_*_m", "body/*/orientation_x",
                                 "body/*/orientation_y"};
  EXPECT_EQ(RunChannels(*experiment).size(), kSegments * kPerSegment);
  RunOptions options;
  options.traces = {&watch};
  const auto summary = RunExperiment(*experiment, options, out);
  EXPECT_TRUE(summary) << out.Format();
  EXPECT_TRUE(summary && summary->status_text.empty());
  return watch;
}

// Ground friction times the robot's 0.15: 0.075 as in NTRT, and 1.2
TEST(HandTunedSine, KeepsItsSegmentsApart) {
  for (const char* const ground : {"0.5", "8"}) {
    const SineWatch watch = Walk(1, ground);
    EXPECT_GT(watch.nearest_m, 0.10) << ground;
    EXPECT_GT(watch.uprightness, std::cos(0.35)) << ground;
  }
}

TEST(HandTunedSine, WithTheRobotsAmplitudesSlidesTogetherAndDoesNotTopple) {
  for (const char* const ground : {"0.5", "8"}) {
    const SineWatch watch = Walk(10, ground);
    EXPECT_LT(watch.nearest_m, 0.02) << ground;
    EXPECT_GT(watch.uprightness, std::cos(0.6)) << ground;
  }
}

}  // namespace
}  // namespace taut
