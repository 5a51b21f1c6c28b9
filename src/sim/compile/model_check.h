/// Validation of a model definition: whether it can be simulated.
#pragma once

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut::sim {

/// Limits: more would take hundreds of megabytes and minutes.
inline constexpr long kMaxShapePairs = 10'000'000;
inline constexpr long kMaxCouplings = 10'000'000;

/// Reports a diagnostic (without file position) for every wrong number or index; returns false if
/// there is one.
bool CheckModel(const ModelDef& def, Diagnostics& out);

/// Reports a TAUT_SIMD that names no instruction set.
bool CheckEnvironment(Diagnostics& out);

}  // namespace taut::sim
