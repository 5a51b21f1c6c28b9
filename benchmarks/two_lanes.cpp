// Steps of two worlds in one register, for robots of experiments on their ground without
// controllers: script/wasm --bench runs it natively and in WebAssembly. Prints a line of JSON for
// each.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>

#include "taut/spec.h"
#include "taut/world_batch.h"

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kSteps = 400, kRounds = 5;

bool Measure(const char* path) {
  taut::Diagnostics out;
  const auto experiment = taut::LoadExperiment(path, {}, out);
  const auto model = experiment ? taut::Model::Compile(experiment->robot.def, out) : nullptr;
  if (!model) {
    std::fputs(out.Format().c_str(), stderr);
    return false;
  }
  taut::WorldBatchOptions options;
  options.worlds = 2;
  options.simd = taut::Simd::kSse2;  // two lanes on every platform
  taut::WorldBatch batch(model, options);
  batch.Step(experiment->step_s, kSteps);  // falls onto the ground, and warms up
  double least_s = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    const auto start = Clock::now();
    batch.Step(experiment->step_s, kSteps);
    least_s = std::min(least_s, std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::printf("{\"experiment\": \"%s\", \"lanes\": %d, \"us\": %.4f, \"hash\": \"%016llx\"}\n",
              experiment->name.c_str(), batch.lanes(), 1e6 * least_s / kSteps,
              static_cast<unsigned long long>(batch.Hash(1)));
  return true;
}

}  // namespace

int main(int count, char** words) {
  for (int i = 1; i < count; ++i) {
    if (!Measure(words[i])) return 3;
  }
  return 0;
}
