/// Errors and warnings about an input, collected so that a user can fix a file in one pass.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace taut {

/// A place in an input file. `line` and `column` are 1-based; 0 means unknown.
struct SourceRef {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Stable identifier of a kind of message: the subject, a dot and the problem, such as
/// `cable.both_ends_fixed`. Texts may change from version to version, identifiers do not.
/// tests/messages.txt lists all of them.
class MessageId {
 public:
  /// Accepts literals only; a literal that is no identifier does not compile.
  consteval MessageId(const char* text) : text_(text) {  // NOLINT(google-explicit-constructor)
    bool has_dot = false, is_word = false;
    for (const char c : text_) {
      const bool is_letter =
          (c >= 'a' && c <= 'z') || (is_word && (c == '_' || (c >= '0' && c <= '9')));
      if (!is_letter && !(c == '.' && is_word && !has_dot)) NotAMessageIdentifier();
      has_dot = has_dot || c == '.';
      is_word = is_letter;
    }
    if (!has_dot || !is_word) NotAMessageIdentifier();
  }
  constexpr std::string_view text() const noexcept { return text_; }

 private:
  static void NotAMessageIdentifier();  ///< Never defined: a call of it does not compile.

  std::string_view text_;
};

/// One error or warning: its identifier, its place, the problem, and a hint how to fix it.
struct Diagnostic {
  SourceRef at;
  std::string what;
  std::string hint;     ///< May be empty.
  std::string_view id;  ///< Text of a MessageId.
  /// The file cannot be opened or read, so its contents are unknown, not wrong.
  bool unreadable = false;
};

/// Collects all errors and warnings about one input. No function throws, prints or exits; the
/// caller decides.
class Diagnostics {
 public:
  void Error(MessageId id, SourceRef at, std::string what, std::string hint = {});
  /// Adds an error about a file that cannot be opened or read.
  void Unreadable(MessageId id, SourceRef at, std::string what, std::string hint = {});
  /// Adds a warning: the input is valid, but probably not intended. Warnings do not change results.
  void Warning(MessageId id, SourceRef at, std::string what, std::string hint = {});
  /// Adds an error or a warning of other diagnostics, with its identifier.
  void AddError(Diagnostic error) { items_.push_back(std::move(error)); }
  void AddWarning(Diagnostic warning) { warnings_.push_back(std::move(warning)); }
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
