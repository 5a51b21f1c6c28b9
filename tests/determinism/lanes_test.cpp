/// A world gives the same bits alone, in any lane, on any number of threads, on any instruction set.

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>

#include "tests/determinism/variety.h"

namespace taut::test {
namespace {

const char* NameOf(Simd simd) {
  switch (simd) {
    case Simd::kSse2: return "sse2";
    case Simd::kAvx2: return "avx2";
    case Simd::kAvx512: return "avx512";
    default: return "scalar";
  }
}

/// A batch of `worlds` on this instruction set; nothing if the machine lacks it.
std::optional<Batch> BatchOn(Simd simd, const ModelDef& def, int worlds, int threads) {
  BatchOptions options;
  options.worlds = worlds;
  options.threads = threads;
  options.simd = simd;
  Batch batch = MakeBatch(def, options);
  if (batch.lanes() != static_cast<int>(simd)) return std::nullopt;
  return batch;
}

/// What each model and seed comes to alone, in scalar code: worked out once.
const Outcome& Expected(const ModelDef& def, std::size_t model, int seed) {
  static std::map<std::pair<std::size_t, int>, Outcome> known;
  const auto key = std::make_pair(model, seed);
  const auto found = known.find(key);
  return found != known.end() ? found->second : known.emplace(key, Alone(def, seed)).first->second;
}

void LanesEqualWorldsAlone(Simd simd, int worlds, int threads) {
  const std::vector<ModelDef> models = VariedModels();
  for (std::size_t m = 0; m < models.size(); ++m) {
    std::optional<Batch> batch = BatchOn(simd, models[m], worlds, threads);
    if (!batch) GTEST_SKIP() << "this machine has no " << NameOf(simd);
    for (int i = 0; i < worlds; ++i) Scatter(*batch, i, i);
    for (int stretch = 0; stretch < kStretches; ++stretch) {
      for (int i = 0; i < worlds; ++i) Disturb(*batch, i, i, stretch);
      batch->Step(kVarietyStepS, kStepsAStretch);
      for (int i = 0; i < worlds; ++i) {
        ASSERT_EQ(batch->Hash(i), Expected(models[m], m, i).hashes[static_cast<std::size_t>(stretch)])
            << models[m].name << " (" << m << "), world " << i << ", after "
            << (stretch + 1) * kStepsAStretch << " steps";
      }
    }
    for (int i = 0; i < worlds; ++i) {
      EXPECT_EQ(batch->Save(i), Expected(models[m], m, i).snapshot) << models[m].name << i;
      // The hash sees what happens: no two worlds are alike, none is broken.
      EXPECT_NE(batch->Hash(i), batch->Hash((i + 1) % worlds)) << models[m].name << i;
      EXPECT_EQ(batch->Status(i).bits & kStatusNonFinite, 0u) << models[m].name << i;
    }
  }
}

class Lanes : public testing::TestWithParam<Simd> {};

TEST_P(Lanes, EachEqualsItsWorldAlone) { LanesEqualWorldsAlone(GetParam(), 19, 1); }

TEST_P(Lanes, EachEqualsItsWorldAloneOnTwoThreads) { LanesEqualWorldsAlone(GetParam(), 19, 2); }

TEST_P(Lanes, EachEqualsItsWorldAloneOnThreeThreads) { LanesEqualWorldsAlone(GetParam(), 19, 3); }

TEST_P(Lanes, ObservingAWorldChangesNothing) {
  std::optional<Batch> seen = BatchOn(GetParam(), scenes::Jumble().Def(), 9, 1);
  if (!seen) GTEST_SKIP() << "this machine has no " << NameOf(GetParam());
  Batch unseen = *BatchOn(GetParam(), scenes::Jumble().Def(), 9, 1);
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
  const ModelDef def = scenes::Jumble().Def();
  std::optional<Batch> batch = BatchOn(GetParam(), def, 9, 1);
  if (!batch) GTEST_SKIP() << "this machine has no " << NameOf(GetParam());
  for (int i = 0; i < 9; ++i) Scatter(*batch, i, i);
  batch->Step(1e-3, 150);
  for (int i = 0; i < 9; ++i) {
    Batch alone = MakeBatch(def);
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
    EXPECT_EQ(batch->Status(i).sweeps, alone.Status(0).sweeps);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Lanes,
                         testing::Values(Simd::kScalar, Simd::kSse2, Simd::kAvx2, Simd::kAvx512),
                         [](const auto& each) { return std::string(NameOf(each.param)); });

TEST(Threads, ZeroMeansOneACoreAndGivesTheSameBits) {
  BatchOptions options;
  options.worlds = 5;
  options.threads = 0;
  const ModelDef def = scenes::Jumble().Def();
  Batch batch = MakeBatch(def, options);
  for (int i = 0; i < 5; ++i) Scatter(batch, i, i);
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    for (int i = 0; i < 5; ++i) Disturb(batch, i, i, stretch);
    batch.Step(kVarietyStepS, kStepsAStretch);
  }
  const std::size_t jumble = VariedModels().size() - 1;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(batch.Hash(i), Expected(def, jumble, i).hashes.back()) << i;
}

/// Sets an environment variable for as long as it lives.
class WithEnvironment {
 public:
  WithEnvironment(const char* name, const char* value) : name_(name) {
    const char* const before = std::getenv(name);
    if (before != nullptr) before_ = before;
    setenv(name, value, 1);
  }
  ~WithEnvironment() {
    before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_);
  }
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
    BatchOptions options;
    options.worlds = worlds;
    return MakeBatch(def, options).lanes();
  };
  EXPECT_EQ(lanes_of("scalar", 3), 1);
  EXPECT_EQ(lanes_of("sse2", 3), 2);
  // What the machine lacks falls back to what it has.
  EXPECT_EQ(lanes_of("avx2", 3), BatchOn(Simd::kAvx2, def, 1, 1) ? 4 : 2);
  const int widest = BatchOn(Simd::kAvx512, def, 1, 1) ? 8 : lanes_of("avx2", 3);
  EXPECT_EQ(lanes_of("avx512", 3), widest);
  EXPECT_EQ(lanes_of("", 3), widest);
  // A single world is scalar; what a program asks for counts more than the environment.
  EXPECT_EQ(lanes_of("sse2", 1), 1);
  const WithEnvironment environment("TAUT_SIMD", "scalar");
  EXPECT_EQ(BestSimd(), Simd::kScalar);
  BatchOptions options;
  options.worlds = 3;
  options.simd = Simd::kSse2;
  EXPECT_EQ(MakeBatch(def, options).lanes(), 2);
}

}  // namespace
}  // namespace taut::test
