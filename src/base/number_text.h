/// Conversion between numbers and text like std::from_chars and std::to_chars. These functions also
/// work with standard libraries that support integers only (libc++ of emscripten 3.1.6).
/// number_text.cpp forwards to the library; number_text_by_hand.cpp replaces the library. The
/// results of both files are identical in every bit and character.
#pragma once

#include <charconv>
#include <type_traits>

namespace taut::base {

/// Parses the number at the beginning of a text, rounded to nearest. The text must not begin with
/// blanks or a plus sign. If the number is out of range, `number` stays unchanged.
std::from_chars_result FromChars(const char* begin, const char* end, double& number) noexcept;
template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
std::from_chars_result FromChars(const char* begin, const char* end, Integer& number) noexcept {
  return std::from_chars(begin, end, number);
}

/// Writes the shortest text that `FromChars` reads as the same number.
std::to_chars_result ToChars(char* begin, char* end, double number) noexcept;
/// Writes `digits` digits, at most 17, like printf with %g.
std::to_chars_result ToChars(char* begin, char* end, double number, int digits) noexcept;

}  // namespace taut::base
