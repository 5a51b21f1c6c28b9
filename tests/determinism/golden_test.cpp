/// Golden hashes of worlds after some seconds, recorded at the last intended change of results.
/// They are equal for all compilers, build types, instruction sets and processors. TAUT_BLESS=1
/// rewrites the file instead of comparing; a changed file means changed results (CHANGELOG.md).

#include <gtest/gtest.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "tests/determinism/variety.h"
#include "tests/instruction_sets.h"

namespace taut::test {
namespace {

const char* const kFile = TAUT_SOURCE_DIR "/tests/determinism/golden.txt";

struct Golden {
  std::string name;
  ModelDef def;
  double step_s;
  int steps;
  std::function<void(WorldBatch&, int when)> command;  ///< Called before every tenth of the run.
};

std::vector<Golden> Goldens() {
  const auto nothing = [](WorldBatch&, int) {};
  scenes::HangingMass swing;
  swing.damping_n_s_per_m = 0.3;
  swing.length_m = 1.05;
  ModelDef pendulum = swing.Def();
  pendulum.bodies[0].velocity_m_per_s = {0.7, -0.4, 0.2};
  scenes::Ball ball;
  ball.drop_m = 1;
  ball.material = {0.4, 0.3, 0.8};
  ModelDef thrown = ball.Def();
  thrown.bodies[0].velocity_m_per_s = {1, 0.5, 0};
  thrown.bodies[0].angular_velocity_rad_per_s = {3, -20, 7};
  scenes::BlockOnSlope block;
  block.slope.angle_rad = 0.5;
  block.material = block.slope.material = {0.4, 0.3, 0.2};
  ModelDef sliding = block.Def();
  sliding.bodies[0].velocity_m_per_s = {-1, 0.3, 0.6};
  scenes::FreeRod rod;
  rod.angular_velocity_rad_per_s = {150, 3, -2};
  scenes::Prism3 prism;
  prism.clearance_m = 0.1;
  prism.damping_n_s_per_m = 2;
  prism.material = {0.6, 0.5, 0.3};
  scenes::Prism3 stiff = prism;
  stiff.stiffness_n_per_m = 1e6;
  ModelDef ntrt = scenes::Tetraspine().Def();
  ntrt.friction_law = FrictionLaw::kAlongSlip;
  for (CableDef& cable : ntrt.cables) cable.damping_law = DampingLaw::kClamped;
  const auto wind = [](WorldBatch& batch, int when) { Disturb(batch, 0, 2, when); };
  return {
      {"pendulum", pendulum, 1e-3, 5000, nothing},
      {"thrown_ball", thrown, 1e-3, 3000, nothing},
      {"sliding_block", sliding, 1e-3, 2000, nothing},
      {"spinning_rod", rod.Def(), 1e-3, 5000, nothing},
      {"dropped_prism", prism.Def(), 1e-3, 2000, nothing},
      {"dropped_prism_of_stiff_cables", stiff.Def(), 1e-3, 1000, nothing},
      {"tetraspine3", scenes::Tetraspine().Def(), 1e-3, 3000, wind},
      {"tetraspine3_ntrt_laws", ntrt, 1e-3, 3000, wind},
      {"tetraspine3_4khz", scenes::Tetraspine().Def(), 2.5e-4, 4000, wind},
      {"tetraspine12", scenes::Tetraspine{.segments = 12}.Def(), 1e-3, 500, wind},
      {"tetraspine3_motors", MotorizedSpine(), 1e-3, 2000, wind},
      {"jumble", scenes::Jumble().Def(), 1e-3, 2000, wind},
  };
}

std::string HashOf(const Golden& golden, const WorldBatchOptions& options) {
  WorldBatch batch = MakeBatch(golden.def, options);
  for (int when = 0; when < 10; ++when) {
    golden.command(batch, when);
    batch.Step(golden.step_s, golden.steps / 10);
  }
  EXPECT_EQ(batch.Status(0).bits & kStatusNonFinite, 0u) << golden.name;
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, batch.Hash(0));
  return text;
}

std::map<std::string, std::string> Stored() {
  std::map<std::string, std::string> stored;
  std::ifstream file(kFile);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name, hash;
    words >> name >> hash;
    stored[name] = hash;
  }
  return stored;
}

TEST(Golden, HashesAreThoseOfTheFile) {
  const char* const bless = std::getenv("TAUT_BLESS");
  if (bless != nullptr && std::string(bless) == "1") {
    std::ofstream file(kFile);
    file << "# Hashes of worlds after some steps: name, hash. Written by golden_test with "
            "TAUT_BLESS=1.\n";
    for (const Golden& golden : Goldens()) file << golden.name << ' ' << HashOf(golden, {}) << '\n';
    ASSERT_TRUE(file.flush()) << "cannot write " << kFile;
    GTEST_SKIP() << "wrote " << kFile;
  }
  const auto stored = Stored();
  for (const Golden& golden : Goldens()) {
    const auto found = stored.find(golden.name);
    if (found == stored.end()) {
      ADD_FAILURE() << golden.name << " is not in " << kFile << "; TAUT_BLESS=1 writes it";
      continue;
    }
    EXPECT_EQ(HashOf(golden, {}), found->second) << golden.name;
  }
  EXPECT_EQ(stored.size(), Goldens().size()) << "the file has scenes that the test has not";
}

TEST(Golden, HashesAreTheSameOnEveryInstructionSet) {
  for (const Golden& golden : Goldens()) {
    const std::string scalar = HashOf(golden, {});
    for (const auto& [name, simd] : kInstructionSets) {
      if (simd == Simd::kScalar) continue;
      WorldBatchOptions options;
      options.simd = simd;
      EXPECT_EQ(HashOf(golden, options), scalar) << golden.name << ", " << name;
    }
  }
}

}  // namespace
}  // namespace taut::test
