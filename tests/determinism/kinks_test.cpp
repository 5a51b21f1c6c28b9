/// Cables that continually become slack and taut, at different times in each SIMD lane: each world
/// is bit-identical to a single world.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "instruction_sets.h"
#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut {
namespace {

TEST(Kinks, WorldsThatGoSlackAtDifferentTimesAreLikeWorldsAlone) {
  Diagnostics out;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/tetrahedral_complex.yaml", {}, out);
  ASSERT_TRUE(robot) << out.Format();
  ModelDef def = robot->def;
  PlaneDef ground;
  ground.name = "ground";
  ground.material.static_friction = ground.material.kinetic_friction = 0.5;
  def.planes.push_back(ground);
  const auto model = Model::Compile(def, out);
  ASSERT_NE(model, nullptr) << out.Format();

  constexpr int kWorlds = 8, kSteps = 1000;
  struct Wave {
    double hz, amplitude_m, offset_m, along_rad;
  };
  std::mt19937 bits(5);
  const auto uniform = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  Wave waves[kWorlds];
  for (Wave& wave : waves) {
    wave.hz = 0.2 + 1.8 * uniform();
    wave.amplitude_m = 0.01 + 0.08 * uniform();
    wave.offset_m = -0.05 + 0.07 * uniform();
    wave.along_rad = -1.5 + 3 * uniform();
  }
  const auto steer = [&](WorldBatch& batch, int world, const Wave& wave, int step) {
    for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
      const double phase = 6.28 * wave.hz * step * 1e-3 + wave.along_rad * (c / 8) + 1.57 * (c % 8);
      const double rest = def.cables[static_cast<std::size_t>(c)].rest_length_m + wave.offset_m +
                          wave.amplitude_m * std::sin(phase);
      batch.SetRestLengthTarget(world, c, std::fmax(rest, 0.02));
    }
  };
  std::vector<std::uint64_t> alone;
  for (const Wave& wave : waves) {
    WorldBatchOptions options;
    options.simd = Simd::kScalar;
    WorldBatch batch(model, options);
    for (int step = 0; step < kSteps; step += 10) {
      steer(batch, 0, wave, step);
      batch.Step(1e-3, 10);
      alone.push_back(batch.Hash(0));
    }
  }
  for (const test::InstructionSet& set : test::kInstructionSets) {
    WorldBatchOptions options;
    options.worlds = kWorlds;
    options.simd = set.simd;
    WorldBatch batch(model, options);
    for (int step = 0; step < kSteps; step += 10) {
      for (int w = 0; w < kWorlds; ++w) steer(batch, w, waves[w], step);
      batch.Step(1e-3, 10);
      for (int w = 0; w < kWorlds; ++w) {
        const auto at = static_cast<std::size_t>(w * (kSteps / 10) + step / 10);
        ASSERT_EQ(batch.Hash(w), alone[at]) << set.name << ", world " << w << ", step " << step;
      }
    }
  }
}

}  // namespace
}  // namespace taut
