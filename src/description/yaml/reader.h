/// Strict access to a YAML tree: unknown keys, wrong types and values out of range are errors. All
/// functions add errors to `Scope::out` and continue, so that users see all errors of a file at
/// once. After an error, they return NaN or an empty value, which later checks ignore.
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
  int index = 0;         ///< -1: unknown because of an error; then any name is valid.
  const char* who = "";  ///< Subject of messages: "a gait that drives rest lengths".
};

/// Context of all reading functions: parameters for expressions, destination of errors, set of used
/// parameters (may be null), and valid alternative names.
struct Scope {
  const NameTable& names;
  Diagnostics& out;
  NameSet* used = nullptr;
  Spelling spelling{};
  std::string_view unit{};  ///< SI unit of numbers whose names have none, such as coordinates.
};

/// Range of a number, from `least` to `most`. Numbers must also be finite.
struct Bound {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false, below_most = false;  ///< Whether the bound itself is excluded.
  const char* least_text = nullptr;              ///< Text of `least` in messages.
  const char* most_text = nullptr;               ///< Text of `most` in messages.
  const char* hint = "";                         ///< For numbers out of range.

  static const Bound kAny, kPositive, kNonNegative, kFraction;
};
inline constexpr Bound Bound::kAny{};
inline constexpr Bound Bound::kPositive{.least = 0.0, .above_least = true};
inline constexpr Bound Bound::kNonNegative{.least = 0.0};
inline constexpr Bound Bound::kFraction{.least = 0.0, .most = 1.0};

// In all functions below, `what` is the name of the value in messages: "rod.radius_m must be
// positive, got -1".

double ReadNumber(const Value& value, std::string_view what, const Bound& bound,
                  const Scope& scope);
std::optional<int> ReadInteger(const Value& value, std::string_view what, int least, int most,
                               const Scope& scope);
std::optional<bool> ReadBool(const Value& value, std::string_view what, const Scope& scope);
/// Reads [x, y, z]. All components are NaN after an error.
Vec3 ReadVec3(const Value& value, std::string_view what, const Scope& scope);
/// Reads a nonzero vector and returns it with length 1.
Vec3 ReadDirection(const Value& value, std::string_view what, const Scope& scope);
/// Reads `count` numbers; returns nothing after an error.
std::optional<std::vector<double>> ReadNumbers(const Value& value, std::string_view what,
                                               std::size_t count, const Scope& scope);
/// Reads a rotation, `{axis: z, angle_rad: pi / 2}` or `{quaternion: [w, x, y, z]}`. The axis may
/// also be [x, y, z]. A list of rotations is applied in order about the fixed axes of W.
Quat ReadRotation(const Value& value, std::string_view what, const Scope& scope);
std::string ReadText(const Value& value, std::string_view what, const Scope& scope);
inline constexpr std::size_t kMaxNameLength = 200;  ///< Limited, because a model contains many
                                                    ///< copies of each name.
/// Reads a text that satisfies `IsName`, with at most `kMaxNameLength` characters.
std::string ReadName(const Value& value, std::string_view what, const Scope& scope);
/// Reads a free key of a map, with the same rules as `ReadName`.
std::string ReadKey(const Entry& entry, std::string_view what, const Scope& scope);
/// Returns whether `text` consists of names separated by dots. Example: segment_0.tip, the full
/// name of a node of a placed part.
bool IsFullName(std::string_view text);
/// Reads a list of names. A single name counts as a list with one item.
std::vector<std::string> ReadNames(const Value& value, std::string_view what, const Scope& scope);
/// Reads a selector of tags: `a` (has tag a), `[a, b]` (has both), `[[a, b], [c]]` (has a and b, or
/// c). Full names such as segment_0.tip are also tags. Returns an empty list after an error.
std::vector<std::vector<std::string>> ReadMatch(const Value& value, std::string_view what,
                                                const Scope& scope);
/// Reads [[time_s, value], ...] with increasing times. Returns an empty list after an error.
std::vector<std::pair<double, double>> ReadPoints(const Value& value, std::string_view what,
                                                  const Bound& bound, const Scope& scope);
/// Returns whether `tags` match a selector read by `ReadMatch`.
bool Matches(const std::vector<std::vector<std::string>>& match,
             const std::vector<std::string>& tags);

/// Returns the shortest text from which the same number is read back.
std::string Shown(double number);

/// Reports a value of the wrong type: "<what> must be <wanted>, got <kind>".
void WrongType(const Value& value, std::string_view what, std::string_view wanted,
               const Scope& scope);

/// Returns the hint for an unknown key: the most similar key, or the same key with a unit.
std::string KeyHint(std::string_view key, const std::vector<std::string>& known);

/// Returns `DidYouMean`. Returns an empty text if there are too many names to compare quickly.
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

/// Reader of a map with a fixed set of keys. If the value is not a map, reports one error. Then it
/// acts like an empty map and reports no missing keys.
class MapReader {
 public:
  /// `what`: name of the map in messages, such as "rod" or "terrain".
  MapReader(const Value& value, std::string what, const Scope& scope);
  void Call(const char* what) { what_ = what; }
  void Know(std::string_view key);
  /// Reports every unknown key, then the missing keys. A missing key is not reported if the fix of
  /// an unknown key suggests it, because both have the same cause.
  void RefuseOthers();
  /// Calls `check` for conditions on several keys. If the map has misspelled keys, discards errors
  /// at this map and its keys, because they may follow from the misspelling.
  void CheckWith(const std::function<void(const MapReader&)>& check) const;

  bool is_map() const { return value_.kind == Value::Kind::kMap; }
  const std::string& what() const { return what_; }
  const SourceRef& at() const { return value_.at; }
  const Scope& scope() const { return scope_; }
  /// Returns the path of a key, such as "rod.radius_m". At the top level of a file, this is the key
  /// alone.
  std::string Path(std::string_view key) const;

  bool Has(std::string_view key) const { return Find(key) != nullptr; }
  bool HasAnyBut(std::string_view key) const;        ///< Considers only keys known so far.
  const Value* Find(std::string_view key) const;     ///< Returns null if absent.
  const Value* Require(std::string_view key) const;  ///< Returns null and reports an error if
                                                     ///< absent.
  SourceRef KeyAt(std::string_view key) const;       ///< Position of the key; if absent, of the
                                                     ///< map.
  /// Adds an error at a key.
  void Error(MessageId id, std::string_view key, std::string what, std::string hint = {}) const;

  /// Returns the only key of `keys` that is present. Reports an error and returns "" if none or
  /// several are present.
  std::string ExactlyOne(const std::vector<std::string>& keys) const;

  double Number(std::string_view key, const Bound& bound) const;  ///< The key is required.
  double NumberOr(std::string_view key, double fallback, const Bound& bound) const;

 private:
  /// Copies a reader; the copy reports errors to `out`.
  MapReader(const MapReader& other, Diagnostics& out);

  /// Required keys that are absent.
  struct Missing {
    std::vector<std::string> keys;
    bool one_of = false;  ///< Whether only one of the keys is required (`ExactlyOne`).
  };

  /// Reports missing keys, now or at the latest in `RefuseOthers`.
  void ReportMissing(const Missing& missing) const;

  const Value& value_;
  std::string what_;
  std::vector<std::string> known_;
  std::vector<std::string> meant_;        ///< Keys that fixes of unknown keys suggest.
  mutable std::vector<Missing> missing_;  ///< Missing keys that are not reported yet.
  bool knows_all_ = false;                ///< Whether all keys have been read.
  Scope scope_;
};

/// Returns the position of a key of a map. If the key is absent, returns the position of the map.
SourceRef KeyAt(const Value& map, std::string_view key);

/// Returns the items of a list. For other types, reports an error and returns no items. `value` may
/// be null.
const std::vector<ValuePtr>& Items(const Value* value, std::string_view what, const Scope& scope);
/// Returns the entries of a map with free keys (names). For other types, reports an error and
/// returns no entries. `value` may be null.
const std::vector<Entry>& Entries(const Value* value, std::string_view what, const Scope& scope);

/// Checks `taut: 1` and `kind: <kind>`. Returns false if the caller should not read the rest of the
/// file.
bool CheckHeader(const Value& root, std::string_view kind, Diagnostics& out);

/// Returns the path of the file that a value contains; reports an error if there is no such file.
/// The path is relative to the folder of the file with this value, which may be a base file.
/// `value` may be null.
std::optional<std::string> FindFile(const Value* value, const std::string& what,
                                    const Scope& scope);

/// Resolves `path` relative to the folder of `file`. Absolute paths remain unchanged.
std::string PathBeside(const std::string& file, const std::string& path);

}  // namespace taut::description
