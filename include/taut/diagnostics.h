/// Errors and warnings about an input, collected so that a user can fix a file in one pass.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace taut {

/// A place in an input file. `line` and `column` are 1-based; 0 means unknown.
struct SourceRef {
  std::string file;
  int line = 0;
  int column = 0;
};

/// One error or warning: its place, the problem, and a hint how to fix it.
struct Diagnostic {
  SourceRef at;
  std::string what;
  std::string hint;  ///< May be empty.
  /// The file cannot be opened or read, so its contents are unknown, not wrong.
  bool unreadable = false;
};

/// Collects all errors and warnings about one input. No function throws, prints or exits; the
/// caller decides.
class Diagnostics {
 public:
  void Error(SourceRef at, std::string what, std::string hint = {});
  /// Adds an error about a file that cannot be opened or read.
  void Unreadable(SourceRef at, std::string what, std::string hint = {});
  /// Adds a warning: the input is valid, but probably not intended. Warnings do not change results.
  void Warning(SourceRef at, std::string what, std::string hint = {});
  /// Turns all warnings so far into errors (`--strict`).
  void WarningsToErrors();

  bool ok() const noexcept { return items_.empty(); }  ///< No errors; there may be warnings.
  const std::vector<Diagnostic>& items() const noexcept { return items_; }  ///< The errors.
  const std::vector<Diagnostic>& warnings() const noexcept { return warnings_; }

  /// Returns one line per error or warning, sorted by file, line and column, without duplicates:
  /// `prism.yaml:12:7: error: <what> (<hint>)`, or `warning:`.
  std::string Format() const;

 private:
  std::vector<Diagnostic> items_, warnings_;
};

/// Escapes control characters, which could send commands to a terminal, in hexadecimal. Keeps line
/// ends and tabs. Use it for all printed text from files; `Diagnostics::Format` already does.
std::string Printable(std::string_view text);

/// Returns `items` by file, line and column, without duplicates, as `Diagnostics::Format` does.
std::vector<Diagnostic> Sorted(std::vector<Diagnostic> items);

/// Returns the candidate closest to `word` if `word` is a likely misspelling of it, else "".
std::string_view ClosestMatch(std::string_view word, const std::vector<std::string>& candidates);

/// Returns `did you mean "radius_m"?`, or a list of the candidates if none is close.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace taut
