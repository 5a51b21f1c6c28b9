#include "trace/text_encoding.h"

#include <array>
#include <utility>

namespace taut::trace {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";
constexpr char32_t kReplacement = 0xFFFD;

/// Windows-1252, bytes 0x80 to 0x9F; others equal their code point. 0: not assigned.
constexpr std::array<char16_t, 32> kWindows1252 = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

void AppendCodePoint(char32_t point, std::string& text) {
  const auto byte = [&](char32_t value) { text += static_cast<char>(value); };
  if (point < 0x80) {
    byte(point);
  } else if (point < 0x800) {
    byte(0xC0 | point >> 6);
    byte(0x80 | (point & 0x3F));
  } else if (point < 0x10000) {
    byte(0xE0 | point >> 12);
    byte(0x80 | (point >> 6 & 0x3F));
    byte(0x80 | (point & 0x3F));
  } else {
    byte(0xF0 | point >> 18);
    byte(0x80 | (point >> 12 & 0x3F));
    byte(0x80 | (point >> 6 & 0x3F));
    byte(0x80 | (point & 0x3F));
  }
}

char32_t FromWindows1252(char byte) {
  const auto value = static_cast<unsigned char>(byte);
  if (value < 0x80 || value > 0x9F) return value;
  const char16_t point = kWindows1252[value - 0x80u];
  return point == 0 ? kReplacement : point;
}

}  // namespace

void ToUtf8::Append(std::string_view block, std::string& text) {
  if (form_ == Form::kUnknown) {
    rest_ += block;
    if (rest_.size() < kUtf8Mark.size() && !block.empty()) return;
    const std::string first = std::exchange(rest_, {});
    form_ = first.starts_with("\xFF\xFE")   ? Form::kLittle
            : first.starts_with("\xFE\xFF") ? Form::kBig
                                            : Form::kBytes;
    const std::size_t mark = form_ != Form::kBytes          ? 2
                             : first.starts_with(kUtf8Mark) ? kUtf8Mark.size()
                                                            : 0;
    if (mark == kUtf8Mark.size()) encoding_ = TextEncoding::kUtf8;
    return Append(std::string_view(first).substr(mark), text);
  }
  if (form_ != Form::kBytes) return Utf16(block, text);
  if (encoding_ == TextEncoding::kUtf8) {
    text += block;
    return;
  }
  for (const char byte : block) AppendCodePoint(FromWindows1252(byte), text);
}

void ToUtf8::Utf16(std::string_view bytes, std::string& text) {
  std::string whole = std::exchange(rest_, {});
  whole += bytes;
  std::size_t at = 0;
  for (; at + 1 < whole.size(); at += 2) {
    const auto low = static_cast<unsigned char>(whole[at + (form_ == Form::kLittle ? 0 : 1)]);
    const auto high = static_cast<unsigned char>(whole[at + (form_ == Form::kLittle ? 1 : 0)]);
    const char32_t unit = static_cast<char32_t>(high) << 8 | low;
    if (high_ != 0 && unit >= 0xDC00 && unit < 0xE000) {
      AppendCodePoint(0x10000 + ((high_ - 0xD800) << 10) + (unit - 0xDC00), text);
      high_ = 0;
      continue;
    }
    if (high_ != 0) AppendCodePoint(kReplacement, text);
    high_ = unit >= 0xD800 && unit < 0xDC00 ? unit : 0;
    if (high_ != 0) continue;
    AppendCodePoint(unit >= 0xDC00 && unit < 0xE000 ? kReplacement : unit, text);
  }
  rest_ = whole.substr(at);
}

bool IsUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xC2 && first < 0xE0 ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    if (length == 0 || at + length > text.size()) return false;
    char32_t point = length == 1 ? first : first & (0x7Fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
      const auto next = static_cast<unsigned char>(text[at + i]);
      if ((next & 0xC0) != 0x80) return false;
      point = point << 6 | (next & 0x3F);
    }
    const bool overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
    if (overlong || (point >= 0xD800 && point < 0xE000) || point > 0x10FFFF) return false;
    at += length;
  }
  return true;
}

}  // namespace taut::trace
