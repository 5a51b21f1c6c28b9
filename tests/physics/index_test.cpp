/// Index checks of WorldBatch: an index out of range ends the program with a message that names it,
/// and never writes elsewhere.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {
namespace {

/// Returns two worlds, each with one body and one cable.
WorldBatch TwoWorlds() {
  WorldBatchOptions options;
  options.worlds = 2;
  options.simd = Simd::kScalar;
  return MakeBatch(scenes::HangingMass{}.Def(), options);
}

TEST(IndexDeathTest, ACableThatTheModelLacksIsNamedAndNothingElseIsWritten) {
  WorldBatch batch = TwoWorlds();
  ASSERT_EQ(batch.model().def().cables.size(), 1u);
  // In memory, the damping of cable 0 follows the stiffness of cable 0.
  EXPECT_DEATH(batch.SetParameter(0, Parameter::kCableStiffness, 1, 7.0),
               "taut: SetParameter: there is no cable 1: valid are 0 to 0");
  EXPECT_DEATH(batch.Cable(0, -1), "taut: Cable: there is no cable -1: valid are 0 to 0");
}

TEST(IndexDeathTest, AKindOfWhichTheModelHasNoneIsSaidToBeEmpty) {
  ModelDef def = scenes::HangingMass{}.Def();
  def.cables.clear();
  WorldBatch batch = MakeBatch(def);
  EXPECT_DEATH(batch.Cable(0, 0), "taut: Cable: there is no cable 0: the model has none");
}

TEST(IndexDeathTest, TargetsForAllCablesOfAllWorldsAreAsMany) {
  WorldBatch batch = TwoWorlds();
  const std::vector<double> targets(3, 1.0);
  EXPECT_DEATH(batch.Step(0.001, 1, {targets.data(), 1}),
               "taut: Step: needs one target for each cable of each world: expected 2, "
               "got 1");
  EXPECT_DEATH(batch.Step(0.001, 1, targets), "expected 2, got 3");
}

TEST(IndexDeathTest, StepsArePositiveAndASecondAtMost) {
  WorldBatch batch = TwoWorlds();
  const std::vector<std::uint8_t> mask(2, 1);
  for (const double step_s : {0.0, -1e-3, 1.001, 1e308, double{NAN}, HUGE_VAL}) {
    EXPECT_DEATH(batch.Step(step_s), "taut: Step: the step is .* s: valid are steps above 0");
    EXPECT_DEATH(batch.StepMasked(step_s, mask), "taut: StepMasked: the step is .* s");
  }
  EXPECT_DEATH(batch.Step(1e-3, -1), "taut: Step: there are -1 steps: valid are 0 or more");
  batch.Step(1.0, 0);
  batch.Step(1e-9);
}

TEST(IndexDeathTest, EveryFunctionLooksAtEveryIndex) {
  WorldBatch batch = TwoWorlds();
  const auto count = [&](const auto& all) { return static_cast<int>(all.size()); };
  const ModelDef& def = batch.model().def();
  const int bodies = count(def.bodies), cables = count(def.cables), nodes = count(def.nodes);
  const std::vector<std::uint8_t> snapshot = batch.Save(0);
  struct Call {
    std::string function;
    std::function<void(WorldBatch&, int world, int index)> call;
    int indices = 0;  ///< Number of valid values of `index`; 0: unused.
  };
  const std::vector<Call> calls = {
      {"Time", [](WorldBatch& b, int w, int) { b.Time(w); }},
      {"SetRestLengthTarget", [](WorldBatch& b, int w, int i) { b.SetRestLengthTarget(w, i, 1); },
       cables},
      {"RestLengthTarget", [](WorldBatch& b, int w, int i) { b.RestLengthTarget(w, i); }, cables},
      {"SetNodeForce", [](WorldBatch& b, int w, int i) { b.SetNodeForce(w, i, {}); }, nodes},
      {"Cable", [](WorldBatch& b, int w, int i) { b.Cable(w, i); }, cables},
      {"Cables", [](WorldBatch& b, int w, int) { b.Cables(w); }},  // scalar: a group is a world
      {"Body", [](WorldBatch& b, int w, int i) { b.Body(w, i); }, bodies},
      {"NodePosition", [](WorldBatch& b, int w, int i) { b.NodePosition(w, i); }, nodes},
      {"NodeVelocity", [](WorldBatch& b, int w, int i) { b.NodeVelocity(w, i); }, nodes},
      {"TotalEnergy", [](WorldBatch& b, int w, int) { b.TotalEnergy(w); }},
      {"Momentum", [](WorldBatch& b, int w, int) { b.Momentum(w); }},
      {"AngularMomentum", [](WorldBatch& b, int w, int) { b.AngularMomentum(w); }},
      {"Contacts", [](WorldBatch& b, int w, int) { b.Contacts(w); }},
      {"SetBodyState", [](WorldBatch& b, int w, int i) { b.SetBodyState(w, i, {}); }, bodies},
      {"SetTime", [](WorldBatch& b, int w, int) { b.SetTime(w, 0); }},
      {"SetRestLength", [](WorldBatch& b, int w, int i) { b.SetRestLength(w, i, 1); }, cables},
      {"Save", [](WorldBatch& b, int w, int) { b.Save(w); }},
      {"Restore", [&](WorldBatch& b, int w, int) { b.Restore(w, snapshot); }},
      {"Hash", [](WorldBatch& b, int w, int) { b.Hash(w); }},
      {"Status", [](WorldBatch& b, int w, int) { b.Status(w); }},
      {"ClearStatus", [](WorldBatch& b, int w, int) { b.ClearStatus(w); }},
  };
  const auto dies = [&](const Call& each, int world, int index) {
    EXPECT_DEATH(each.call(batch, world, index), "taut: " + each.function + ": there is no ")
        << each.function << ' ' << world << ' ' << index;
  };
  for (const Call& each : calls) {
    each.call(batch, 1, 0);  // the last world is valid
    dies(each, 2, 0);
    dies(each, -1, 0);
    if (each.indices == 0) continue;
    each.call(batch, 0, each.indices - 1);
    dies(each, 0, each.indices);
    dies(each, 0, -1);
  }
}

TEST(IndexDeathTest, AParameterHasAsManyIndicesAsTheModelHasOfItsKind) {
  WorldBatch batch = TwoWorlds();
  const ModelDef& def = batch.model().def();
  const auto bodies = static_cast<int>(def.bodies.size());
  const std::vector<std::pair<Parameter, int>> limits = {
      {Parameter::kBodyMass, bodies}, {Parameter::kCableStiffness, 1},
      {Parameter::kCableDamping, 1},  {Parameter::kFrictionScale, 1},
      {Parameter::kGravityX, 1},      {Parameter::kGravityY, 1},
      {Parameter::kGravityZ, 1},
  };
  for (const auto& [parameter, limit] : limits) {
    const double now = batch.GetParameter(0, parameter, limit - 1);
    batch.SetParameter(0, parameter, limit - 1, now);
    EXPECT_DEATH(batch.GetParameter(0, parameter, limit), "taut: GetParameter: there is no ");
    EXPECT_DEATH(batch.SetParameter(0, parameter, limit, now), "taut: SetParameter: there is no ");
    EXPECT_DEATH(batch.GetParameter(2, parameter, 0), "taut: GetParameter: there is no world 2");
  }
}

}  // namespace
}  // namespace taut::test
