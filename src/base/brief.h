/// Numbers in messages.
#pragma once

#include <charconv>
#include <string>

namespace taut::base {

/// Four digits: what was calculated and is to be looked at, not read back.
inline std::string Brief(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 4).ptr};
}

}  // namespace taut::base
