#include "base/number_text.h"

namespace taut::base {

std::from_chars_result FromChars(const char* begin, const char* end, double& number) noexcept {
  return std::from_chars(begin, end, number);
}

std::to_chars_result ToChars(char* begin, char* end, double number) noexcept {
  return std::to_chars(begin, end, number);
}

std::to_chars_result ToChars(char* begin, char* end, double number, int digits) noexcept {
  return std::to_chars(begin, end, number, std::chars_format::general, digits);
}

}  // namespace taut::base
