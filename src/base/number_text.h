/// Numbers from text and back as std::from_chars and std::to_chars do it, also where the standard
/// library has those of whole numbers only (the libc++ of emscripten 3.1.6): number_text.cpp passes
/// them on, number_text_by_hand.cpp does without. The same results to the last bit and character.
#pragma once

#include <charconv>
#include <type_traits>

namespace taut::base {

/// The number that the text begins with, rounded to nearest. No blanks and no plus sign before it.
/// Out of range: `number` stays.
std::from_chars_result FromChars(const char* begin, const char* end, double& number) noexcept;
template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
std::from_chars_result FromChars(const char* begin, const char* end, Integer& number) noexcept {
  return std::from_chars(begin, end, number);
}

/// The shortest text that `FromChars` makes the same number of.
std::to_chars_result ToChars(char* begin, char* end, double number) noexcept;
/// So many digits, at most 17, as printf's %g.
std::to_chars_result ToChars(char* begin, char* end, double number, int digits) noexcept;

}  // namespace taut::base
