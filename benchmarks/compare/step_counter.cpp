// Steps of a standing robot, for counting instructions and for timing; see script/bench --compare.
// Uses public headers only, so that it also builds against older versions.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "taut/spec.h"
#if __has_include("taut/world_batch.h")
#include "taut/world_batch.h"
#else  // up to 0.2
#include "taut/batch.h"
namespace taut {
using WorldBatch = Batch;
using WorldBatchOptions = BatchOptions;
}  // namespace taut
#endif

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: step_counter ROBOT LANES STEPS\nPrints the seconds that STEPS took.\n",
               stderr);
    return 2;
  }
  taut::Diagnostics complaints;
  auto robot = taut::LoadRobot(std::string(TAUT_MODELS "/") + argv[1] + ".yaml", {}, complaints);
  if (!robot) {
    std::fputs(complaints.Format().c_str(), stderr);
    return 3;
  }
  taut::PlaneDef ground;
  ground.name = "ground";
  ground.material = {0.5, 0.5, 0.0};
  robot->def.planes = {ground};
  const auto model = taut::Model::Compile(robot->def, complaints);
  if (model == nullptr) {
    std::fputs(complaints.Format().c_str(), stderr);
    return 3;
  }
  taut::WorldBatchOptions options;
  options.worlds = std::atoi(argv[2]);
  options.simd = static_cast<taut::Simd>(options.worlds);
  taut::WorldBatch batch(model, options);
  if (batch.lanes() != options.worlds) {
    std::fprintf(stderr, "this machine has no %d lanes\n", options.worlds);
    return 4;
  }
  // Slightly different initial motion per world.
  for (int world = 0; world < options.worlds; ++world) {
    for (std::size_t b = 0; b < robot->def.bodies.size(); ++b) {
      const int body = static_cast<int>(b);
      taut::BodyState state = batch.Body(world, body);
      state.velocity_m_per_s.x = 0.05 * (world + 1);
      batch.SetBodyState(world, body, state);
    }
  }
  const int steps = std::atoi(argv[3]);
  batch.Step(0.001, 100);
  const std::clock_t start = std::clock();
  batch.Step(0.001, steps);
  std::printf("%.9g\n", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  return batch.Status(0).bits == taut::kStatusOk ? 0 : 1;
}
