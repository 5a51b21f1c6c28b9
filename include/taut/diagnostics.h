/// Collected errors and warnings about an input, so that a user can fix a file in one pass.
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

/// Stable identifier of a kind of message, such as `cable.both_ends_fixed`: the subject, a dot and
/// the problem. Message texts may change between versions, but identifiers stay. tests/messages.txt
/// lists all of them.
class MessageId {
 public:
  /// Accepts string literals only; an invalid identifier does not compile.
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
  static void NotAMessageIdentifier();  ///< Without a definition, so that a call does not compile.

  std::string_view text_;
};

/// Error or warning: identifier, place, problem, and a hint for the fix.
struct Diagnostic {
  SourceRef at;
  std::string what;
  std::string hint;     ///< Hint for the fix; may be empty.
  std::string_view id;  ///< Text of a MessageId.
  /// The file cannot be opened or read, so its contents are unknown.
  bool unreadable = false;
};

/// Collection of all errors and warnings about one input. No function throws, prints or exits.
class Diagnostics {
 public:
  void Error(MessageId id, SourceRef at, std::string what, std::string hint = {});
  /// Adds an error about a file that cannot be opened or read.
  void Unreadable(MessageId id, SourceRef at, std::string what, std::string hint = {});
  /// Adds a warning about valid input that is probably not intended. Warnings do not change
  /// results.
  void Warning(MessageId id, SourceRef at, std::string what, std::string hint = {});
  /// Adds an error or a warning from another collection; its identifier stays.
  void AddError(Diagnostic error) { items_.push_back(std::move(error)); }
  void AddWarning(Diagnostic warning) { warnings_.push_back(std::move(warning)); }
  /// Turns all present warnings into errors (`--strict`).
  void WarningsToErrors();

  /// Returns whether there are no errors; warnings are allowed.
  bool ok() const noexcept { return items_.empty(); }
  const std::vector<Diagnostic>& items() const noexcept { return items_; }  ///< Errors.
  const std::vector<Diagnostic>& warnings() const noexcept { return warnings_; }

  /// Returns one line per error or warning, sorted by file, line and column, without duplicates:
  /// `prism.yaml:12:7: error: <what> (<hint>)`, or `warning:`.
  std::string Format() const;

 private:
  std::vector<Diagnostic> items_, warnings_;
};

/// Returns the text with control characters escaped in hexadecimal, since these could send commands
/// to a terminal. Line ends and tabs stay. Call this function before printing text from files;
/// `Diagnostics::Format` already does.
std::string Printable(std::string_view text);

/// Returns `items` sorted by file, line and column, without duplicates.
std::vector<Diagnostic> Sorted(std::vector<Diagnostic> items);

/// Returns the candidate that `word` probably misspells, or "".
std::string_view ClosestMatch(std::string_view word, const std::vector<std::string>& candidates);

/// Returns `did you mean "radius_m"?`, or a list of the candidates if none is similar.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace taut
