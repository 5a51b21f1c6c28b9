// Transitions between gaits, and gaits that drive rest lengths
#include <gtest/gtest.h>

#include <cmath>

#include "plant/loop.h"
#include "taut/run.h"
#include "tests/constants.h"
#include "tests/unit/plant/fake_plant.h"

namespace taut::test {
namespace {

RobotSpec ChangingSpine() {
  Diagnostics out;
  auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml", {}, out);
  EXPECT_TRUE(robot) << out.Format();
  return robot.value_or(RobotSpec{});
}

/// An oscillator per cable of the spine, uncoupled
GaitSpec Cpg(double frequency_hz, double amplitude) {
  Diagnostics out;
  GaitSpec gait = NewCpgGait(ChangingSpine(), CpgSymmetry::kSegments, out).value_or(GaitSpec{});
  gait.cpg->frequency_hz = frequency_hz;
  gait.cpg->amplitude = amplitude;
  return gait;
}

GaitSpec SineOf(double frequency_hz, double amplitude) {
  Diagnostics out;
  GaitSpec gait;
  gait.name = "s";
  SineWave wave;
  wave.name = "w";
  const RobotSpec robot = ChangingSpine();
  const auto resolved = ResolveGait(Cpg(1, 1), robot, out);
  for (const int cable : resolved.value_or(ResolvedGait{}).cables) {
    wave.cables.push_back({robot.def.cables[static_cast<std::size_t>(cable)].name});
  }
  wave.amplitude = amplitude;
  gait.sine = SineGait{frequency_hz, {wave}};
  return gait;
}

/// V0 that an impedance controller of a cable gets from an input, at its ticks
struct Played {
  explicit Played(const GaitInputSpec& input, double duration_s,
                  const Extensions& extensions = {}) {
    ExperimentSpec experiment;
    experiment.robot = ChangingSpine();
    experiment.step_s = input.clock.period_s;
    experiment.duration_s = duration_s;
    ControllerSpec controller;
    controller.name = "c";
    controller.clock.period_s = input.clock.period_s;
    controller.impedance.emplace();
    Diagnostics out;
    cable = ResolveGait(input.gait, experiment.robot, out)->cables[0];
    controller.impedance->cables.push_back({cable, 10.0, 0.2, 0.0, 100.0, 0.0});
    controller.velocity_input = input;
    experiment.controllers = {controller};
    FakePlant plant(experiment.robot.def.cables.size());
    plant.Show({0.15, 0.2, 0.0, 10.0, 10.0, 229.16});
    plant::Loop loop(experiment, plant, extensions);
    while (loop.time_s() < duration_s - 1e-9) {
      time_s.push_back(loop.time_s());
      loop.Step();
      said.push_back(plant.commands().velocity_input_m_per_s[cable]);
    }
  }

  /// Returns the largest second difference divided by the squared period: the jerk of the cable's
  /// motion, because the signal is its velocity.
  double Jerk(double from_s, double to_s) const {
    double most = 0;
    for (std::size_t i = 1; i + 1 < said.size(); ++i) {
      if (time_s[i] < from_s || time_s[i] > to_s) continue;
      const double h = time_s[1] - time_s[0];
      most = std::max(most, std::fabs(said[i + 1] - 2 * said[i] + said[i - 1]) / (h * h));
    }
    return most;
  }

  int cable = 0;
  std::vector<double> time_s, said;
};

GaitInputSpec Input(const GaitSpec& first, const GaitSpec& second, double at_s, double period_s) {
  GaitInputSpec input;
  input.clock = {period_s, 0.0};
  input.gait = first;
  input.others = {second};
  input.changes = {{at_s, 1}};
  return input;
}

// The paper's reason for oscillators: after a change of R by dR the amplitude's acceleration jumps
// by a^2 dR / 4, and after a change of v theta' jumps: V0'' = r'' - r theta'^2 in size.
TEST(GaitChange, OscillatorsPassSmoothlyFromOneGaitToTheNext) {
  const double a = 20.0, amplitude = 0.1, hz = 1.5;
  double before = 0;
  for (const double period_s : {0.004, 0.002, 0.001}) {
    const Played played(Input(Cpg(1.0, 0.05), Cpg(hz, amplitude), 2.013, period_s), 5.0);
    // r'' <= a^2 dR / 4 at first; the waves themselves r (2 pi f)^2; both cross terms are smaller.
    const double bound = 1.5 * (a * a * 0.05 / 4 + amplitude * std::pow(kTwoPi * hz, 2));
    EXPECT_LT(played.Jerk(1.0, 5.0), bound);
    // At the end the new gait is reached.
    double most = 0;
    for (std::size_t i = played.said.size() - 1; played.time_s[i] > 4.0; --i) {
      most = std::max(most, played.said[i]);
    }
    EXPECT_NEAR(most, amplitude, 1e-4);
    const double jerk = played.Jerk(1.9, 2.5);
    if (before > 0) {
      EXPECT_LT(jerk, 1.5 * before) << "grows with the rate: a jump";
    }
    before = jerk;
  }
}

TEST(GaitChange, WithoutABlendAWaveJumpsAndWithOneItDoesNot) {
  double before = 0;
  for (const double period_s : {0.004, 0.002, 0.001}) {
    GaitInputSpec input = Input(SineOf(1.0, 0.05), SineOf(1.5, 0.1), 2.013, period_s);
    input.blend_s = 0;
    const double jump = Played(input, 4.0).Jerk(1.9, 2.7);
    input.blend_s = 0.5;
    const Played blended(input, 4.0);
    // Weights change by at most 1.875 / blend and 5.77 / blend^2; both waves together by 0.15.
    const double w = kTwoPi * 1.5;
    EXPECT_LT(blended.Jerk(1.0, 4.0), 0.15 * (w * w + 2 * w * 1.875 / 0.5 + 5.78 / 0.25));
    EXPECT_GT(jump, 5 * blended.Jerk(1.9, 2.7));
    if (before > 0) {
      EXPECT_GT(jump, 1.5 * before);
    }
    before = jump;
    // The phase follows the run's time, as if the gait had always been active.
    const std::size_t last = blended.said.size() - 1;
    EXPECT_NEAR(blended.said[last], 0.1 * std::cos(kTwoPi * 1.5 * blended.time_s[last]), 1e-9);
  }
}

TEST(GaitChange, GoesBackToTheFirstAndWaitsForABlendToEnd) {
  GaitInputSpec input = Input(SineOf(1.0, 0.05), SineOf(1.0, 0.1), 1.0, 0.01);
  input.changes = {{1.0, 1}, {1.2, 0}};  // during the blend of half a second
  const Played played(input, 4.0);
  const auto at = [&](double time_s) {
    return played.said[static_cast<std::size_t>(time_s / 0.01 + 0.5)];
  };
  EXPECT_NEAR(at(0.9), 0.05 * std::cos(kTwoPi * 0.9), 1e-12);
  EXPECT_NEAR(at(1.5), 0.1 * std::cos(kTwoPi * 1.5), 1e-12);  // complete for a moment
  EXPECT_NEAR(at(3.0), 0.05 * std::cos(kTwoPi * 3.0), 1e-12);
}

TEST(GaitChange, ATableBeginsAtItsFirstRow) {
  GaitSpec table;
  table.name = "t";
  table.table.emplace();
  Diagnostics out;
  const RobotSpec robot = ChangingSpine();
  const auto resolved = ResolveGait(Cpg(1, 1), robot, out);
  for (const int cable : resolved.value_or(ResolvedGait{}).cables) {
    table.table->cables.push_back(robot.def.cables[static_cast<std::size_t>(cable)].name);
  }
  const std::size_t count = table.table->cables.size();
  table.table->time_s = {0.0, 1.0};
  table.table->rows = {std::vector<double>(count, 0.0), std::vector<double>(count, 0.1)};
  table.table->linear = true;
  GaitInputSpec input = Input(SineOf(1.0, 0.05), table, 1.0, 0.01);
  input.blend_s = 0.1;
  const Played played(input, 2.0);
  EXPECT_NEAR(played.said[150], 0.05, 1e-12);  // half a second of it
}

TEST(GaitChange, AControllerChooses) {
  struct Chooser final : Controller {
    ClockSpec clock() const override { return {0.5, 0.0}; }
    void Act(const Tick&, const Observation& seen, Commands& commands) override {
      commands.gait[0] = *seen.time_s >= 1.0 ? 1 : -1;
    }
  };
  GaitInputSpec input = Input(Cpg(1.0, 0.05), Cpg(1.0, 0.1), 1e9, 0.01);
  Extensions extensions;
  extensions.controllers = {[](const ControlSetup&) { return std::make_unique<Chooser>(); }};
  const Played chosen(input, 4.0, extensions), left(input, 4.0);
  EXPECT_NEAR(left.said[300], 0.05, 1e-6);
  EXPECT_NEAR(chosen.said[300], 0.1, 1e-6);
}

TEST(RestLengthGait, IsAddedToTheProgramOrToTheStart) {
  ExperimentSpec experiment;
  experiment.robot = ChangingSpine();
  experiment.step_s = 0.001;
  experiment.duration_s = 1.0;
  GaitSpec gait = SineOf(0.5, 0.01);
  gait.drives = GaitDrives::kRestLength;
  ControllerSpec controller;
  controller.name = "c";
  controller.rest_length_input.emplace();
  controller.rest_length_input->gait = gait;
  Diagnostics out;
  const std::vector<int> cables = ResolveGait(gait, experiment.robot, out)->cables;
  controller.position.push_back({cables[1], {{0.0, 0.2}, {1.0, 0.3}}});
  experiment.controllers = {controller};
  FakePlant plant(experiment.robot.def.cables.size());
  for (std::size_t c = 0; c < experiment.robot.def.cables.size(); ++c) {
    plant.commands().rest_length_m[c] = 0.15;
  }
  plant::Loop loop(experiment, plant);
  while (loop.time_s() < 0.7505) loop.Step();
  const double wave_m = 0.01 * std::cos(kTwoPi * 0.5 * 0.75);
  EXPECT_NEAR(plant.commands().rest_length_m[cables[0]], 0.15 + wave_m, 1e-12);
  EXPECT_NEAR(plant.commands().rest_length_m[cables[1]], 0.275 + wave_m, 1e-12);
  for (std::size_t c = 0; c < experiment.robot.def.cables.size(); ++c) {
    if (std::count(cables.begin(), cables.end(), static_cast<int>(c)) == 0) {
      EXPECT_EQ(plant.commands().rest_length_m[c], 0.15);
    }
  }
}

}  // namespace
}  // namespace taut::test
