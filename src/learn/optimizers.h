/// Constructors of the optimizers, used by `MakeOptimizer`.
#pragma once

#include <memory>

#include "taut/optimizer.h"

namespace taut::learn {

std::unique_ptr<Optimizer> MakeMonteCarlo(int batch, const OptimizerStart& start);
std::unique_ptr<Optimizer> MakeHillClimbing(const HillClimbingSpec& spec, int batch,
                                            const OptimizerStart& start);
std::unique_ptr<Optimizer> MakeCmaEs(const CmaEsSpec& spec, int batch, const OptimizerStart& start);
std::unique_ptr<Optimizer> MakeNlopt(const NloptSpec& spec, const OptimizerStart& start);

}  // namespace taut::learn
