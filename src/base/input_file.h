/// Input files that users or other files name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "taut/diagnostics.h"

namespace taut::base {

/// Origin of a path. A path from the command line may be a pipe. Paths inside files must be regular
/// files, since reading from a pipe or device could block or never end.
enum class NamedBy { kUser, kFile };

/// Returns all bytes of a file. Returns nothing and adds a diagnostic if the file is a directory,
/// cannot be read, is not a regular file (NamedBy::kFile), or is larger than `most_bytes`. It reads
/// at most `most_bytes`. `hint`: hint of the size diagnostic.
std::optional<std::string> ReadInputFile(const std::string& path, std::size_t most_bytes,
                                         const std::string& hint, Diagnostics& out,
                                         NamedBy named_by = NamedBy::kFile);

/// Returns true for characters that input texts must not contain: NUL would truncate a path, ESC
/// could make a terminal display false contents. For yaml-cpp, byte 4 is the end of a file.
inline bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f;
}

}  // namespace taut::base
