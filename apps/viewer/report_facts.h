/// Description of a run in words, for the top of a report.
#pragma once

#include "scene.h"
#include "taut/spec.h"

namespace taut::viewer {

/// Returns texts by topic, in reading order.
Json FactsOf(const ExperimentSpec& experiment);

}  // namespace taut::viewer
