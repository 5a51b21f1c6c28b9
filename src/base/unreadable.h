/// Unreadable input files, as opposed to files with mistakes in them.
#pragma once

#include "taut/diagnostics.h"

namespace taut::base {

/// Returns true for diagnostics of `ReadInputFile` about files that the system does not open or
/// read: the contents of such a file are unknown, and not wrong.
bool IsUnreadable(const Diagnostic& diagnostic);

}  // namespace taut::base
