/// Validation of a model definition.
#pragma once

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut::sim {

/// Limits of model size; larger models would take hundreds of megabytes and minutes, or need larger
/// keys of contacts.
inline constexpr long kMaxShapePairs = 10'000'000;
inline constexpr long kMaxMovingShapePairs = 200'000'000;
inline constexpr long kMaxCouplings = 10'000'000;

/// Adds a diagnostic without file position for every invalid number or index. Returns false if any
/// is invalid.
bool CheckModel(const ModelDef& def, Diagnostics& out);

/// Adds an error if TAUT_SIMD does not name an instruction set.
bool CheckEnvironment(Diagnostics& out);

}  // namespace taut::sim
