/// Is a model definition one that can be simulated?
#pragma once

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut::sim {

/// More would take hundreds of megabytes and minutes.
inline constexpr long kMaxShapePairs = 10'000'000;
inline constexpr long kMaxCouplings = 10'000'000;

/// False, with a diagnostic (without file position) for every wrong number or index.
bool CheckModel(const ModelDef& def, Diagnostics& out);

/// Complains about a TAUT_SIMD that names no instruction set.
bool CheckEnvironment(Diagnostics& out);

}  // namespace taut::sim
