/// Lines of a text file, with or without gzip compression.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Meaning of text after the last line end: an incomplete line, or the last line.
enum class CsvTail { kCutOff, kLine };

/// Passes each line, as UTF-8 and without its line end, to `use` until it returns false. Returns
/// false and reports an error if the file cannot be opened or read to its end.
bool ReadCsvLines(const std::string& path, CsvTail tail,
                  const std::function<bool(std::string_view)>& use, Diagnostics& out,
                  TextEncoding encoding = TextEncoding::kUtf8);

/// Removes blanks and tabs at both ends of `text`.
std::string_view Trim(std::string_view text);

}  // namespace taut::trace
