/// Input files named by users or by other files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "taut/diagnostics.h"

namespace taut::base {

/// Origin of a path. Users may pass a pipe on the command line. Paths inside files must be regular
/// files: reading a pipe or device could block or never end.
enum class NamedBy { kUser, kFile };

/// Returns all bytes of a file. Returns nothing and reports a diagnostic if it is a directory,
/// cannot be read, is not a regular file (NamedBy::kFile), or is larger than `most_bytes`; then
/// reading stops there. `hint` is the hint of the size diagnostic.
std::optional<std::string> ReadInputFile(const std::string& path, std::size_t most_bytes,
                                         const std::string& hint, Diagnostics& out,
                                         NamedBy named_by = NamedBy::kFile);

/// Returns true for characters that texts of an input must not contain: they truncate a path (NUL),
/// or let a terminal display false content (ESC). yaml-cpp takes byte 4 for the end of a file.
inline bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f;
}

}  // namespace taut::base
