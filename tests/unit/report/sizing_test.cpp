// Demands of a run on motors and springs (taut/sizing.h), against closed forms; and errors of
// catalogs
#include "taut/sizing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>

namespace taut::test {
namespace {

/// One cable under T0 + B cos(w t), wound in by A sin(w t), for `cycles` periods of a second
struct SineLoad {
  double base_n = 20, swing_n = 8, wound_m = 0.05, w = 2 * std::numbers::pi;
  int cycles = 3, rows = 30001;

  ExperimentSpec Experiment() const {
    ExperimentSpec experiment;
    experiment.name = "sine";
    CableDef cable;
    cable.name = "pull";
    cable.stiffness_n_per_m = 400;
    cable.actuator.kind = ActuatorDef::Kind::kIdeal;
    experiment.robot.def.cables.push_back(cable);
    return experiment;
  }
  Trace Rows() const {
    Trace trace;
    trace.channels = {{"cable/pull/tension_n", "N"},
                      {"cable/pull/elastic_n", "N"},
                      {"cable/pull/rest_length_m", "m"}};
    trace.values.resize(3);
    for (int i = 0; i < rows; ++i) {
      const double t = cycles * static_cast<double>(i) / (rows - 1);
      trace.time_s.push_back(t);
      trace.values[0].push_back(base_n + swing_n * std::cos(w * t));
      trace.values[1].push_back(base_n - 2 + swing_n * std::cos(w * t));
      trace.values[2].push_back(1 - wound_m * std::sin(w * t));
    }
    return trace;
  }
};

TEST(Sizing, ASineHasTheDemandsOfItsClosedForm) {
  const SineLoad sine;
  Diagnostics out;
  const auto run = DemandOf(sine.Rows(), sine.Experiment(), "trace.h5", out);
  ASSERT_TRUE(run) << out.Format();
  const CableDemand& d = run->cables.at(0);
  const double a = sine.wound_m, t0 = sine.base_n, b = sine.swing_n, w = sine.w;
  // Linear interpolation between rows: relative error of about (w h)^2.
  const double off = 1e-6;
  EXPECT_NEAR(d.peak_force_n, t0 + b, 1e-12);
  EXPECT_NEAR(d.rms_force_n, std::sqrt(t0 * t0 + b * b / 2), t0 * off);
  EXPECT_NEAR(d.peak_speed_m_per_s, a * w, a * w * off);
  EXPECT_NEAR(d.rms_speed_m_per_s, a * w / std::sqrt(2), a * w * off);
  EXPECT_NEAR(d.peak_power_w, (t0 + b) * a * w, 20 * off);
  // Mean of (T0 + B cos)^2 cos^2 over a period
  EXPECT_NEAR(d.rms_power_w, a * w * std::sqrt(t0 * t0 / 2 + 3 * b * b / 8), 20 * off);
  EXPECT_NEAR(d.gross_energy_j, sine.cycles * a * (2 * t0 + b * std::numbers::pi / 2), 1e-4);
  EXPECT_NEAR(d.net_energy_j, sine.cycles * std::numbers::pi * a * b, 1e-5);
  EXPECT_NEAR(d.wound_m, 2 * a, 1e-12);
  EXPECT_NEAR(d.stretch_m, (t0 + b - 2) / 400, 1e-12);
  EXPECT_TRUE(d.actuated);
  EXPECT_FALSE(run->every_step);
}

/// Distant rows: force and rest length are linear in between, and means are means of the lines.
TEST(Sizing, BetweenRowsAllGoesStraight) {
  Trace trace = SineLoad{}.Rows();
  trace.time_s = {0, 2};
  trace.values = {{0, 6}, {0, 6}, {1, 0.5}};
  Diagnostics out;
  const auto run = DemandOf(trace, SineLoad{}.Experiment(), "trace.h5", out);
  ASSERT_TRUE(run) << out.Format();
  const CableDemand& d = run->cables.at(0);
  EXPECT_NEAR(d.rms_force_n, std::sqrt(12.0), 1e-12);  // mean of (6 s)^2 for s from 0 to 1
  EXPECT_NEAR(d.rms_power_w, 0.25 * std::sqrt(12.0), 1e-12);
  EXPECT_NEAR(d.net_energy_j, 0.5 * 3, 1e-12);
}

TEST(Sizing, AMotorsFactorsAreWhatItHasOverWhatIsNeeded) {
  CatalogueMotor motor;
  motor.gear_ratio = 10, motor.gear_efficiency = 0.5;
  motor.rated_torque_n_m = 0.04, motor.peak_torque_n_m = 0.12, motor.max_speed_rad_per_s = 500;
  motor.peak_power_w = 20;
  CableDemand cable;
  cable.peak_force_n = 30, cable.rms_force_n = 10;
  cable.peak_speed_m_per_s = 0.5, cable.peak_power_w = 8, cable.wound_m = 0.2 * std::numbers::pi;
  // Spool of 1 cm: 30 N are 0.3 N m behind the gear, 0.06 before it; 0.5 m/s are 500 rad/s.
  const SizingMargins fit = SizingMarginsOf(motor, 0.01, 1.0, cable);
  ASSERT_EQ(fit.margins.size(), 4u);
  EXPECT_NEAR(fit.margins[0].factor, 2, 1e-12);
  EXPECT_NEAR(fit.margins[1].factor, 2, 1e-12);
  EXPECT_NEAR(fit.margins[2].factor, 1, 1e-12);
  EXPECT_NEAR(fit.margins[3].factor, 20 / (8 / 0.5), 1e-12);
  EXPECT_EQ(fit.least.of, "speed");
  EXPECT_NEAR(fit.spool_turns, 10, 1e-12);
  EXPECT_FALSE(SizingMarginsOf(motor, 0.01, 1.01, cable).fits);
  EXPECT_TRUE(SizingMarginsOf(motor, 0.0101, 1.0, cable).fits);
  EXPECT_TRUE(std::isinf(SizingMarginsOf(motor, 0.01, 1.0, {}).least.factor))
      << "nothing is needed";
}

TEST(Sizing, ASpringFitsByForceTravelAndStiffness) {
  const CatalogueSpring spring{"s", 500, 0.04, 30};
  CableDemand cable;
  cable.stiffness_n_per_m = 480, cable.peak_elastic_n = 15;
  const SizingMargins fit = SizingMarginsOf(spring, 1.0, 0.1, cable);
  EXPECT_TRUE(fit.fits);
  EXPECT_NEAR(fit.margins[0].factor, 2, 1e-12);
  EXPECT_NEAR(fit.margins[1].factor, 0.04 * 500 / 15, 1e-12);
  EXPECT_EQ(fit.least.of, "travel");
  EXPECT_NEAR(fit.stiffness_off, 500.0 / 480 - 1, 1e-12);
  EXPECT_FALSE(SizingMarginsOf(spring, 1.0, 0.04, cable).fits);
  EXPECT_FALSE(SizingMarginsOf(spring, 1.4, 0.1, cable).fits);
}

TEST(Sizing, ATraceThatLacksSomethingIsRefused) {
  const SineLoad sine;
  Trace trace = sine.Rows();
  trace.channels[0].name = "cable/other/tension_n";
  trace.values[2][5] = std::numeric_limits<double>::quiet_NaN();
  Diagnostics out;
  EXPECT_FALSE(DemandOf(trace, sine.Experiment(), "trace.h5", out));
  const std::string text = out.Format();
  EXPECT_NE(text.find("the trace has no channel \"cable/pull/tension_n\""), std::string::npos);
  EXPECT_NE(text.find("channel \"cable/pull/rest_length_m\" has values that are not finite"),
            std::string::npos);
  trace = sine.Rows();
  trace.time_s.resize(1);
  Diagnostics short_one;
  EXPECT_FALSE(DemandOf(trace, sine.Experiment(), "trace.h5", short_one));
  EXPECT_NE(short_one.Format().find("fewer than two rows"), std::string::npos);
}

std::string ErrorsOf(const std::string& text) {
  const auto path = std::filesystem::path(testing::TempDir()) / "taut_catalogue_test.yaml";
  std::ofstream(path) << text;
  Diagnostics out;
  EXPECT_FALSE(LoadCatalogue(path.string(), out));
  std::filesystem::remove(path);
  std::string errors;
  for (const Diagnostic& d : Sorted(out.items()))
    errors += std::to_string(d.at.line) + ": " + d.what + "\n";
  return errors;
}

TEST(Catalogue, EveryMistakeIsNamed) {
  EXPECT_EQ(ErrorsOf("taut: 1\nkind: catalogue\nname: c\nmotors:\n  a:\n    rated_torque_n_m: 2\n"
                     "    peak_torque_n_m: 1\n    max_speed_rad_per_s: 3\n    rated_power_w: 5\n"
                     "    peak_power_w: 4\nsprings:\n  s: {stiffness_n_per_m: -1, "
                     "largest_force_n: 2, colour: 3}\n"),
            "7: the peak torque is below the rated torque\n"
            "10: the peak power is below the rated power\n"
            "12: spring needs the key \"largest_travel_m\"\n"
            "12: spring.stiffness_n_per_m must be positive, got -1\n"
            "12: unknown key \"colour\" in spring\n");
  EXPECT_EQ(ErrorsOf("taut: 1\nkind: catalogue\nname: c\n"),
            "1: the catalogue has neither motors nor springs\n");
}

TEST(Catalogue, TheExampleIsRead) {
  Diagnostics out;
  const auto catalogue = LoadCatalogue(TAUT_SOURCE_DIR "/examples/winches.yaml", out);
  ASSERT_TRUE(catalogue) << out.Format();
  ASSERT_EQ(catalogue->motors.size(), 2u);
  EXPECT_EQ(catalogue->motors[0].name, "small");
  EXPECT_NEAR(catalogue->motors[0].max_speed_rad_per_s, 9000 * 2 * std::numbers::pi / 60, 1e-9);
  EXPECT_FALSE(catalogue->motors[0].rated_power_w);
  EXPECT_EQ(*catalogue->motors[1].rated_power_w, 20);
  EXPECT_EQ(catalogue->springs.size(), 2u);
  EXPECT_EQ(catalogue->factor, 1.5);
}

}  // namespace
}  // namespace taut::test
