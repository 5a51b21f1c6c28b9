/// Lines of a text file, compressed with gzip or not.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "taut/diagnostics.h"

namespace taut::trace {

/// Meaning of text after the last line end: a line that was cut off, or the last line.
enum class CsvTail { kCutOff, kLine };

/// Passes every line, without its end, to `use`, until that returns false. Returns false and
/// reports a diagnostic if the file cannot be opened or read to its end.
bool ReadCsvLines(const std::string& path, CsvTail tail,
                  const std::function<bool(std::string_view)>& use, Diagnostics& out);

/// Returns `text` without blanks and tabs before and after it.
std::string_view Trim(std::string_view text);

}  // namespace taut::trace
