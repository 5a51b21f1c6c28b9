/// Shapes of `taut analyze --out` in traces.
#pragma once

#include "scene.h"
#include "taut/trace.h"

namespace taut::viewer {

/// Returns the ShapeInfo (web/protocol/messages.json) of a trace with this metadata; null for
/// traces of other origin.
Json ShapeOf(const TraceMetadata& metadata);

}  // namespace taut::viewer
