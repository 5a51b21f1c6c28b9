#include "taut/diagnostics.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace taut {
namespace {

/// Edit distance: insertions, deletions, substitutions and swaps of neighbours cost one each
/// (optimal string alignment).
int EditDistance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

}  // namespace

void Diagnostics::Error(SourceRef at, std::string what, std::string hint) {
  items_.push_back({std::move(at), std::move(what), std::move(hint)});
}

std::string Diagnostics::Format() const {
  const auto key = [](const Diagnostic& d) {
    return std::tie(d.at.file, d.at.line, d.at.column, d.what, d.hint);
  };
  std::vector<Diagnostic> sorted = items_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return key(a) < key(b); });
  sorted.erase(
      std::unique(sorted.begin(), sorted.end(),
                  [&](const Diagnostic& a, const Diagnostic& b) { return key(a) == key(b); }),
      sorted.end());
  std::string out;
  for (const Diagnostic& d : sorted) {
    if (!d.at.file.empty()) out += d.at.file + ":";
    if (d.at.line > 0) out += std::to_string(d.at.line) + ":";
    if (d.at.line > 0 && d.at.column > 0) out += std::to_string(d.at.column) + ":";
    if (!out.empty() && out.back() == ':') out += ' ';
    out += "error: " + d.what;
    if (!d.hint.empty()) out += " (" + d.hint + ")";
    out += '\n';
  }
  return out;
}

std::string_view ClosestMatch(std::string_view word, const std::vector<std::string>& candidates) {
  std::string_view best;
  int best_distance = static_cast<int>(word.size()) / 3 + 1;  // a third of the letters may differ
  for (const std::string& candidate : candidates) {
    const int distance = EditDistance(word, candidate);
    if (distance <= best_distance && (best.empty() || distance < best_distance)) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string DidYouMean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string_view best = ClosestMatch(word, candidates);
  if (!best.empty()) return "did you mean \"" + std::string(best) + "\"?";
  if (candidates.empty()) return {};
  std::string out = "one of:";
  for (std::size_t i = 0; i < candidates.size() && i < 12; ++i) {
    out += (i == 0 ? " " : ", ") + candidates[i];
  }
  if (candidates.size() > 12) out += ", ...";
  return out;
}

}  // namespace taut
