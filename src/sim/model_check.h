/// Is a model definition one that can be simulated?
#pragma once

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut::sim {

/// False, with a diagnostic (without file position) for every wrong number or index.
bool CheckModel(const ModelDef& def, Diagnostics& out);

}  // namespace taut::sim
