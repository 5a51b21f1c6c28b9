/// Cluster that consists of a single process.
#pragma once

#include <memory>

#include "taut/cluster.h"

namespace taut::cluster {

std::unique_ptr<Cluster> MakeAlone();

}  // namespace taut::cluster
