// Simulation: its worlds have the bits of runs and rollouts, however they are stepped, reset and
// recorded
#include "taut/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "taut/find.h"
#include "taut/rollout.h"
#include "taut/run.h"
#include "tests/instruction_sets.h"
#include "tests/unit/plant/simulation_fixture.h"

namespace taut::test {
namespace {

std::uint64_t HashOfRun(const ExperimentSpec& experiment) {
  Diagnostics out;
  const auto summary = RunExperiment(experiment, {}, out);
  EXPECT_TRUE(summary) << out.Format();
  return summary ? summary->state_hash : 0;
}

TEST(Simulation, HasTheBitsOfTheRun) {
  // controllers, pushes, gaits, a goal, sensors, a settled start
  for (const char* name : {"push_20n", "push_20n_motors", "cpg_learned", "goal_flat", "drag"}) {
    const ExperimentSpec experiment = Load(name, 0.8);
    const auto simulation = Create(experiment);
    simulation->RunUntil(0.8);
    EXPECT_EQ(simulation->Hash(), HashOfRun(experiment)) << name;
  }
}

TEST(Simulation, StepsAndTimesOfAProgramAreChecked) {
  const ExperimentSpec good = Load("push_20n", 0.1);
  for (const auto& [step_s, duration_s, what] :
       {std::tuple(1e308, 0.1, "step_s must be within 1e-09..1 s, got 1e+308"),
        std::tuple(double{NAN}, 0.1, "step_s must be within 1e-09..1 s, got nan"),
        std::tuple(0.0, 0.1, "step_s must be within 1e-09..1 s, got 0"),
        std::tuple(1e-3, 1e300, "duration_s must be within 0..1e+09 s, got 1e+300"),
        std::tuple(1e-3, double{NAN}, "duration_s must be within 0..1e+09 s, got nan")}) {
    ExperimentSpec wrong = good;
    wrong.step_s = step_s;
    wrong.duration_s = duration_s;
    Diagnostics of_run, of_simulation;
    EXPECT_FALSE(RunExperiment(wrong, {}, of_run));
    EXPECT_FALSE(Simulation::Create(wrong, {}, of_simulation));
    EXPECT_NE(of_run.Format().find(what), std::string::npos) << of_run.Format();
    EXPECT_NE(of_simulation.Format().find(what), std::string::npos) << of_simulation.Format();
  }
  const auto simulation = Create(good);
  for (const double time_s : {0x1p63, HUGE_VAL, double{NAN}}) {
    EXPECT_DEATH(simulation->RunUntil(time_s), "taut: RunUntil: the time is .* s: valid are times");
  }
}

TEST(Simulation, WorldsHaveTheBitsOfRolloutsOnAnyThreadsAndInstructionSet) {
  const ExperimentSpec experiment = Load("cpg_learned", 0.3);
  const auto variants = Variants(experiment, 11);
  Diagnostics out;
  const auto results = Rollouts::Create(experiment, {}, {}, out)->Run(variants);
  for (const auto& [name, simd] : kInstructionSets) {
    for (const int threads : {1, 3}) {
      const auto simulation =
          Create(experiment, {.variants = variants, .threads = threads, .simd = simd});
      EXPECT_EQ(simulation->worlds(), 11);
      simulation->RunUntil(0.3);
      for (int w = 0; w < 11; ++w) {
        EXPECT_EQ(simulation->Hash(w), results[static_cast<std::size_t>(w)].state_hash)
            << name << " " << threads << " threads, world " << w;
      }
    }
  }
}

TEST(Simulation, StepsAndStopsInBetweenChangeNothing) {
  const ExperimentSpec experiment = Load("push_20n", 0.5);
  const auto whole = Create(experiment, {.worlds = 3}), parts = Create(experiment, {.worlds = 3});
  whole->RunUntil(0.5);
  for (const double until_s : {0.0, 0.0103, 0.1, 0.4997}) parts->RunUntil(until_s);
  while (parts->Time() < 0.5 - 1e-9) parts->Step();
  for (int w = 0; w < 3; ++w) EXPECT_EQ(parts->Hash(w), whole->Hash(w));
  EXPECT_NEAR(parts->Time(2), 0.5, 1e-12);
}

TEST(Simulation, AWorldThatIsResetCatchesUpWhileTheOthersWait) {
  const ExperimentSpec experiment = Load("push_20n", 0.4);
  const auto variants = Variants(experiment, 5);
  const auto plain = Create(experiment, {.variants = variants});
  const auto simulation = Create(experiment, {.variants = variants});
  plain->RunUntil(0.4);
  simulation->RunUntil(0.15);
  simulation->Reset(3);
  EXPECT_EQ(simulation->Time(3), 0);
  simulation->RunUntil(0.1);  // the others are past this time
  EXPECT_NEAR(simulation->Time(3), 0.1, 1e-12);
  EXPECT_NEAR(simulation->Time(2), 0.15, 1e-12);
  simulation->RunUntil(0.4);
  for (int w = 0; w < 5; ++w) EXPECT_EQ(simulation->Hash(w), plain->Hash(w)) << w;
}

TEST(Simulation, AllWorldsAreResetInGroupsOfAnySize) {
  const ExperimentSpec experiment = Load("push_20n", 0.4);
  for (const int count : {1, 2, 3, 5, 8, 9}) {
    const auto variants = Variants(experiment, count);
    const auto simulation = Create(experiment, {.variants = variants});
    simulation->RunUntil(0.02);
    std::vector<std::uint64_t> ends;
    for (int w = 0; w < count; ++w) ends.push_back(simulation->Hash(w));
    for (int w = 0; w < count; ++w) simulation->Reset(w);
    simulation->RunUntil(0.02);
    for (int w = 0; w < count; ++w) {
      EXPECT_EQ(simulation->Hash(w), ends[static_cast<std::size_t>(w)])
          << count << " worlds, " << w;
    }
  }
}

TEST(Simulation, AWorldBecomesAnotherVariant) {
  const ExperimentSpec experiment = Load("push_20n", 0.3);
  const auto variants = Variants(experiment, 4);
  const auto plain = Create(experiment, {.variants = variants});
  plain->RunUntil(0.3);
  const auto simulation = Create(experiment, {.variants = std::span(variants).first(2)});
  simulation->RunUntil(0.2);
  Diagnostics out;
  ASSERT_TRUE(simulation->Reset(variants[3], out, 1)) << out.Format();
  simulation->RunUntil(0.3);
  EXPECT_EQ(simulation->Hash(1), plain->Hash(3));
  EXPECT_EQ(simulation->Hash(0), plain->Hash(0));
}

TEST(Simulation, EndsBetweenTwoStepsOnRequest) {
  const auto simulation = Create(Load("push_20n", 1));
  int steps = 0;
  simulation->RunUntil(1, [&] { return ++steps <= 7; });
  EXPECT_NEAR(simulation->Time(), 0.007, 1e-12);
}

TEST(Simulation, CommandsOfAProgramReplacePositionPrograms) {
  const ExperimentSpec experiment = Load("rest_length_sine", 1);
  const auto simulation = Create(experiment, {.worlds = 2});
  simulation->RunUntil(0.1);
  int cable = 0;
  for (const ControllerSpec& controller : experiment.controllers) {
    if (!controller.position.empty()) cable = controller.position[0].cable;
  }
  const double command_m = simulation->RestLengthCommand(cable, 1) * 0.97;
  simulation->SetRestLength(cable, command_m, 1);
  simulation->RunUntil(0.3);
  EXPECT_NE(simulation->Hash(0), simulation->Hash(1));
  EXPECT_NE(simulation->RestLengthCommand(cable, 0), command_m);
}

TEST(Simulation, AForceOnANodeActsUntilItIsChanged) {
  const ExperimentSpec experiment = Load("stand_still", 1);
  const auto simulation = Create(experiment, {.worlds = 2});
  simulation->SetNodeForce(0, {0, 0, 5}, 1);
  simulation->RunUntil(0.1);
  ASSERT_EQ(simulation->ExternalForces(1).size(), 1u);
  EXPECT_EQ(simulation->ExternalForces(1)[0].force_n.z, 5);
  EXPECT_TRUE(simulation->ExternalForces(0).empty());
  EXPECT_GT(simulation->NodePosition(0, 1).z, simulation->NodePosition(0, 0).z);
  simulation->SetNodeForce(0, {}, 1);
  simulation->Step();
  EXPECT_EQ(simulation->batch().NodeForce(1, 0).z, 0);
}

TEST(Simulation, ElementsAreFoundByNameAndByIndex) {
  const ExperimentSpec experiment = Load("push_20n", 1);
  const auto simulation = Create(experiment);
  simulation->RunUntil(1);
  const auto cable = FindCable(simulation->def(), "outer_right_1");
  ASSERT_TRUE(cable);
  EXPECT_EQ(simulation->Cable("outer_right_1").tension_n, simulation->Cable(*cable).tension_n);
  EXPECT_EQ(simulation->Cable(std::string("outer_right_1")).tension_n,
            simulation->Cable(*cable, 0).tension_n);
  // The value that a batch without controllers does not reach (3.0 N)
  EXPECT_NEAR(simulation->Cable("outer_right_1").tension_n, 6.87, 0.01);
  Diagnostics out;
  EXPECT_FALSE(FindCable(simulation->def(), "outer_rihgt_1", &out));
  EXPECT_EQ(out.Format(),
            "error: there is no cable \"outer_rihgt_1\" (did you mean \"outer_right_1\"?)\n");
  Diagnostics none;
  EXPECT_FALSE(FindJoint(simulation->def(), "knee", &none));
  EXPECT_EQ(none.Format(), "error: there is no joint \"knee\" (the model has no joint)\n");
}

TEST(Simulation, ABatchOfAnExperimentWarnsOfWhatItLeavesOut) {
  const ExperimentSpec experiment = Load("push_20n", 1);
  Diagnostics out;
  EXPECT_TRUE(Model::Compile(experiment.robot.def, out));
  EXPECT_TRUE(out.ok());
  EXPECT_EQ(
      out.Format(),
      "warning: the experiment has controllers, pushes, which a batch ignores (to run them, use "
      "Simulation; to suppress this warning, clear ModelDef::experiment_parts or, in Python, pass "
      "experiment.robot)\n");
  ExperimentSpec bare = experiment;
  bare.controllers.clear();
  EXPECT_EQ(ActingParts(bare), "pushes");
  Diagnostics quiet;
  EXPECT_TRUE(Simulation::Create(experiment, {}, quiet));
  EXPECT_EQ(quiet.Format(), "");
}

TEST(SimulationDeath, AWrongNameNamesTheClosest) {
  const auto simulation = Create(Load("push_20n", 1));
  EXPECT_DEATH(simulation->Cable("outer_rihgt_1"),
               "taut: Cable: error: there is no cable \"outer_rihgt_1\" .did you mean "
               "\"outer_right_1\"");
  EXPECT_DEATH(simulation->Body(99), "taut: Body: there is no body 99");
  EXPECT_DEATH(simulation->Hash(1), "taut: Hash: there is no world 1: valid are 0 to 0");
  EXPECT_DEATH(simulation->Body(std::int64_t{1} << 32), "taut: Body: there is no body");
  ControllerSpec position;
  position.position.push_back({99, {{0.0, 0.2}}});
  Extensions of_another;
  of_another.controllers = ControllersOf(position);
  EXPECT_DEATH(Create(Load("push_20n", 1), {.extensions = of_another}),
               "taut: ControllersOf: there is no cable 99");
}

/// Keeps rows in memory
class Rows final : public TraceWriter {
 public:
  explicit Rows(std::size_t channels) : channels_(channels) {}
  bool Append(double time_s, const double* values) override {
    rows.emplace_back(time_s, std::vector<double>(values, values + channels_));
    return true;
  }
  bool FlushOld() override { return true; }
  bool Finish() override { return true; }
  const std::string& error() const override { return error_; }

  std::vector<std::pair<double, std::vector<double>>> rows;

 private:
  std::size_t channels_;
  std::string error_;
};

TEST(Simulation, RecordsTheRowsOfTheRun) {
  const ExperimentSpec experiment = Load("push_20n", 0.3);
  const auto channels = RunChannels(experiment);
  Rows of_run(channels.size()), of_world(channels.size());
  Diagnostics out;
  RunOptions options;
  options.traces = {&of_run};
  ASSERT_TRUE(RunExperiment(experiment, options, out)) << out.Format();
  const auto simulation = Create(experiment, {.worlds = 5});
  simulation->Record(&of_world, 4);
  simulation->RunUntil(0.3);
  EXPECT_EQ(of_world.rows, of_run.rows);
  // After the end, rows continue at the same rate; without a writer there are none.
  const std::size_t at_end = of_world.rows.size();
  simulation->RunUntil(0.3 + 5 / experiment.record.rate_hz);
  EXPECT_EQ(of_world.rows.size(), at_end + 5);
  simulation->Record(nullptr, 4);
  simulation->RunUntil(0.5);
  EXPECT_EQ(of_world.rows.size(), at_end + 5);
}

TEST(Simulation, EachStartThatDoesNotExistIsAnError) {
  const ExperimentSpec experiment = Load("push_20n", 1);
  auto variants = Variants(experiment, 3);
  variants[1].start_noise.position_m = 1e9;  // no longer finite after the first step
  variants[1].scales.push_back({ScaleSpec::Quantity::kMass, {}, 1e-300});
  Diagnostics out;
  SimulationOptions none;
  none.worlds = 0;
  EXPECT_FALSE(Simulation::Create(experiment, none, out));
  EXPECT_EQ(out.Format(), "error: `worlds` must be at least 1, got 0\n");
  int polled = 0;
  Diagnostics stopped;
  ExperimentSpec settled = experiment;
  settled.start = StartKind::kSettled;
  EXPECT_FALSE(Simulation::Create(settled, {.keep_going = [&] { return ++polled < 10; }}, stopped));
  EXPECT_EQ(polled, 10);
}

TEST(Simulation, AModelFileNeedsNoExperiment) {
  Diagnostics out;
  const auto simulation = Simulation::Load(
      std::string(TAUT_SOURCE_DIR) + "/share/models/six_strut.yaml", {}, {.worlds = 2}, out);
  ASSERT_TRUE(simulation) << out.Format();
  simulation->RunUntil(0.1);
  EXPECT_EQ(simulation->Hash(0), simulation->Hash(1));
  EXPECT_EQ(simulation->StatusText(), "");
  EXPECT_FALSE(Simulation::Load("/nowhere.yaml", {}, {}, out));
}

}  // namespace
}  // namespace taut::test
