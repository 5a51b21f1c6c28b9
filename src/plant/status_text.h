/// Description of a world's status.
#pragma once

#include <string>

#include "taut/world_batch.h"

namespace taut::plant {

/// Describes a status with the names of body, cable and terrain; empty if there is no problem.
std::string StatusText(const ModelDef& def, const WorldStatus& status);

}  // namespace taut::plant
