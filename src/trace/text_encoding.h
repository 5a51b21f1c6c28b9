/// Conversion of the text encodings of measurement programs to UTF-8.
#pragma once

#include <string>
#include <string_view>

#include "taut/trace.h"

namespace taut::trace {

/// Converts a file, block by block. UTF-16 is recognized by its byte order mark, which Windows
/// programs write; the mark of UTF-8 is removed.
class ToUtf8 {
 public:
  explicit ToUtf8(TextEncoding encoding) : encoding_(encoding) {}

  /// Appends the converted block to `text`. Bytes of a character that continues in the next block
  /// are kept until then. Unpaired surrogates become U+FFFD.
  void Append(std::string_view block, std::string& text);

 private:
  enum class Form { kUnknown, kBytes, kLittle, kBig };
  void Utf16(std::string_view bytes, std::string& text);

  TextEncoding encoding_;
  Form form_ = Form::kUnknown;
  std::string rest_;   ///< Bytes of an incomplete unit or byte order mark.
  char32_t high_ = 0;  ///< High surrogate before its low surrogate arrives.
};

/// Returns whether a text is valid UTF-8.
bool IsUtf8(std::string_view text);

}  // namespace taut::trace
