// Step rate of rollouts relative to bare steps: rollout_speed EXPERIMENT [SECONDS]. Prints JSON.
//
// A moving robot has more contacts and costs more per step than a standing one, so "bare" repeats
// the same motion: a batch that receives, step by step, the rest lengths that the controllers
// commanded in a previous run, and only runs WorldBatch::Step. "held" is a batch whose motors hold
// still.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "taut/live.h"
#include "taut/rollout.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns the commanded rest length of each cable in each step.
std::vector<std::vector<double>> CommandsOf(const ExperimentSpec& experiment, int steps,
                                            Diagnostics& out) {
  std::vector<std::vector<double>> commands;
  const auto live = LiveRun::Start(experiment, out);
  if (!live) return commands;
  std::vector<std::size_t> columns;
  for (const CableDef& cable : experiment.robot.def.cables) {
    const std::string name = "cable/" + cable.name + "/target_rest_length_m";
    for (std::size_t i = 0; i < live->channels().size(); ++i) {
      if (live->channels()[i].name == name) columns.push_back(i);
    }
  }
  for (int step = 0; step < steps && live->Step(); ++step) {
    const std::vector<double>& row = live->Row();
    std::vector<double>& command = commands.emplace_back();
    for (const std::size_t column : columns) command.push_back(row[column]);
  }
  return commands;
}

/// Steps all worlds, with commands if there are any. Returns the time [s].
double StepAll(const std::shared_ptr<const Model>& model, double step_s, int steps,
               const std::vector<std::vector<double>>& commands) {
  WorldBatchOptions options;
  options.worlds = static_cast<int>(BestSimd());
  WorldBatch batch(model, options);
  const CableRows rows = batch.Cables(0);
  const auto start = Clock::now();
  if (commands.empty()) batch.Step(step_s, steps);
  for (const std::vector<double>& command : commands) {
    double* target = rows.rest_length_target_m;
    for (const double rest_m : command) target = std::fill_n(target, rows.lanes, rest_m);
    batch.Step(step_s);
  }
  return Since(start);
}

int Main(int argc, char** argv) {
  Diagnostics out;
  auto experiment = argc > 1 ? LoadExperiment(argv[1], {}, out) : std::nullopt;
  const auto model = experiment ? Model::Compile(experiment->robot.def, out) : nullptr;
  if (!model) {
    std::fprintf(stderr, "usage: rollout_speed EXPERIMENT [SECONDS]\n%s", out.Format().c_str());
    return 2;
  }
  experiment->duration_s = argc > 2 ? std::atof(argv[2]) : 20.0;
  const double step_s = experiment->step_s;
  const auto steps = static_cast<int>(experiment->duration_s / step_s + 0.5);
  const auto commands = CommandsOf(*experiment, steps, out);
  const auto rollouts = Rollouts::Create(*experiment, {}, {}, out);
  const int worlds = rollouts->lanes();
  const std::vector<RolloutWorld> same(static_cast<std::size_t>(worlds), WorldOf(*experiment));
  double held_s = 1e300, bare_s = 1e300, rollout_s = 1e300;
  for (int repetition = 0; repetition < 20;
       ++repetition) {  // the best of each: the machine may be shared
    held_s = std::min(held_s, StepAll(model, step_s, steps, {}));
    bare_s = std::min(bare_s, StepAll(model, step_s, steps, commands));
    const auto start = Clock::now();
    rollouts->Run(same);
    rollout_s = std::min(rollout_s, Since(start));
  }
  const double total = static_cast<double>(steps) * worlds;
  std::printf(
      "{\"lanes\": %d, \"held_steps_per_s\": %.4g, \"bare_steps_per_s\": %.4g, "
      "\"rollout_steps_per_s\": %.4g}\n",
      worlds, total / held_s, total / bare_s, total / rollout_s);
  return 0;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) { return taut::Main(argc, argv); }
