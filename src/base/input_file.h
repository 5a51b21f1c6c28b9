/// Reading the files that users name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "taut/diagnostics.h"

namespace taut::base {

/// Who named the file. A user may name a pipe on the command line; a file that names another means
/// a regular one, and a pipe or device there would be waited for or read without end.
enum class NamedBy { kUser, kFile };

/// All bytes of a file. Nothing, and a complaint, if it is a directory, cannot be opened or read,
/// is no regular file where a file names it, or is larger than `most_bytes`, of which no more is
/// read; `hint` says what to do about that.
std::optional<std::string> ReadInputFile(const std::string& path, std::size_t most_bytes,
                                         const std::string& hint, Diagnostics& out,
                                         NamedBy named_by = NamedBy::kFile);

/// What is in no text of an input: it cuts a path short (NUL), or makes a terminal show what is not
/// there (ESC). To yaml-cpp the byte 4 is the end of a file.
inline bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f;
}

}  // namespace taut::base
