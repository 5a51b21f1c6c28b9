#include "description/yaml/write_keys.h"

#include <iterator>
#include <string_view>

namespace taut::description {

std::string Quoted(const std::string& text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\x";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  out += '"';
  return out;
}

std::string PlainOrQuoted(const std::string& text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const bool plain =
      !text.empty() && is_letter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '.';
      });
  std::string word = text;
  for (char& c : word) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
  constexpr std::string_view kWordsOfYaml[] = {"null", "true", "false", "yes", "no",
                                               "on",   "off",  "y",     "n"};
  const bool has_meaning =
      std::find(std::begin(kWordsOfYaml), std::end(kWordsOfYaml), word) != std::end(kWordsOfYaml);
  return plain && !has_meaning ? text : Quoted(text);
}

}  // namespace taut::description
