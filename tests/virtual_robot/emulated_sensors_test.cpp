// Emulated load cells and encoders
#include "apps/virtual_robot/emulated_sensors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace taut::virtual_robot {
namespace {

TEST(LoadCell, FollowsTheCalibrationOfThePaper) {
  // Equation 7: force = 0.1567 code - 4.9363
  for (double force = -4.9; force < 111.2; force += 0.01) {
    const int code = LoadCellCode({}, force, 0.0);
    EXPECT_NEAR(0.1567 * code - 4.9363, force, 0.1567 / 2 + 1e-9);
  }
  EXPECT_EQ(LoadCellCode({}, 0.0, 0.0), 32) << "31.50";
}

TEST(LoadCell, EndsWhereItsAmplifierEnds) {
  EXPECT_EQ(LoadCellCode({}, 111.21, 0.0), 741);
  EXPECT_EQ(LoadCellCode({}, 150.0, 0.0), 741);
  EXPECT_EQ(LoadCellCode({}, 1e9, 3.0), 741);
  EXPECT_EQ(LoadCellCode({}, -10.0, 0.0), 0) << "compression beyond 4.9 N reads as nothing";
}

TEST(LoadCell, NoiseIsInCounts) {
  const BoardLoadCell noisy{.noise_counts = 2.0};
  EXPECT_EQ(LoadCellCode(noisy, 50.0, 1.5), LoadCellCode(noisy, 50.0, 0.0) + 3);
  EXPECT_EQ(LoadCellCode({.noise_counts = 0.0}, 50.0, 3.0), LoadCellCode({}, 50.0, 0.0));
}

TEST(Encoder, HasSixtyFourStatesATurn) {
  constexpr double kTurn = 6.283185307179586;
  Encoder encoder({}, 0.0);
  std::size_t edges = 0;
  for (int i = 1; i <= 1000; ++i) edges += encoder.Turn(i * 0.01 * kTurn, 1000, 0).size();
  EXPECT_NEAR(static_cast<double>(encoder.states()), 640.0, 1.0);
  EXPECT_EQ(static_cast<std::int64_t>(edges), encoder.states());
  for (int i = 999; i >= -1000; --i) encoder.Turn(i * 0.01 * kTurn, 1000, 0);
  EXPECT_NEAR(static_cast<double>(encoder.states()), -640.0, 1.0);
}

TEST(Encoder, OneLineChangesAtATimeAndALeadsWhereTheAngleGrows) {
  Encoder encoder({}, 0.0);
  EncoderEdge last = encoder.Now(0);
  for (const double angle : {0.5, 1.0, 7.0}) {
    for (const EncoderEdge& edge : encoder.Turn(angle, kMillisecond, 0)) {
      EXPECT_NE(edge.a != last.a, edge.b != last.b);
      EXPECT_EQ(edge.a != last.a, edge.a != edge.b) << "A goes first";
      last = edge;
    }
  }
  for (const EncoderEdge& edge : encoder.Turn(-2.0, kMillisecond, 0)) {
    EXPECT_EQ(edge.a != last.a, edge.a == edge.b) << "B goes first";
    last = edge;
  }
}

TEST(Encoder, EdgesComeWhenTheShaftPasses) {
  // From angle 0 at a constant rate, state n begins at n steps of 1/64 turn.
  Encoder encoder({}, 0.0);
  const double step = 6.283185307179586 / 64;
  const auto edges = encoder.Turn(10.5 * step, 105 * kMicrosecond, 7 * kMicrosecond);
  ASSERT_EQ(edges.size(), 10U);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_NEAR(ToSeconds(edges[i].at), 7e-6 + 10e-6 * static_cast<double>(i + 1), 1e-12);
  }
  const auto back = encoder.Turn(8.5 * step, 20 * kMicrosecond, 0);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_NEAR(ToSeconds(back[0].at), 5e-6, 1e-12);
  EXPECT_NEAR(ToSeconds(back[1].at), 15e-6, 1e-12);
}

}  // namespace
}  // namespace taut::virtual_robot
