// How much of the bare step rate rollouts reach: rollouts EXPERIMENT [SECONDS]. Prints JSON.
//
// Bare is the same number of worlds, held by its motors and stepped by nothing but Batch::Step. A
// robot that moves touches more and is costlier to step: "moving" is a bare batch whose motors get
// a new target every 10 ms.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "taut/rollout.h"

namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  using namespace taut;
  Diagnostics out;
  auto experiment = argc > 1 ? LoadExperiment(argv[1], {}, out) : std::nullopt;
  const auto model = experiment ? Model::Compile(experiment->robot.def, out) : nullptr;
  if (!model) {
    std::fprintf(stderr, "usage: rollouts EXPERIMENT [SECONDS]\n%s", out.Format().c_str());
    return 2;
  }
  experiment->duration_s = argc > 2 ? std::atof(argv[2]) : 20.0;
  const int worlds = static_cast<int>(BestSimd());
  const auto steps = static_cast<int>(experiment->duration_s / experiment->step_s + 0.5);
  const auto rollouts = Rollouts::Create(*experiment, {}, {}, out);
  const std::vector<RolloutWorld> same(static_cast<std::size_t>(worlds), WorldOf(*experiment));

  const std::size_t cables = experiment->robot.def.cables.size();
  double bare_s = 1e300, rollout_s = 1e300, moving_s = 1e300;
  for (int repetition = 0; repetition < 5; ++repetition) {
    BatchOptions options;
    options.worlds = worlds;
    Batch batch(model, options);
    auto start = Clock::now();
    batch.Step(experiment->step_s, steps);
    bare_s = std::min(bare_s, Since(start));
    start = Clock::now();
    const auto results = rollouts->Run(same);
    rollout_s = std::min(rollout_s, Since(start));
    if (!results[0].failed.empty()) std::fprintf(stderr, "%s\n", results[0].failed.c_str());
    Batch moving(model, options);
    start = Clock::now();
    for (int step = 0; step < steps; step += 10) {
      const CableRows rows = moving.Cables(0);
      for (std::size_t c = 0; c < cables; ++c) {
        const double phase = 0.01 * step / 10 + 0.37 * static_cast<double>(c);
        const double wave = 2.0 * (phase - static_cast<double>(static_cast<int>(phase))) - 1.0;
        for (int j = 0; j < rows.lanes; ++j) {
          rows.rest_length_target_m[c * static_cast<std::size_t>(rows.lanes) +
                                    static_cast<std::size_t>(j)] =
              experiment->robot.def.cables[c].rest_length_m * (1 + 0.2 * wave);
        }
      }
      moving.Step(experiment->step_s, 10);
    }
    moving_s = std::min(moving_s, Since(start));
  }
  const double total = static_cast<double>(steps) * worlds;
  std::printf(
      "{\"lanes\": %d, \"bare_steps_per_s\": %.4g, \"moving_steps_per_s\": %.4g, "
      "\"rollout_steps_per_s\": %.4g}\n",
      worlds, total / bare_s, total / moving_s, total / rollout_s);
  return 0;
}
