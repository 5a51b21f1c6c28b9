/// Strict access to a YAML tree: every key is either known or an error, every value has the
/// expected type and range. All functions report errors to `Scope::out` and continue, so that a
/// user sees all errors of a file at once. After an error they return a harmless value (NaN, an
/// empty text); later checks ignore NaN.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "description/yaml/expression.h"
#include "description/yaml/yaml_tree.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"
#include "taut/types.h"

namespace taut::description {

/// Valid alternative of keys with several names (`Spellings` in keys.h).
struct Spelling {
  int index = 0;         ///< -1: unknown because of an error; any name is accepted.
  const char* who = "";  ///< Subject of messages: "a gait that drives rest lengths".
};

/// Context of all reading functions: parameters for expressions, destination of errors, optionally
/// the set of parameters that were used, and the valid alternative names of keys.
struct Scope {
  const NameTable& names;
  Diagnostics& out;
  NameSet* used = nullptr;
  Spelling spelling{};
};

/// Range of a number, in addition to finite: least..most.
struct Bound {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false, below_most = false;  ///< Open interval at this end.
  const char* least_text = nullptr;              ///< `least` as people write it.
  const char* most_text = nullptr;               ///< `most` as people write it.
  const char* hint = "";                         ///< For numbers out of range.

  static const Bound kAny, kPositive, kNonNegative, kFraction;
};
inline constexpr Bound Bound::kAny{};
inline constexpr Bound Bound::kPositive{.least = 0.0, .above_least = true};
inline constexpr Bound Bound::kNonNegative{.least = 0.0};
inline constexpr Bound Bound::kFraction{.least = 0.0, .most = 1.0};

// In all of these functions, `what` names the value in messages: "rod.radius_m must be positive,
// got -1".

double ReadNumber(const Value& value, std::string_view what, const Bound& bound,
                  const Scope& scope);
std::optional<int> ReadInteger(const Value& value, std::string_view what, int least, int most,
                               const Scope& scope);
std::optional<bool> ReadBool(const Value& value, std::string_view what, const Scope& scope);
/// Reads [x, y, z]. The components are NaN after an error.
Vec3 ReadVec3(const Value& value, std::string_view what, const Scope& scope);
/// Reads a vector that must not be zero; returns it with length 1.
Vec3 ReadDirection(const Value& value, std::string_view what, const Scope& scope);
/// Reads `count` numbers; returns nothing after an error.
std::optional<std::vector<double>> ReadNumbers(const Value& value, std::string_view what,
                                               std::size_t count, const Scope& scope);
/// Reads one rotation `{axis: z, angle_rad: pi / 2}` (axis also [x, y, z]) or `{quaternion: [w, x,
/// y, z]}`, or a list of rotations, applied in order about the fixed axes of W.
Quat ReadRotation(const Value& value, std::string_view what, const Scope& scope);
std::string ReadText(const Value& value, std::string_view what, const Scope& scope);
inline constexpr std::size_t kMaxNameLength = 200;  ///< A model has many copies of each.
/// Reads a text for which `IsName` holds, of at most `kMaxNameLength` characters.
std::string ReadName(const Value& value, std::string_view what, const Scope& scope);
/// Reads a free key of a map as such a name.
std::string ReadKey(const Entry& entry, std::string_view what, const Scope& scope);
/// Returns whether `text` consists of names separated by dots, such as segment_0.tip: the full name
/// of a node of a placed part.
bool IsFullName(std::string_view text);
/// Reads a list of names; a single name is a list of one.
std::vector<std::string> ReadNames(const Value& value, std::string_view what, const Scope& scope);
/// Reads a selector of tags: `a` (has tag a), `[a, b]` (has both), `[[a, b], [c]]` (has a and b, or
/// c). A full name such as segment_0.tip is a tag, too. Empty after an error.
std::vector<std::vector<std::string>> ReadMatch(const Value& value, std::string_view what,
                                                const Scope& scope);
/// Reads [[time_s, value], ...] with increasing times. Empty after an error.
std::vector<std::pair<double, double>> ReadPoints(const Value& value, std::string_view what,
                                                  const Bound& bound, const Scope& scope);
/// Returns whether `tags` match a selector read by `ReadMatch`.
bool Matches(const std::vector<std::vector<std::string>>& match,
             const std::vector<std::string>& tags);

/// Returns the shortest text that reads back as the same number.
std::string Shown(double number);

/// Reports a wrong type: "<what> must be <wanted>, got <kind>".
void WrongType(const Value& value, std::string_view what, std::string_view wanted,
               const Scope& scope);

/// Returns the hint for an unknown key: the most similar key, or a key that only lacks its unit.
std::string KeyHint(std::string_view key, const std::vector<std::string>& known);

/// Returns `DidYouMean`, or nothing if there are too many names to compare in a short time.
std::string NameHint(std::string_view name, const std::vector<std::string>& known);

template <class E>
std::optional<E> ReadChoice(const Value& value, std::string_view what,
                            const std::vector<std::pair<std::string, E>>& choices,
                            const Scope& scope) {
  if (value.kind != Value::Kind::kScalar) {
    WrongType(value, what, "a text", scope);
    return std::nullopt;
  }
  std::vector<std::string> names;
  for (const auto& [name, choice] : choices) {
    if (name == value.text) return choice;
    names.push_back(name);
  }
  scope.out.Error("value.unknown_word", value.at,
                  std::string(what) + " cannot be \"" + value.text + "\"",
                  NameHint(value.text, names));
  return std::nullopt;
}

/// Reader of a map whose keys are all known beforehand. If the value is not a map, reports one
/// error and then behaves like an empty map without reporting missing keys.
class MapReader {
 public:
  /// `what` is the name of the map in messages: "rod", "terrain".
  MapReader(const Value& value, std::string what, const Scope& scope);
  void Call(const char* what) { what_ = what; }
  void Know(std::string_view key);
  /// Reports every key that is not known by now, then the keys that were missing so far. A missing
  /// key that the remedy of an unknown key suggests is no error: it is the same mistake.
  void RefuseOthers();
  /// Calls `check` for conditions on several keys. If keys are misspelled, errors that it reports
  /// at this map or its keys are dropped, because they may follow from the misspelling.
  void CheckWith(const std::function<void(const MapReader&)>& check) const;

  bool is_map() const { return value_.kind == Value::Kind::kMap; }
  const std::string& what() const { return what_; }
  const SourceRef& at() const { return value_.at; }
  const Scope& scope() const { return scope_; }
  /// Returns the path of a key, such as "rod.radius_m"; at the top of a file, the key alone.
  std::string Path(std::string_view key) const;

  bool Has(std::string_view key) const { return Find(key) != nullptr; }
  bool HasAnyBut(std::string_view key) const;        ///< Among the keys known by now.
  const Value* Find(std::string_view key) const;     ///< Null if absent.
  const Value* Require(std::string_view key) const;  ///< Null and an error if absent.
  SourceRef KeyAt(std::string_view key) const;       ///< Place of the key; of the map if absent.
  /// Adds an error at a key.
  void Error(MessageId id, std::string_view key, std::string what, std::string hint = {}) const;

  /// Returns the one key of `keys` that is present. Reports an error and returns "" if none or
  /// several are.
  std::string ExactlyOne(const std::vector<std::string>& keys) const;

  double Number(std::string_view key, const Bound& bound) const;  ///< Required.
  double NumberOr(std::string_view key, double fallback, const Bound& bound) const;

 private:
  /// A copy that reports to `out`.
  MapReader(const MapReader& other, Diagnostics& out);

  /// Required keys of which none is present.
  struct Missing {
    std::vector<std::string> keys;
    bool one_of = false;  ///< From `ExactlyOne`.
  };

  /// Reports missing keys, at the latest in `RefuseOthers`.
  void ReportMissing(const Missing& missing) const;

  const Value& value_;
  std::string what_;
  std::vector<std::string> known_;
  std::vector<std::string> meant_;        ///< Keys that remedies of unknown keys suggest.
  mutable std::vector<Missing> missing_;  ///< Not yet reported.
  bool knows_all_ = false;                ///< Whether all keys have been read.
  Scope scope_;
};

/// Returns the place of a key of a map, or of the map if the key is absent.
SourceRef KeyAt(const Value& map, std::string_view key);

/// Returns the items of a list; reports an error and returns no items for another type. `value` may
/// be null.
const std::vector<ValuePtr>& Items(const Value* value, std::string_view what, const Scope& scope);
/// Returns the entries of a map with free keys (names); reports an error and returns no entries for
/// another type. `value` may be null.
const std::vector<Entry>& Entries(const Value* value, std::string_view what, const Scope& scope);

/// Checks `taut: 1` and `kind: <kind>`. Returns false if the rest of the file should not be read.
bool CheckHeader(const Value& root, std::string_view kind, Diagnostics& out);

/// Returns the path of an existing file that a value names, relative to the folder of the file that
/// contains the value (possibly a base file). Reports a missing file. `value` may be null.
std::optional<std::string> FindFile(const Value* value, const std::string& what,
                                    const Scope& scope);

/// Resolves `path` relative to the folder of `file`, unless it is absolute.
std::string PathBeside(const std::string& file, const std::string& path);

}  // namespace taut::description
