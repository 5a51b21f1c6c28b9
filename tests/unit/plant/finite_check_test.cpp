// Commands and readings that are not finite are refused with their names
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "plant/loop.h"
#include "taut/rollout.h"
#include "taut/run.h"
#include "tests/unit/plant/fake_plant.h"
#include "tests/unit/plant/simulation_fixture.h"

namespace taut::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// Controller that writes a number to a row of commands, in all worlds or one, from 0.1 s on.
class Writer final : public Controller {
 public:
  using Row = double* Commands::*;
  Writer(Row row, double value, int world) : row_(row), value_(value), world_(world) {}
  ClockSpec clock() const override { return {0.01, 0}; }
  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    for (int j = 0; j < commands.lanes; ++j) {
      if (!Has(tick.due, j) || (world_ >= 0 && j != world_) || seen.time_s[j] < 0.1) continue;
      (commands.*row_)[3 * commands.lanes + j] = value_;
    }
  }
  void Serialize(plant::LaneState&) override {}

 private:
  Row row_;
  double value_;
  int world_;
};

Extensions WriterOf(Writer::Row row, double value, int world = -1) {
  Extensions extensions;
  extensions.controllers.push_back(
      [=](const ControlSetup&) { return std::make_unique<Writer>(row, value, world); });
  return extensions;
}

std::string CableName(const ExperimentSpec& experiment, std::size_t cable) {
  return experiment.robot.def.cables[cable].name;
}

TEST(FiniteCommands, OfACustomControllerEndARunWithTheNameOfTheCable) {
  const ExperimentSpec experiment = Load("push_20n", 0.5);
  const std::pair<Writer::Row, const char*> rows[] = {
      {&Commands::rest_length_m, "rest_length_m"},
      {&Commands::set_point_n, "set_point_n"},
      {&Commands::velocity_input_m_per_s, "velocity_input_m_per_s"},
      {&Commands::signal, "signal"}};
  for (const auto& [row, name] : rows) {
    for (const auto& [value, text] : {std::pair(kNan, "nan"), {kInf, "inf"}, {-kInf, "-inf"}}) {
      Diagnostics out;
      RunOptions options;
      options.extensions = WriterOf(row, value);
      const auto summary = RunExperiment(experiment, options, out);
      ASSERT_TRUE(summary);
      EXPECT_EQ(out.Format(), std::string("error: the run ended early: custom controller 0 sets ") +
                                  name + " of cable " + CableName(experiment, 3) + " to " + text +
                                  " at t = 0.100000 s, expected a finite number\n");
      EXPECT_EQ(summary->status.bits & kStatusNonFinite, 0u);
      EXPECT_LT(summary->simulated_s, 0.11);
    }
  }
}

TEST(FiniteCommands, OfAControllerStopItsWorldAloneAndKeepThePreviousValue) {
  const ExperimentSpec experiment = Load("push_20n", 0.5);
  const auto plain =
      Create(experiment, {.worlds = 3, .extensions = WriterOf(&Commands::rest_length_m, kNan, 99)});
  const auto simulation =
      Create(experiment, {.worlds = 3, .extensions = WriterOf(&Commands::rest_length_m, kNan, 1)});
  const auto first = simulation->Save(1);
  for (const auto& each : {plain.get(), simulation.get()}) each->RunUntil(0.3);
  for (int w = 0; w < 3; ++w) {
    EXPECT_EQ(simulation->Hash(w), plain->Hash(w)) << w;
    EXPECT_EQ(simulation->IsRunning(w), w != 1);
  }
  EXPECT_EQ(simulation->StatusText(1), "custom controller 0 sets rest_length_m of cable " +
                                           CableName(experiment, 3) +
                                           " to nan at t = 0.100000 s, expected a finite number");
  Diagnostics out;
  EXPECT_TRUE(simulation->Restore(first, out, 1)) << out.Format();
  EXPECT_TRUE(simulation->IsRunning(1));
  simulation->RunUntil(0.2);
  EXPECT_FALSE(simulation->IsRunning(1));
  simulation->Reset(1);
  EXPECT_TRUE(simulation->IsRunning(1));
  EXPECT_EQ(simulation->StatusText(1), "");
}

TEST(FiniteCommands, OfAControllerFailItsRollout) {
  const ExperimentSpec experiment = Load("push_20n", 0.2);
  Diagnostics out;
  RolloutOptions options;
  options.extensions = WriterOf(&Commands::set_point_n, kInf, 1);
  const auto rollouts = Rollouts::Create(experiment, {}, options, out);
  ASSERT_TRUE(rollouts) << out.Format();
  const auto results = rollouts->Run(Variants(experiment, 2));
  EXPECT_EQ(results[0].failed, "");
  EXPECT_NE(results[1].failed.find("custom controller 0 sets set_point_n of cable"),
            std::string::npos)
      << results[1].failed;
  EXPECT_TRUE(std::isnan(results[1].score));
}

TEST(FiniteCommands, OfAProgramAreRefusedWithTheirName) {
  const ExperimentSpec experiment = Load("push_20n", 0.5);
  const std::string cable = CableName(experiment, 0);
  const std::string node = experiment.robot.def.nodes[2].name;
  const std::string body = experiment.robot.def.bodies[1].name;
  const auto refuses = [&](const std::string& what, const std::function<void(Simulation&)>& set) {
    const auto plain = Create(experiment, {.worlds = 2});
    const auto simulation = Create(experiment, {.worlds = 2});
    plain->RunUntil(0.1), simulation->RunUntil(0.1);
    set(*simulation);
    plain->RunUntil(0.2), simulation->RunUntil(0.2);
    EXPECT_EQ(simulation->StatusText(1).rfind("the program sets " + what + " at t = 0.1", 0), 0u)
        << simulation->StatusText(1);
    EXPECT_FALSE(simulation->IsRunning(1));
    EXPECT_TRUE(simulation->IsRunning(0));
    for (int w = 0; w < 2; ++w) EXPECT_EQ(simulation->Hash(w), plain->Hash(w)) << what;
  };
  refuses("rest_length_m of cable " + cable + " to nan",
          [](Simulation& s) { s.SetRestLength(0, kNan, 1); });
  refuses("position_gain_n_per_m of cable " + cable + " to inf", [](Simulation& s) {
    ImpedanceGains gains = s.Gains(0, 1).value();
    gains.position_gain_n_per_m = kInf;
    EXPECT_FALSE(s.SetGains(gains, 1));
  });
  refuses("force_n of node " + node + " to -inf", [](Simulation& s) {
    s.SetNodeForce(2, {0, -kInf, 0}, 1);
  });
  refuses("force_n of node " + node + " to nan", [](Simulation& s) {
    const ExternalForce forces[] = {{1, {1, 1, 1}}, {2, {0, 0, kNan}}};
    s.SetExternalForces(forces, 1);
  });
  refuses("velocity_m_per_s of body " + body + " to nan", [](Simulation& s) {
    BodyState state = s.Body(1, 1);
    state.velocity_m_per_s.z = kNan;
    s.SetBodyState(1, state, 1);
  });
  refuses("velocity_input_m_per_s of cable " + cable + " to nan",
          [](Simulation& s) { s.commands().velocity_input_m_per_s[1] = kNan; });
}

TEST(FiniteReadings, OfAPlantEndARunWithTheNameOfTheCable) {
  const ExperimentSpec experiment = Load("push_20n", 0.5);
  FakePlant plant(experiment.robot.def.cables.size());
  plant.Show({1, 1, 0, 5, 5, kNan});
  Diagnostics out;
  RunOptions options;
  options.plant = &plant;
  const auto summary = RunExperiment(experiment, options, out);
  ASSERT_TRUE(summary);
  EXPECT_EQ(out.Format(),
            "error: the run ended early: the plant returns stiffness_n_per_m of cable " +
                CableName(experiment, 0) + " to nan at t = 0.000000 s, expected a finite number\n");
  for (std::size_t c = 0; c < experiment.robot.def.cables.size(); ++c) {
    EXPECT_TRUE(std::isfinite(plant.commands().rest_length_m[c]));
    EXPECT_TRUE(std::isfinite(plant.commands().velocity_input_m_per_s[c]));
  }
}

}  // namespace
}  // namespace taut::test
