/// Bitwise reproducibility: a world has the same bits alone, in any lane, on any number of threads
/// and with any instruction set.

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <tuple>

#include "tests/determinism/variety.h"
#include "tests/instruction_sets.h"

namespace taut::test {
namespace {

/// Returns a batch of `worlds` on this instruction set; nothing if the machine lacks it.
std::optional<WorldBatch> BatchOn(Simd simd, const ModelDef& def, int worlds, int threads) {
  WorldBatchOptions options;
  options.worlds = worlds;
  options.threads = threads;
  options.simd = simd;
  WorldBatch batch = MakeBatch(def, options);
  if (batch.lanes() != static_cast<int>(simd)) return std::nullopt;
  return batch;
}

using SetAndModel = std::tuple<InstructionSet, std::size_t>;
class LanesOf : public testing::TestWithParam<SetAndModel> {};

TEST_P(LanesOf, EqualTheirWorldsAloneOnAnyNumberOfThreads) {
  const auto [set, model] = GetParam();
  const Simd simd = set.simd;
  const ModelDef def = VariedModels()[model];
  constexpr int kWorlds = 19;
  if (!BatchOn(simd, def, 1, 1)) GTEST_SKIP() << "this machine has no " << set.name;
  std::vector<Outcome> expected;  // in scalar code
  for (int i = 0; i < kWorlds; ++i) expected.push_back(Alone(def, i));
  for (const int threads : {1, 2, 3}) {
    WorldBatch batch = *BatchOn(simd, def, kWorlds, threads);
    for (int i = 0; i < kWorlds; ++i) Scatter(batch, i, i);
    for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
      for (int i = 0; i < kWorlds; ++i) Disturb(batch, i, i, static_cast<int>(stretch));
      batch.Step(kVarietyStepS, kStepsAStretch);
      for (int i = 0; i < kWorlds; ++i) {
        ASSERT_EQ(batch.Hash(i), expected[static_cast<std::size_t>(i)].hashes[stretch])
            << "world " << i << " of " << threads << " threads, after "
            << (stretch + 1) * kStepsAStretch << " steps";
      }
    }
    for (int i = 0; i < kWorlds; ++i) {
      EXPECT_EQ(batch.Save(i), expected[static_cast<std::size_t>(i)].snapshot) << i;
      // The hash distinguishes worlds: no two are alike, none is broken.
      EXPECT_NE(batch.Hash(i), batch.Hash((i + 1) % kWorlds)) << i;
      EXPECT_EQ(batch.Status(i).bits & kStatusNonFinite, 0u) << i;
    }
  }
}

TEST_P(LanesOf, TakeTargetsAllAtOnceAsOneByOne) {
  const auto [set, model] = GetParam();
  const Simd simd = set.simd;
  const ModelDef def = VariedModels()[model];
  constexpr int kWorlds = 19;
  if (!BatchOn(simd, def, 1, 1)) GTEST_SKIP() << "this machine has no " << set.name;
  const int cables = static_cast<int>(def.cables.size());
  for (const int threads : {1, 3}) {
    WorldBatch one_by_one = *BatchOn(simd, def, kWorlds, 1),
               at_once = *BatchOn(simd, def, kWorlds, threads);
    Dice dice(7);
    for (int period = 0; period < 5; ++period) {
      std::vector<double> targets;
      for (int i = 0; i < kWorlds; ++i) {
        for (int c = 0; c < cables; ++c) {
          const double rest_m = def.cables[static_cast<std::size_t>(c)].rest_length_m;
          targets.push_back(rest_m * (1 + dice.Roll(0.1)));
          one_by_one.SetRestLengthTarget(i, c, targets.back());
        }
      }
      one_by_one.Step(kVarietyStepS, 10);
      at_once.Step(kVarietyStepS, 10, targets);
    }
    for (int i = 0; i < kWorlds; ++i) ASSERT_EQ(at_once.Save(i), one_by_one.Save(i)) << i;
  }
}

TEST_P(LanesOf, SayOfAllCablesAtOnceWhatTheySayOfEach) {
  const auto [set, model] = GetParam();
  const Simd simd = set.simd;
  const ModelDef def = VariedModels()[model];
  constexpr int kWorlds = 11;
  if (!BatchOn(simd, def, 1, 1)) GTEST_SKIP() << "this machine has no " << set.name;
  WorldBatch batch = *BatchOn(simd, def, kWorlds, 1);
  for (int i = 0; i < kWorlds; ++i) Scatter(batch, i, i);
  batch.Step(kVarietyStepS, kStepsAStretch);
  ASSERT_EQ(batch.groups(), (kWorlds + batch.lanes() - 1) / batch.lanes());
  for (int i = 0; i < kWorlds; ++i) {
    const CableRows rows = batch.Cables(i / batch.lanes());
    ASSERT_EQ(rows.lanes, batch.lanes());
    ASSERT_EQ(rows.first_world, i - i % batch.lanes());
    for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
      const int at = c * rows.lanes + i % rows.lanes;
      const CableState cable = batch.Cable(i, c);
      EXPECT_EQ(rows.length_m[at], cable.length_m);
      EXPECT_EQ(rows.rate_m_per_s[at], cable.rate_m_per_s);
      EXPECT_EQ(rows.rest_length_m[at], cable.rest_length_m);
      EXPECT_EQ(rows.tension_n[at], cable.tension_n);
      EXPECT_EQ(rows.elastic_n[at], cable.elastic_n);
      EXPECT_EQ(rows.stiffness_n_per_m[at], cable.stiffness_n_per_m);
      EXPECT_EQ(cable.stiffness_n_per_m, batch.GetParameter(i, Parameter::kCableStiffness, c));
      rows.rest_length_target_m[at] = 0.1 + 0.01 * at;
      EXPECT_EQ(batch.RestLengthTarget(i, c), 0.1 + 0.01 * at);
    }
  }
}

std::string NameOfBoth(const testing::TestParamInfo<SetAndModel>& each) {
  return std::string(std::get<0>(each.param).name) + "_" +
         VariedModels()[std::get<1>(each.param)].name;
}

INSTANTIATE_TEST_SUITE_P(All, LanesOf,
                         testing::Combine(testing::ValuesIn(kInstructionSets),
                                          testing::Range<std::size_t>(0, VariedModels().size())),
                         NameOfBoth);

class Lanes : public testing::TestWithParam<InstructionSet> {};

TEST_P(Lanes, ObservingAWorldChangesNothing) {
  const auto [name, simd] = GetParam();
  std::optional<WorldBatch> seen = BatchOn(simd, scenes::Jumble().Def(), 9, 1);
  if (!seen) GTEST_SKIP() << "this machine has no " << name;
  WorldBatch unseen = *BatchOn(simd, scenes::Jumble().Def(), 9, 1);
  for (int i = 0; i < 9; ++i) {
    Scatter(*seen, i, i);
    Scatter(unseen, i, i);
  }
  for (int n = 0; n < 200; ++n) {
    seen->Step(1e-3);
    for (int i = 0; i < 9; ++i) {
      seen->Cable(i, 0);
      seen->Body(i, 0);
      seen->TotalEnergy(i);
      seen->Contacts(i);
      seen->NodeVelocity(i, 0);
      seen->Save(i);
    }
  }
  unseen.Step(1e-3, 200);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(seen->Hash(i), unseen.Hash(i)) << i;
}

TEST_P(Lanes, AnObservedLaneIsThatOfItsWorldAlone) {
  const auto [name, simd] = GetParam();
  const ModelDef def = scenes::Jumble().Def();
  std::optional<WorldBatch> batch = BatchOn(simd, def, 9, 1);
  if (!batch) GTEST_SKIP() << "this machine has no " << name;
  for (int i = 0; i < 9; ++i) Scatter(*batch, i, i);
  batch->Step(1e-3, 150);
  for (int i = 0; i < 9; ++i) {
    WorldBatch alone = MakeBatch(def);
    Scatter(alone, 0, i);
    alone.Step(1e-3, 150);
    for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
      const CableState a = batch->Cable(i, c), b = alone.Cable(0, c);
      EXPECT_EQ(a.length_m, b.length_m);
      EXPECT_EQ(a.rate_m_per_s, b.rate_m_per_s);
      EXPECT_EQ(a.rest_length_m, b.rest_length_m);
      EXPECT_EQ(a.tension_n, b.tension_n);
      EXPECT_EQ(a.elastic_n, b.elastic_n);
    }
    const auto contacts = batch->Contacts(i), expected = alone.Contacts(0);
    ASSERT_EQ(contacts.size(), expected.size()) << i;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      EXPECT_EQ(contacts[k].body_a, expected[k].body_a);
      EXPECT_EQ(contacts[k].body_b, expected[k].body_b);
      EXPECT_EQ(Distance(contacts[k].point_m, expected[k].point_m), 0);
      EXPECT_EQ(Distance(contacts[k].force_n, expected[k].force_n), 0);
      EXPECT_EQ(Distance(contacts[k].normal, expected[k].normal), 0);
      EXPECT_EQ(contacts[k].gap_m, expected[k].gap_m);
    }
    EXPECT_EQ(batch->Time(i), alone.Time(0));
    EXPECT_EQ(batch->Status(i).linear_solves, alone.Status(0).linear_solves);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Lanes, testing::ValuesIn(kInstructionSets),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(Threads, ZeroMeansOneACoreAndGivesTheSameBits) {
  WorldBatchOptions options;
  options.worlds = 5;
  options.threads = 0;
  const ModelDef def = scenes::Jumble().Def();
  WorldBatch batch = MakeBatch(def, options);
  for (int i = 0; i < 5; ++i) Scatter(batch, i, i);
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    for (int i = 0; i < 5; ++i) Disturb(batch, i, i, stretch);
    batch.Step(kVarietyStepS, kStepsAStretch);
  }
  for (int i = 0; i < 5; ++i) EXPECT_EQ(batch.Hash(i), Alone(def, i).hashes.back()) << i;
}

/// Sets an environment variable during its lifetime.
class WithEnvironment {
 public:
  WithEnvironment(const char* name, const char* value) : name_(name) {
    const char* const before = std::getenv(name);
    if (before != nullptr) before_ = before;
    setenv(name, value, 1);
  }
  ~WithEnvironment() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  WithEnvironment(const WithEnvironment&) = delete;
  WithEnvironment& operator=(const WithEnvironment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(TautSimd, ChoosesTheInstructionSetOfABatchThatDoesNotSay) {
  const ModelDef def = scenes::HangingMass().Def();
  const auto lanes_of = [&](const char* wish, int worlds) {
    const WithEnvironment environment("TAUT_SIMD", wish);
    WorldBatchOptions options;
    options.worlds = worlds;
    return MakeBatch(def, options).lanes();
  };
  // An instruction set that the machine lacks falls back to an available one; both names of the
  // sets with two lanes are accepted.
  const auto widest_up_to = [&](Simd wish) {
    int lanes = 1;
    for (const auto& [name, simd] : kInstructionSets) {
      if (simd <= wish && BatchOn(simd, def, 1, 1)) lanes = static_cast<int>(simd);
    }
    return lanes;
  };
  EXPECT_EQ(lanes_of("scalar", 3), 1);
  EXPECT_EQ(lanes_of("sse2", 3), widest_up_to(Simd::kSse2));
  EXPECT_EQ(lanes_of("neon", 3), widest_up_to(Simd::kNeon));
  EXPECT_EQ(lanes_of("simd128", 3), widest_up_to(Simd::kSimd128));
  EXPECT_EQ(lanes_of("avx2", 3), widest_up_to(Simd::kAvx2));
  EXPECT_EQ(lanes_of("avx512", 3), widest_up_to(Simd::kAvx512));
  EXPECT_EQ(lanes_of("", 3), widest_up_to(Simd::kAvx512));
  // A single world is scalar; the program's choice overrides the environment.
  EXPECT_EQ(lanes_of("sse2", 1), 1);
  const WithEnvironment environment("TAUT_SIMD", "scalar");
  EXPECT_EQ(BestSimd(), Simd::kScalar);
  WorldBatchOptions options;
  options.worlds = 3;
  options.simd = Simd::kSse2;
  EXPECT_EQ(MakeBatch(def, options).lanes(), widest_up_to(Simd::kSse2));
}

TEST(TautSimd, AnUnknownNameIsAnErrorThatSaysWhatThereIs) {
  const auto complaint = [](const char* wish) {
    const WithEnvironment environment("TAUT_SIMD", wish);
    Diagnostics out;
    const bool compiled = Model::Compile(scenes::HangingMass().Def(), out) != nullptr;
    EXPECT_EQ(compiled, out.ok());
    return out.Format();
  };
  std::string here;
  for (const auto& [name, simd] : kInstructionSets) {
    if (BatchOn(simd, scenes::HangingMass().Def(), 3, 1))
      here += std::string(here.empty() ? "" : ", ") + name;
  }
  EXPECT_EQ(
      complaint("avx"),
      "error: the environment variable TAUT_SIMD is \"avx\" (expected one of: scalar, sse2, neon, "
      "simd128, avx2, avx512; this build of taut on this machine supports: " +
          here + ")\n");
  EXPECT_NE(complaint("AVX2"), "");
  for (const char* known : {"", "scalar", "sse2", "neon", "simd128", "avx2", "avx512"}) {
    EXPECT_EQ(complaint(known), "") << known;
  }
}

TEST(TautSimd, EveryX8664AndEveryAArch64HasTwoLanes) {
  if (std::size(kInstructionSets) == 1) GTEST_SKIP() << "this build has one lane only";
  const ModelDef def = scenes::HangingMass().Def();
  EXPECT_TRUE(BatchOn(Simd::kSse2, def, 3, 1));
  EXPECT_TRUE(BatchOn(Simd::kNeon, def, 3, 1));
}

}  // namespace
}  // namespace taut::test
