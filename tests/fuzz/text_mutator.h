/// Mutations of text files by lines, words and numbers, for libFuzzer's custom mutator.
///
/// libFuzzer mutates bytes, which breaks nearly every XML or YAML file. Targets that read text
/// include text_input.h.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include "fuzz/damage.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace taut::fuzz {

class TextMutation {
 public:
  explicit TextMutation(unsigned seed) : random_(seed) {}

  /// Replaces a number by a number at the edge of a range, or a word by another word of the text.
  void ReplaceWord(std::string& text) {
    static const char* const kEdges[] = {
        "0",    "-0",         "1",      "-1",    "2",      "0.5",   "1e-9",
        "1e9",  "1e12",       "1e-320", "1e308", "-1e308", "nan",   "inf",
        "-inf", "2147483648", "255",    "65536", "0 0 0",  "1 0 0", "[0, 0, 0]"};
    const auto [begin, end] = Word(text, Below(text.size()));
    if (begin == end) return;
    const bool number = std::isdigit(static_cast<unsigned char>(text[begin])) != 0;
    std::string other;
    if (number && Below(3) != 0) {
      other = kEdges[Below(std::size(kEdges))];
    } else {
      const auto [from, to] = Word(text, Below(text.size()));
      other = text.substr(from, to - from);
    }
    text.replace(begin, end - begin, other);
  }

  /// Copies or moves some lines.
  void CopyLines(std::string& text) {
    const std::size_t begin = LineAt(text, Below(text.size()));
    std::size_t end = begin;
    for (std::size_t i = Below(4) + 1; i > 0 && end < text.size(); --i) {
      end = std::min(text.find('\n', end), text.size() - 1) + 1;
    }
    const std::string lines = text.substr(begin, end - begin);
    if (Below(3) == 0) text.erase(begin, end - begin);
    if (Below(3) != 0) text.insert(LineAt(text, Below(text.size() + 1)), lines);
  }

 private:
  std::size_t Below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  static bool InWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-';
  }
  /// Returns the bounds of the first word at or after `at`.
  static std::pair<std::size_t, std::size_t> Word(const std::string& text, std::size_t at) {
    while (at > 0 && InWord(text[at - 1])) --at;
    while (at < text.size() && !InWord(text[at])) ++at;
    std::size_t end = at;
    while (end < text.size() && InWord(text[end])) ++end;
    return {at, end};
  }
  static std::size_t LineAt(const std::string& text, std::size_t at) {
    if (at == 0) return 0;
    const std::size_t before = text.rfind('\n', at - 1);
    return before == std::string::npos ? 0 : before + 1;
  }

  std::mt19937 random_;
};

/// Mutates a text in place and returns its new size, at most `max_size`.
inline std::size_t MutateText(std::uint8_t* data, std::size_t size, std::size_t max_size,
                              unsigned seed) {
  if (size == 0 || seed % 4 == 0) return LLVMFuzzerMutate(data, size, max_size);
  std::string text(reinterpret_cast<const char*>(data), size);
  TextMutation mutation(seed);
  if (seed % 4 == 1) {
    text = test::Damage(seed).To(std::move(text));
  } else if (seed % 4 == 2) {
    mutation.ReplaceWord(text);
  } else {
    mutation.CopyLines(text);
  }
  const std::size_t kept = std::min(text.size(), max_size);
  std::memcpy(data, text.data(), kept);
  return kept;
}

}  // namespace taut::fuzz
