/// Formatted errors without warnings, for tests of errors whose inputs may cause warnings
#pragma once

#include <string>

#include "taut/diagnostics.h"

namespace taut {

/// Returns the errors as printed, without warnings.
inline std::string ErrorsOf(const Diagnostics& found) {
  Diagnostics errors;
  for (const Diagnostic& error : found.items()) errors.AddError(error);
  return errors.Format();
}

}  // namespace taut
