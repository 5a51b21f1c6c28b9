/// Numbers in messages.
#pragma once

#include <string>

#include "base/number_text.h"

namespace taut::base {

/// Four digits: what was calculated and is to be looked at, not read back.
inline std::string Brief(double number) {
  char text[32];
  return {text, ToChars(text, text + sizeof text, number, 4).ptr};
}

}  // namespace taut::base
