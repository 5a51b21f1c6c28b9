/// Check that worlds in the lanes of a SIMD register have the bits of single worlds.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/instruction_sets.h"
#include "tests/physics/world.h"

namespace taut::test {

/// Compares eight worlds, the n-th moved by n `step_m` at the start, with single worlds after
/// `steps` steps of 1 ms, with each instruction set.
inline void ExpectLanesLikeWorldsAlone(const ModelDef& def, const Vec3& step_m, int steps) {
  const auto start = [&](WorldBatch& batch, int world, int which) {
    for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
      BodyState state = batch.Body(world, b);
      state.position_m = state.position_m + static_cast<double>(which) * step_m;
      batch.SetBodyState(world, b, state);
    }
  };
  std::uint64_t expected[8];
  for (int w = 0; w < 8; ++w) {
    WorldBatch alone = MakeBatch(def);
    start(alone, 0, w);
    alone.Step(1e-3, steps);
    expected[w] = alone.Hash(0);
  }
  for (const InstructionSet& set : kInstructionSets) {
    WorldBatchOptions options;
    options.worlds = 8;
    options.simd = set.simd;
    WorldBatch all = MakeBatch(def, options);
    for (int w = 0; w < 8; ++w) start(all, w, w);
    all.Step(1e-3, steps);
    for (int w = 0; w < 8; ++w) EXPECT_EQ(all.Hash(w), expected[w]) << set.name << " " << w;
  }
}

}  // namespace taut::test
