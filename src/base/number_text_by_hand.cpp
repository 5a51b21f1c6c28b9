// Conversion of numbers by strtod and snprintf in the C locale. Both functions round to nearest in
// glibc and musl.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/number_text.h"

namespace taut::base {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

bool Follows(const char* at, const char* end, const char* word) {
  for (; *word != '\0'; ++word, ++at) {
    if (at == end || (*at | 0x20) != *word) return false;
  }
  return true;
}

/// Returns the end of the number that begins at `begin`, or `begin` if there is no number.
const char* EndOfNumber(const char* begin, const char* end) {
  const char* at = begin;
  if (at != end && *at == '-') ++at;
  if (Follows(at, end, "infinity")) return at + 8;
  if (Follows(at, end, "inf")) return at + 3;
  if (Follows(at, end, "nan")) {
    at += 3;
    // Accepts nan(...) with any letters, digits or underscores.
    if (at == end || *at != '(') return at;
    const char* close = at + 1;
    while (close != end && (IsDigit(*close) || *close == '_' ||
                            ((*close | 0x20) >= 'a' && (*close | 0x20) <= 'z'))) {
      ++close;
    }
    return close != end && *close == ')' ? close + 1 : at;
  }
  bool any = false;
  const auto digits = [&] {
    for (; at != end && IsDigit(*at); ++at) any = true;
  };
  digits();
  if (at != end && *at == '.') {
    ++at;
    digits();
  }
  if (!any) return begin;
  if (at == end || (*at | 0x20) != 'e') return at;
  const char* exponent = at + 1;
  if (exponent != end && (*exponent == '-' || *exponent == '+')) ++exponent;
  if (exponent == end || !IsDigit(*exponent)) return at;
  while (exponent != end && IsDigit(*exponent)) ++exponent;
  return exponent;
}

std::to_chars_result Put(char* begin, char* end, const char* text, std::size_t size) {
  if (size > static_cast<std::size_t>(end - begin)) return {end, std::errc::value_too_large};
  return {std::copy_n(text, size, begin), {}};
}

/// Returns d.ddde+dd with the fewest digits that identify `number`, which must be finite and >= 0.
std::string ShortestScientific(double number) {
  char text[40];
  const auto means = [&] { return std::strtod(text, nullptr) == number; };
  for (int places = 0;; ++places) {
    std::snprintf(text, sizeof text, "%.*e", places, number);
    if (places == 16 || means()) return text;
    // Below a power of two, adjacent numbers are closer than above it. The nearest decimal may then
    // belong to another number, while the next larger decimal identifies this number.
    int exponent = 0;
    if (std::frexp(number, &exponent) != 0.5) continue;
    char* last = std::strchr(text, 'e') - 1;
    while (last > text && (*last == '9' || *last == '.')) {
      if (*last == '9') *last = '0';
      --last;
    }
    if (*last == '9') continue;
    ++*last;
    if (means()) return text;
  }
}

}  // namespace

std::from_chars_result FromChars(const char* begin, const char* end, double& number) noexcept {
  const char* const stop = EndOfNumber(begin, end);
  if (stop == begin) return {begin, std::errc::invalid_argument};
  const double value = std::strtod(std::string(begin, stop).c_str(), nullptr);
  const bool names_no_number = std::none_of(begin, stop, IsDigit);
  if (std::isinf(value) && !names_no_number) return {stop, std::errc::result_out_of_range};
  if (value == 0) {
    const char* const exponent =
        std::find_if(begin, stop, [](char c) { return (c | 0x20) == 'e'; });
    // The number is not zero, but below the smallest double.
    if (std::any_of(begin, exponent, [](char c) { return c >= '1' && c <= '9'; })) {
      return {stop, std::errc::result_out_of_range};
    }
  }
  number = value;
  return {stop, {}};
}

std::to_chars_result ToChars(char* begin, char* end, double number) noexcept {
  std::string text = std::signbit(number) ? "-" : "";
  if (!std::isfinite(number)) {
    text += std::isnan(number) ? "nan" : "inf";
    return Put(begin, end, text.data(), text.size());
  }
  const std::string scientific = ShortestScientific(std::fabs(number));
  const std::size_t e = scientific.find('e');
  std::string digits(1, scientific[0]);
  if (e > 2) digits.append(scientific, 2, e - 2);
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  const int count = static_cast<int>(digits.size());
  // Without an exponent, unless that is longer.
  std::string plain;
  if (exponent >= count - 1) {
    char whole[400];
    std::snprintf(whole, sizeof whole, "%.0f", std::fabs(number));
    plain = whole;
  } else if (exponent >= 0) {
    plain = digits.substr(0, static_cast<std::size_t>(exponent) + 1) + "." +
            digits.substr(static_cast<std::size_t>(exponent) + 1);
  } else {
    plain = "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  }
  text += plain.size() <= scientific.size() ? plain : scientific;
  return Put(begin, end, text.data(), text.size());
}

std::to_chars_result ToChars(char* begin, char* end, double number, int digits) noexcept {
  char text[40];
  const int size = std::snprintf(text, sizeof text, "%.*g", digits, number);
  return Put(begin, end, text, static_cast<std::size_t>(size));
}

}  // namespace taut::base
