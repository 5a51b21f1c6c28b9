/// What a reader of a report wants to know first: what was run, in words.
#pragma once

#include "scene.h"
#include "taut/spec.h"

namespace taut::viewer {

/// Texts by what they are about, in the order in which they are read.
Json FactsOf(const ExperimentSpec& experiment);

}  // namespace taut::viewer
