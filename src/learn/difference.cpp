#include "learn/difference.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace taut::learn {
namespace {

constexpr std::size_t kMostLines = 20, kWidth = 100;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Returns a line, cut to `kWidth` characters around position `at` if it is longer.
std::string Shortened(const std::string& line, std::size_t at) {
  if (line.size() <= kWidth) return line;
  const std::size_t from = at < kWidth / 2 ? 0 : std::min(at - kWidth / 2, line.size() - kWidth);
  return (from > 0 ? "... " : "") + line.substr(from, kWidth) +
         (from + kWidth < line.size() ? " ..." : "");
}

}  // namespace

std::string Difference(const std::string& old_text, const std::string& new_text) {
  const auto a = Lines(old_text), b = Lines(new_text);
  // Longest common subsequence, computed from the end.
  std::vector<std::vector<std::size_t>> common(a.size() + 1,
                                               std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = a.size(); i-- > 0;) {
    for (std::size_t j = b.size(); j-- > 0;) {
      common[i][j] =
          a[i] == b[j] ? common[i + 1][j + 1] + 1 : std::max(common[i + 1][j], common[i][j + 1]);
    }
  }
  std::string out;
  std::size_t shown = 0, i = 0, j = 0;
  const auto show = [&](char sign, const std::string& line, std::size_t at) {
    if (shown < kMostLines) out += std::string("  ") + sign + " " + Shortened(line, at) + "\n";
    if (shown++ == kMostLines) out += "  ...\n";
  };
  while (i < a.size() || j < b.size()) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      ++i, ++j;
    } else if (i < a.size() && (j == b.size() || common[i + 1][j] >= common[i][j + 1])) {
      // cut changed lines around their first difference
      const std::string& other = j < b.size() ? b[j] : std::string();
      const auto at = std::mismatch(a[i].begin(), a[i].end(), other.begin(), other.end()).first;
      const auto where = static_cast<std::size_t>(at - a[i].begin());
      show('-', a[i++], where);
      if (j < b.size() && where > 3 && (i == a.size() || a[i] != b[j])) show('+', b[j++], where);
    } else {
      show('+', b[j++], 0);
    }
  }
  if (!out.empty()) out.pop_back();
  return out;
}

}  // namespace taut::learn
