// Variants of an experiment with its controllers: cable tension after 1 s for 1,000 stiffnesses.
#include <cstdio>

#include "taut/simulation.h"

int main(int, char** argv) {
  taut::Diagnostics found;
  const auto experiment = taut::LoadExperiment(argv[1], {}, found);
  if (!experiment) return std::fputs(found.Format().c_str(), stderr), 1;
  std::vector<taut::RolloutWorld> variants(1000, taut::WorldOf(*experiment));
  for (std::size_t w = 0; w < variants.size(); ++w) {
    variants[w].scales.push_back(
        {taut::ScaleSpec::Quantity::kStiffness, {}, 0.5 + static_cast<double>(w) / 1000});
  }
  const auto sim =
      taut::Simulation::Create(*experiment, {.variants = variants, .threads = 0}, found);
  if (!sim) return std::fputs(found.Format().c_str(), stderr), 1;
  sim->RunUntil(1.0);
  for (int w = 0; w < 1000; w += 250)
    std::printf("%d: %.6f N\n", w, sim->Cable("outer_right_1", w).tension_n);
}
