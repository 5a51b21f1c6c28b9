#include "taut/diagnostics.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace taut {
namespace {

/// Returns the edit distance: insertions, deletions, substitutions and swaps of neighboring letters
/// cost one each (optimal string alignment).
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

namespace {

auto Key(const Diagnostic& d) {
  return std::tie(d.at.file, d.at.line, d.at.column, d.what, d.hint, d.id);
}

std::string Line(const Diagnostic& d, std::string_view kind) {
  std::string out;
  if (!d.at.file.empty()) out += d.at.file + ":";
  if (d.at.line > 0) out += std::to_string(d.at.line) + ":";
  if (d.at.line > 0 && d.at.column > 0) out += std::to_string(d.at.column) + ":";
  if (!out.empty()) out += ' ';
  out += std::string(kind) + ": " + d.what;
  if (!d.hint.empty()) out += " (" + d.hint + ")";
  return Printable(out) + '\n';
}

/// Leaves out the middle of a text that quotes megabytes of a file.
std::string Shortened(std::string text) {
  constexpr std::size_t kMostBytes = 4000, kLastBytes = 1000;
  if (text.size() <= kMostBytes) return text;
  // Returns whether byte i continues a UTF-8 character.
  const auto continues = [&](std::size_t i) { return (text[i] & 0xc0) == 0x80; };
  std::size_t from = kMostBytes - kLastBytes, to = text.size() - kLastBytes;
  while (from > 0 && continues(from)) --from;
  while (to < text.size() && continues(to)) ++to;
  return text.substr(0, from) + " ... " + text.substr(to);
}

/// Returns the code point of a mark of the text direction at the beginning of UTF-8 text; 0 if
/// there is none. Such a mark shows the rest of a line reversed, so that a name looks like another
/// one.
unsigned DirectionMark(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  unsigned code = 0;
  if (byte(0) == 0xd8) code = (byte(0) & 0x1f) << 6 | (byte(1) & 0x3f);
  if (byte(0) == 0xe2) {
    code = (byte(0) & 0x0f) << 12 | (byte(1) & 0x3f) << 6 | (byte(2) & 0x3f);
  }
  const bool marks = code == 0x061c || code == 0x200e || code == 0x200f ||
                     (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return marks ? code : 0;
}

}  // namespace

std::string Printable(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool is_plain = (byte >= 0x20 && byte != 0x7f) || byte == '\n' || byte == '\t';
    // U+0080 to U+009F: C1 controls, which terminals interpret as ESC and a letter.
    const bool begins_c1 = byte == 0xc2 && i + 1 < text.size() &&
                           (static_cast<unsigned char>(text[i + 1]) & 0xe0) == 0x80;
    if (is_plain && !begins_c1) {
      if (const unsigned mark = DirectionMark(text.substr(i)); mark != 0) {
        out += "\\u";
        for (int shift = 12; shift >= 0; shift -= 4) out += kDigits[mark >> shift & 15];
        i += mark < 0x800 ? 1 : 2;  // skips the remaining bytes
        continue;
      }
      out += text[i];
      continue;
    }
    const unsigned code = begins_c1 ? static_cast<unsigned char>(text[++i]) : byte;
    out += {'\\', 'x', kDigits[code >> 4], kDigits[code & 15]};
  }
  return out;
}

void Diagnostics::Error(MessageId id, SourceRef at, std::string what, std::string hint) {
  AddError({std::move(at), Shortened(std::move(what)), Shortened(std::move(hint)), id.text()});
}

void Diagnostics::Unreadable(MessageId id, SourceRef at, std::string what, std::string hint) {
  Error(id, std::move(at), std::move(what), std::move(hint));
  items_.back().unreadable = true;
}

void Diagnostics::Warning(MessageId id, SourceRef at, std::string what, std::string hint) {
  AddWarning({std::move(at), Shortened(std::move(what)), Shortened(std::move(hint)), id.text()});
}

void Diagnostics::WarningsToErrors() {
  items_.insert(items_.end(), warnings_.begin(), warnings_.end());
  warnings_.clear();
}

std::vector<Diagnostic> Sorted(std::vector<Diagnostic> items) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return Key(a) < Key(b); });
  items.erase(
      std::unique(items.begin(), items.end(),
                  [](const Diagnostic& a, const Diagnostic& b) { return Key(a) == Key(b); }),
      items.end());
  return items;
}

std::string Diagnostics::Format() const {
  const std::vector<Diagnostic> errors = Sorted(items_), warnings = Sorted(warnings_);
  std::string out;
  auto warning = warnings.begin();
  for (const Diagnostic& error : errors) {
    for (; warning != warnings.end() && Key(*warning) < Key(error); ++warning) {
      out += Line(*warning, "warning");
    }
    out += Line(error, "error");
  }
  for (; warning != warnings.end(); ++warning) out += Line(*warning, "warning");
  return out;
}

std::string_view ClosestMatch(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongest = 100;  // longest name; longer words are not misspellings
  std::string_view best;
  if (word.size() > kLongest) return best;
  // At most a third of the letters may differ.
  int best_distance = static_cast<int>(word.size()) / 3 + 1;
  for (const std::string& candidate : candidates) {
    const auto longer =
        static_cast<std::ptrdiff_t>(candidate.size()) - static_cast<std::ptrdiff_t>(word.size());
    // Skip candidates with a very different length.
    if (longer > best_distance || -longer > best_distance) continue;
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
  // Up to 14 names are listed in full, since omitting one or two would save little.
  constexpr std::size_t kMostNamed = 12, kMost = 14;
  const std::size_t named = candidates.size() <= kMost ? candidates.size() : kMostNamed;
  std::string out = "one of:";
  for (std::size_t i = 0; i < named; ++i) out += (i == 0 ? " " : ", ") + candidates[i];
  if (named < candidates.size()) out += ", ...";
  return out;
}

}  // namespace taut
