// Steps of an experiment with its controllers, whose instructions valgrind counts (script/bench
// --cost).
//
//   valgrind --tool=callgrind --toggle-collect='CountedSteps*' step_cost EXPERIMENT WORLDS SET
//   STEPS
//
// SET: scalar, sse2, avx2, avx512 or neon. Only the function CountedSteps is counted, so that
// reading and compiling the model cancel.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "taut/instruction_sets.h"
#include "taut/simulation.h"
#include "taut/spec.h"

namespace {

constexpr int kUncounted = 100;  // the robot reaches the ground, and caches of the step are filled

}  // namespace

extern "C" [[gnu::noinline]] void CountedSteps(taut::Simulation& sim, int steps) {
  for (int i = 0; i < steps; ++i) sim.Step();
}

int main(int count, char** words) {
  if (count != 5) {
    std::fputs("usage: step_cost EXPERIMENT WORLDS SET STEPS\n", stderr);
    return 2;
  }
  taut::Diagnostics out;
  auto experiment = taut::LoadExperiment(words[1], {}, out);
  std::unique_ptr<taut::Simulation> sim;
  if (experiment) {
    experiment->start = taut::StartKind::kAsDescribed;  // settling would take minutes in valgrind
    taut::SimulationOptions options;
    options.worlds = std::atoi(words[2]);
    for (const taut::InstructionSet& set : taut::InstructionSets()) {
      if (set.name == std::string_view(words[3]) && set.runs_here) options.simd = set.simd;
    }
    if (!options.simd) return std::fprintf(stderr, "%s does not run here\n", words[3]), 4;
    sim = taut::Simulation::Create(*experiment, options, out);
  }
  if (!sim) {
    std::fputs(out.Format().c_str(), stderr);
    return 3;
  }
  for (int i = 0; i < kUncounted; ++i) sim->Step();
  CountedSteps(*sim, std::atoi(words[4]));
  std::printf("%016llx\n", static_cast<unsigned long long>(sim->Hash(0)));
  return 0;
}
