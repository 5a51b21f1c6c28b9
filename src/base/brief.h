/// Numbers in messages.
#pragma once

#include <string>

#include "base/number_text.h"

namespace taut::base {

/// Returns a number with four digits, for computed values that are displayed only.
inline std::string Brief(double number) {
  char text[32];
  return {text, ToChars(text, text + sizeof text, number, 4).ptr};
}

}  // namespace taut::base
