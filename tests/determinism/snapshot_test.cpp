/// Serialization of worlds: a snapshot holds all data that determine a world's future, and none of
/// its neighbors' data.

#include <gtest/gtest.h>

#include "tests/determinism/variety.h"
#include "tests/instruction_sets.h"

namespace taut::test {
namespace {

WorldBatchOptions Of(int worlds, Simd simd) {
  WorldBatchOptions options;
  options.worlds = worlds;
  options.simd = simd;
  return options;
}

TEST(Snapshot, ARestoredWorldGoesOnAsItWouldHave) {
  for (const ModelDef& def : VariedModels()) {
    for (int seed = 0; seed < 6; ++seed) {
      WorldBatch original = MakeBatch(def);
      Scatter(original, 0, seed);
      Disturb(original, 0, seed, 0);
      original.Step(1e-3, 130);
      Disturb(original, 0, seed, 1);
      const std::vector<std::uint8_t> snapshot = original.Save(0);
      const std::uint64_t hash = original.Hash(0);
      original.Step(1e-3, 70);
      const std::uint64_t later = original.Hash(0);

      ASSERT_TRUE(original.Restore(0, snapshot));  // back to an earlier time
      EXPECT_EQ(original.Hash(0), hash) << def.name << seed;
      EXPECT_EQ(original.Save(0), snapshot) << def.name << seed;
      original.Step(1e-3, 70);
      EXPECT_EQ(original.Hash(0), later) << def.name << seed;

      WorldBatch fresh = MakeBatch(def);
      ASSERT_TRUE(fresh.Restore(0, snapshot));
      EXPECT_EQ(fresh.Hash(0), hash) << def.name << seed;
      EXPECT_NEAR(fresh.Time(0), 0.13, RoundOff(130, 0.13));
      fresh.Step(1e-3, 70);
      EXPECT_EQ(fresh.Hash(0), later) << def.name << seed;
    }
  }
}

TEST(Snapshot, AWorldGoesOnAlikeInAnotherLaneAndItsNewNeighboursDoNotNotice) {
  for (const auto& [name, simd] : kInstructionSets) {
    for (const ModelDef& def : VariedModels()) {
      WorldBatch batch = MakeBatch(def, Of(11, simd)), without = MakeBatch(def, Of(11, simd));
      for (int i = 0; i < 11; ++i) {
        Scatter(batch, i, i);
        Scatter(without, i, i);
      }
      batch.Step(1e-3, 90);
      without.Step(1e-3, 90);
      // World 1 now lies on the ground. World 10 gets its state, world 3 the state of a world of
      // another batch.
      WorldBatch guest = MakeBatch(def);
      Scatter(guest, 0, 40);
      guest.Step(1e-3, 150);
      ASSERT_TRUE(batch.Restore(10, batch.Save(1)));
      ASSERT_TRUE(batch.Restore(3, guest.Save(0)));
      for (int i = 0; i < 11; ++i) {
        if (i == 3 || i == 10) continue;
        EXPECT_EQ(batch.Hash(i), without.Hash(i)) << def.name << i;
      }
      batch.Step(1e-3, 60);
      without.Step(1e-3, 60);
      guest.Step(1e-3, 60);
      for (int i = 0; i < 11; ++i) {
        const std::uint64_t expected = i == 3 ? guest.Hash(0) : without.Hash(i == 10 ? 1 : i);
        EXPECT_EQ(batch.Hash(i), expected) << def.name << ", world " << i << ", " << name;
      }
    }
  }
}

TEST(Snapshot, AWorldGoesOnAlikeWhateverStepsItsNewGroupMadeBefore) {
  const ModelDef def = scenes::Tetraspine().Def();
  for (const double before : {1e-3, 4e-3}) {
    const double elsewhere = before > 2e-3 ? 1e-3 : 4e-3;
    WorldBatch original = MakeBatch(def);
    Scatter(original, 0, 1);
    original.Step(before, 40);
    const std::vector<std::uint8_t> snapshot = original.Save(0);
    WorldBatch group = MakeBatch(def, Of(2, Simd::kSse2)),
               without = MakeBatch(def, Of(2, Simd::kSse2));
    for (int i = 0; i < 2; ++i) {
      Scatter(group, i, 5 + i);
      Scatter(without, i, 5 + i);
    }
    group.Step(elsewhere, 20);
    without.Step(elsewhere, 20);
    ASSERT_TRUE(group.Restore(1, snapshot));
    EXPECT_EQ(group.Save(1), snapshot);
    original.Step(2e-3, 20);
    group.Step(2e-3, 20);
    without.Step(2e-3, 20);
    EXPECT_EQ(group.Hash(1), original.Hash(0)) << before;
    EXPECT_EQ(group.Hash(0), without.Hash(0)) << before;
  }
}

TEST(Snapshot, TheStatusComesAlong) {
  ModelDef def = scenes::Jumble().Def();
  WorldBatchOptions options;
  options.tolerance_m_per_s = 1e-30;  // not reachable with a contact
  WorldBatch world = MakeBatch(def, options);
  world.Step(1e-3, 300);
  ASSERT_NE(world.Status(0).bits & kStatusNotConverged, 0u);
  WorldBatch other = MakeBatch(def, options);
  ASSERT_EQ(other.Status(0).bits, kStatusOk);
  ASSERT_TRUE(other.Restore(0, world.Save(0)));
  EXPECT_EQ(other.Status(0).bits, world.Status(0).bits);
  EXPECT_EQ(other.Status(0).first_time_s, world.Status(0).first_time_s);
}

TEST(Snapshot, WhatIsNotASnapshotOfThisModelIsRefusedAndChangesNothing) {
  WorldBatch world = MakeBatch(scenes::Tetraspine().Def());
  Scatter(world, 0, 1);
  world.Step(1e-3, 50);
  const std::uint64_t hash = world.Hash(0);
  const std::vector<std::uint8_t> good = world.Save(0);

  std::vector<std::uint8_t> bad;
  EXPECT_FALSE(world.Restore(0, bad)) << "empty";
  bad.assign(good.begin(), good.end() - 1);
  EXPECT_FALSE(world.Restore(0, bad)) << "too short";
  bad.assign(good.begin(), good.begin() + 8);
  EXPECT_FALSE(world.Restore(0, bad)) << "shorter than its header";
  bad = good;
  bad.push_back(0);
  EXPECT_FALSE(world.Restore(0, bad)) << "too long";
  bad = good;
  bad[0] ^= 1;
  EXPECT_FALSE(world.Restore(0, bad)) << "something else";
  WorldBatch prism = MakeBatch(scenes::Prism3().Def());
  EXPECT_FALSE(world.Restore(0, prism.Save(0))) << "of another model";
  EXPECT_EQ(world.Hash(0), hash);
  EXPECT_TRUE(world.Restore(0, good));
  EXPECT_EQ(world.Hash(0), hash);
}

TEST(Snapshot, TheHashSeesEveryPartOfAWorld) {
  const ModelDef def = scenes::Tetraspine().Def();
  WorldBatch reference = MakeBatch(def);
  const auto differs = [&](const auto& change) {
    WorldBatch world = MakeBatch(def);
    EXPECT_EQ(world.Hash(0), reference.Hash(0));
    change(world);
    return world.Hash(0) != reference.Hash(0) && world.Save(0) != reference.Save(0);
  };
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetTime(0, 1e-9); }));
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetRestLength(0, 11, 0.2); }));
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetRestLengthTarget(0, 11, 0.2); }));
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetNodeForce(0, 17, {0, 0, 1e-9}); }));
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetParameter(0, Parameter::kCableDamping, 11, 1); }));
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetParameter(0, Parameter::kFrictionScale, 0, 0.9); }));
  EXPECT_TRUE(differs([](WorldBatch& w) { w.SetParameter(0, Parameter::kGravityY, 0, 1e-9); }));
  EXPECT_TRUE(differs([](WorldBatch& w) {
    BodyState state = w.Body(0, 2);
    state.angular_velocity_rad_per_s.z = 1e-9;
    w.SetBodyState(0, 2, state);
  }));
}

TEST(Snapshot, WhatARestoredWorldReportsIsNotOfTheOneBefore) {
  WorldBatch batch = MakeBatch(scenes::Jumble().Def());
  const std::vector<std::uint8_t> fresh = batch.Save(0);
  batch.Step(1e-3, 700);
  ASSERT_GT(batch.Contacts(0).size(), 0u);
  ASSERT_GT(batch.Status(0).linear_solves, 0);
  ASSERT_GT(batch.Status(0).residual_m_per_s, 0);
  ASSERT_TRUE(batch.Restore(0, fresh));
  EXPECT_EQ(batch.Contacts(0).size(), 0u);
  EXPECT_EQ(batch.Status(0).linear_solves, 0);
  EXPECT_EQ(batch.Status(0).residual_m_per_s, 0);
}

}  // namespace
}  // namespace taut::test
