/// Conversion of numbers to text for messages and files.
#pragma once

#include <string>

#include "base/number_text.h"

namespace taut::base {

/// Returns a number with `digits` digits, at most 17. Use it for computed values that are only
/// displayed.
inline std::string Brief(double number, int digits = 4) {
  char text[32];
  return {text, ToChars(text, text + sizeof text, number, digits).ptr};
}

/// Returns the shortest text that reads back as the same number. Use it for values from files and
/// flags.
inline std::string Shortest(double number) {
  char text[32];
  return {text, ToChars(text, text + sizeof text, number).ptr};
}

}  // namespace taut::base
