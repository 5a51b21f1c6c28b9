/// Complaints about an input, collected so that a user fixes a file in one go.
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

/// One complaint: where, what is wrong, and what to do about it.
struct Diagnostic {
  SourceRef at;
  std::string what;
  std::string hint;  ///< May be empty.
  /// The system does not open or read a file: its contents are unknown, not wrong.
  bool unreadable = false;
};

/// Collects every complaint about one input. Nothing here throws, prints or exits: the caller
/// decides.
class Diagnostics {
 public:
  void Error(SourceRef at, std::string what, std::string hint = {});
  /// An error about a file that the system does not open or read.
  void Unreadable(SourceRef at, std::string what, std::string hint = {});
  /// What can be used, but is hardly meant. No function returns less because of one.
  void Warning(SourceRef at, std::string what, std::string hint = {});
  /// For those who want no warnings: makes errors of all so far.
  void WarningsToErrors();

  bool ok() const noexcept { return items_.empty(); }  ///< No errors; maybe warnings.
  const std::vector<Diagnostic>& items() const noexcept { return items_; }  ///< The errors.
  const std::vector<Diagnostic>& warnings() const noexcept { return warnings_; }

  /// One line each, sorted by file, line and column, without repetitions:
  /// `prism.yaml:12:7: error: <what> (<hint>)`, or `warning:`.
  std::string Format() const;

 private:
  std::vector<Diagnostic> items_, warnings_;
};

/// Escapes control characters, which could send commands to a terminal, in hexadecimal. Keeps line
/// ends and tabs. Use it for all printed text from files; `Diagnostics::Format` already does.
std::string Printable(std::string_view text);

/// By file, line and column, without repetitions: in the order of `Diagnostics::Format`.
std::vector<Diagnostic> Sorted(std::vector<Diagnostic> items);

/// The candidate closest to `word` if it is close enough to be a likely misspelling, else empty.
std::string_view ClosestMatch(std::string_view word, const std::vector<std::string>& candidates);

/// `did you mean "radius_m"?`, or the list of all candidates if none is close.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace taut
