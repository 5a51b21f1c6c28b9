/// The lines of a text, compressed with gzip or not.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "taut/diagnostics.h"

namespace taut::trace {

/// What follows the last line end: a line that was cut off, or the last one.
enum class CsvTail { kCutOff, kLine };

/// Hands every line to `use`, without its end, until that is false. False, with a diagnostic, if
/// the file cannot be opened or read to its end.
bool ReadCsvLines(const std::string& path, CsvTail tail,
                  const std::function<bool(std::string_view)>& use, Diagnostics& out);

/// Without blanks before and after.
std::string_view Trim(std::string_view text);

}  // namespace taut::trace
