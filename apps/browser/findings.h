/// Diagnostics as JSON, for JavaScript.
#pragma once

#include "apps/viewer/scene.h"
#include "taut/diagnostics.h"

namespace taut::browser {

/// Returns [{"file", "line", "column", "error", "what", "hint"}]: the errors, then the warnings,
/// each in the order of their places.
viewer::Json FindingsOf(const Diagnostics& found);

}  // namespace taut::browser
