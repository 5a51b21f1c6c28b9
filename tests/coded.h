/// Diagnostics as place, identifier and values, without their sentences, so that tests do not
/// depend on wording.
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::test {

/// Returns the values of a message in their order: texts in quotation marks, numbers, and names
/// that contain an underscore, a dot or a digit, such as `rod.radius_m`. A value equal to the
/// previous one is left out.
inline std::vector<std::string> ValuesOf(std::string_view text) {
  std::vector<std::string> values;
  const auto add = [&](std::string value) {
    if (values.empty() || values.back() != value) values.push_back(std::move(value));
  };
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_.-+*/%").find(c) != std::string_view::npos;
  };
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '"') {
      const std::size_t end = text.find('"', i + 1);
      add(std::string(text.substr(i, end == std::string_view::npos ? end : end + 1 - i)));
      i = end == std::string_view::npos ? text.size() : end + 1;
    } else if (is_word(text[i])) {
      std::size_t end = i;
      bool is_value = false;
      for (; end < text.size() && is_word(text[end]); ++end) {
        const bool inside = end > i && end + 1 < text.size() && is_word(text[end + 1]);
        is_value = is_value || std::isdigit(static_cast<unsigned char>(text[end])) != 0 ||
                   text[end] == '_' || (text[end] == '.' && inside);
      }
      std::size_t last = end;
      while (last > i && (text[last - 1] == '.' || text[last - 1] == '-')) --last;
      if (is_value) add(std::string(text.substr(i, last - i)));
      i = end;
    } else {
      ++i;
    }
  }
  return values;
}

/// Returns `robot.yaml:6:30: error: key.unknown "radius" rod`, without the hint.
inline std::string Coded(const Diagnostic& d, std::string_view kind) {
  std::string out = d.at.file.empty() ? "" : d.at.file + ":";
  if (d.at.line > 0) out += std::to_string(d.at.line) + ":" + std::to_string(d.at.column) + ":";
  out += (out.empty() ? "" : " ") + std::string(kind) + ": " + std::string(d.id);
  for (const std::string& value : ValuesOf(d.what)) out += " " + value;
  return out + "\n";
}

/// Returns the errors in the format of `Coded`, one per line, in the order of
/// `Diagnostics::Format`.
inline std::string CodedErrors(const Diagnostics& found) {
  std::string out;
  for (const Diagnostic& d : Sorted(found.items())) out += Coded(d, "error");
  return out;
}

/// Returns the errors, then the warnings.
inline std::string CodedAll(const Diagnostics& found) {
  std::string out = CodedErrors(found);
  for (const Diagnostic& d : Sorted(found.warnings())) out += Coded(d, "warning");
  return out;
}

}  // namespace taut::test
