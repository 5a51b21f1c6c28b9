/// Writers of little-endian numbers for binary files.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

namespace taut::exporting {

inline void PutShort(std::string& file, std::uint16_t number) {
  file += static_cast<char>(number & 0xff);
  file += static_cast<char>(number >> 8);
}
inline void PutWord(std::string& file, std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) file += static_cast<char>((number >> shift) & 0xff);
}
inline void PutFloat(std::string& file, float x) { PutWord(file, std::bit_cast<std::uint32_t>(x)); }

}  // namespace taut::exporting
