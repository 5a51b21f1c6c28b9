/// For tests of errors whose inputs may be odd.
#pragma once

#include <string>

#include "taut/diagnostics.h"

namespace taut {

/// As printed, without warnings.
inline std::string ErrorsOf(const Diagnostics& found) {
  Diagnostics errors;
  for (const Diagnostic& error : found.items()) errors.AddError(error);
  return errors.Format();
}

}  // namespace taut
