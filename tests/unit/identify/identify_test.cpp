// Model results compared with measurements: against the closed form of a hanging mass
#include <cmath>

#include "identify/computed.h"
#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

using test::Height;
using test::IdentifyTest;
using test::kExperiment;
using test::kFit;

TEST_F(IdentifyTest, RestsAreTheClosedForm) {
  const auto fit = Make(kFit);
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->train_points().size(), 2u);
  EXPECT_EQ(fit->train_points()[0].where, "set point 1");
  EXPECT_NEAR(fit->train_points()[1].measured, Height(0.7, 110), 1e-12);
  const Residuals at = At(*fit, {125, 0.003});
  ASSERT_EQ(at.failed, "");
  for (int i = 0; i < 2; ++i) {
    const double rest_m = i == 0 ? 0.8 : 0.7;
    // in standard deviations of 1 mm
    EXPECT_NEAR(at.value[i], (Height(rest_m, 125) + 0.003 - Height(rest_m, 110)) / 0.001, 1e-4);
  }
}

TEST_F(IdentifyTest, RunsComeToTheSameRest) {
  const auto fit = Make(Replaced(kFit, "forward: static", "forward: dynamic"));
  ASSERT_TRUE(fit) << out_.Format();
  const Residuals at = At(*fit, {125, 0});
  ASSERT_EQ(at.failed, "");
  // the oscillation decays by exp(-8 t): after a second it is at most 0.3 mm, in the mean far less
  EXPECT_NEAR(at.value[1], (Height(0.7, 125) - Height(0.7, 110)) / 0.001, 0.05);
}

TEST_F(IdentifyTest, AClockThatIsLateMovesTheWindowsOfTheRun) {
  WriteData("node/ball/position_z_m", 100, 2.0);
  const std::string text = Replaced(
      Replaced(kFit, "forward: static", "forward: dynamic"),
      "residuals: [{channel: node/ball/position_z_m, sd: 0.001, window: {after_setpoint_s: [1, "
      "2]}}]",
      "residuals: [{channel: node/ball/position_z_m, sd: 0.001, window: {from_s: 2, to_s: 3}}]");
  const auto fit = Make(Replaced(text, "{parameter: k_n_per_m, prior: {sd: 5}}",
                                 "{clock: data, delay_s: {low: 0, high: 4}}"));
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_NEAR(fit->train_points()[0].measured, Height(0.8, 100), 1e-12);
  // the search starts in the middle, where the clock is 2 s late: window 2..3 s of the run
  EXPECT_NEAR(At(*fit, {2, 0}).value[0], 0, 0.1);
  // with 0.5 s less the window is 2.5..3.5 s, still at rest; with 1.5 s less the next set point
  EXPECT_NEAR(At(*fit, {1.5, 0}).value[0], 0, 0.1);
  EXPECT_GT(At(*fit, {0.5, 0}).value[0], 50);
}

TEST_F(IdentifyTest, ATrialThatCannotBeComputedSaysWhy) {
  const auto fit = Make(kFit);
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_NE(At(*fit, {-1, 0}).failed.find("a: "), std::string::npos) << At(*fit, {-1, 0}).failed;
  EXPECT_NE(At(*fit, {-1, 0}).failed.find("positive"), std::string::npos);
}

TEST_F(IdentifyTest, WhatWasComputedIsRememberedToTheBit) {
  std::vector<double> first;
  {
    const auto fit = Make(kFit, "fit.sqlite");
    ASSERT_TRUE(fit) << out_.Format();
    first = At(*fit, {125, 0.003}).value;
    EXPECT_EQ(fit->counts().computed, 1);
  }
  const auto fit = Make(kFit, "fit.sqlite");
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_EQ(fit->counts().remembered, 1);
  EXPECT_EQ(At(*fit, {125, 0.003}).value, first);
  EXPECT_EQ(fit->counts().computed, 0);
  EXPECT_NE(Wrong("").size(), 0u);
  Write("fit.yaml", kFit);
  Write("experiment.yaml", Replaced(kExperiment, "up_m: 0.1", "up_m: 0.11"));
  EXPECT_FALSE(Make(kFit, "fit.sqlite"));
  EXPECT_NE(out_.Format().find("belongs to another fit, which differs in experiments"),
            std::string::npos)
      << out_.Format();
}

TEST_F(IdentifyTest, DataThatNoWindowMeetsAreAMistake) {
  WriteData("node/ball/position_z_m", 110, 62000);
  EXPECT_EQ(
      Wrong(kFit),
      "residuals: no window of \"node/ball/position_z_m\" contains data of a (the data of a cover "
      "62000..62006 s, the experiment 0..6 s; if their clocks differ, relate them by `clock`, "
      "`setpoints` or `window`)\n");
}

TEST_F(IdentifyTest, ChannelsThatOneSideLacksAreMistakes) {
  EXPECT_EQ(
      Wrong(Replaced(kFit, "channel: node/ball/position_z_m", "channel: node/bull/position_z_m")),
      "residuals: the data of a have no channel \"node/bull/position_z_m\" (did you mean "
      "\"node/ball/position_z_m\"?; `map` can translate names)\n");
  WriteData("node/bull/position_z_m", 110, 0);
  EXPECT_EQ(Wrong(Replaced(kFit, "channel: node/ball/", "channel: node/*/")),
            "residuals: there is no computed channel \"node/bull/position_z_m\" of a (did you mean "
            "\"node/ball/position_z_m\"?)\n");
  WriteData("node/ball/position_z_cm", 110, 0);
  EXPECT_EQ(
      Wrong(Replaced(kFit, "channel: node/ball/position_z_m", "channel: node/ball/position_z_*")),
      "residuals: there is no computed channel \"node/ball/position_z_cm\" of a (did you mean "
      "\"node/ball/position_z_m\"?)\n");
}

TEST_F(IdentifyTest, OffsetsOfNothingAreMistakes) {
  EXPECT_EQ(Wrong(Replaced(kFit, "{channel: node/*/position_z_m", "{channel: node/*/position_x_m")),
            "estimate: no compared channel is affected by offset node/*/position_x_m (did you "
            "mean \"node/ball/position_z_m\"?)\n");
}

TEST_F(IdentifyTest, FewerDataThanNumbersAreAMistake) {
  EXPECT_EQ(Wrong(Replaced(Replaced(kFit, "prior: {sd: 5}", "scale: 5"), "offset: {sd: 0.01}}",
                           "offset: {scale: 1}, gain: {scale: 1}}")),
            "3 parameters cannot be estimated from 2 data points and priors together (add priors "
            "with `sd` or data points, or estimate fewer parameters)\n");
}

TEST(TurnOf, IsTheAngleAboutTheAxis) {
  for (const double angle_rad : {-3.0, -0.2, 1e-9, 0.5, 3.1}) {
    const Vec3 turn =
        identify::TurnOf({std::cos(0.5 * angle_rad), 0, std::sin(0.5 * angle_rad), 0});
    EXPECT_NEAR(turn.y, angle_rad, 1e-12);
    EXPECT_EQ(turn.x, 0);
  }
}

}  // namespace
}  // namespace taut
