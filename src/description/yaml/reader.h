/// Strict access to a YAML tree: every key is either known or an error, every value has the type
/// and the range it should have. All functions complain into `Scope::out` and carry on, so that a
/// user sees every error of a file in one go; what they return after a complaint is harmless
/// (NaN, an empty text) and whoever checks it further stays silent about NaN.
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

/// Which of their names keys have that have several (`Spellings` in keys.h).
struct Spelling {
  int index = 0;         ///< -1: what says so is wrong; any name will do.
  const char* who = "";  ///< "a gait that drives rest lengths": who has these.
};

/// What every reading function needs: the parameters that expressions may use, where to complain,
/// and, if somebody asks, which parameters were used; how keys are spelt.
struct Scope {
  const NameTable& names;
  Diagnostics& out;
  NameSet* used = nullptr;
  Spelling spelling{};
};

/// What a number has to be, besides finite: within least..most.
struct Bound {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false, below_most = false;  ///< An end itself is out.
  const char* least_text = nullptr;              ///< `least` as people write it.
  const char* most_text = nullptr;               ///< `most` as people write it.
  const char* hint = "";                         ///< For who exceeds it.

  static const Bound kAny, kPositive, kNonNegative, kFraction;
};
inline constexpr Bound Bound::kAny{};
inline constexpr Bound Bound::kPositive{.least = 0.0, .above_least = true};
inline constexpr Bound Bound::kNonNegative{.least = 0.0};
inline constexpr Bound Bound::kFraction{.least = 0.0, .most = 1.0};

// In all of these, `what` names the value in messages: "rod.radius_m must be positive, got -1".

double ReadNumber(const Value& value, std::string_view what, const Bound& bound,
                  const Scope& scope);
std::optional<int> ReadInteger(const Value& value, std::string_view what, int least, int most,
                               const Scope& scope);
std::optional<bool> ReadBool(const Value& value, std::string_view what, const Scope& scope);
/// [x, y, z]. NaN components after a complaint.
Vec3 ReadVec3(const Value& value, std::string_view what, const Scope& scope);
/// The same, and it must not be zero; returned with length 1.
Vec3 ReadDirection(const Value& value, std::string_view what, const Scope& scope);
/// `count` numbers, or nothing after a complaint.
std::optional<std::vector<double>> ReadNumbers(const Value& value, std::string_view what,
                                               std::size_t count, const Scope& scope);
/// One rotation `{axis: z, angle_rad: pi / 2}` (axis also [x, y, z]), `{quaternion: [w, x, y, z]}`,
/// or a list of them, applied one after the other about the fixed axes of W.
Quat ReadRotation(const Value& value, std::string_view what, const Scope& scope);
std::string ReadText(const Value& value, std::string_view what, const Scope& scope);
inline constexpr std::size_t kMaxNameLength = 200;  ///< A model has many copies of each.
/// A text that `IsName`, and not too long.
std::string ReadName(const Value& value, std::string_view what, const Scope& scope);
/// The same of a map's free key.
std::string ReadKey(const Entry& entry, std::string_view what, const Scope& scope);
/// Names with dots between them, such as segment_0.tip: what a placed part's nodes are called.
bool IsFullName(std::string_view text);
/// A list of names; one name alone is a list of one.
std::vector<std::string> ReadNames(const Value& value, std::string_view what, const Scope& scope);
/// Tags to match: `a` (has tag a), `[a, b]` (has both), `[[a, b], [c]]` (has a and b, or c).
/// A full name such as segment_0.tip is a tag, too. Empty after a complaint.
std::vector<std::vector<std::string>> ReadMatch(const Value& value, std::string_view what,
                                                const Scope& scope);
/// [[time_s, value], ...] with rising times. Empty after a complaint.
std::vector<std::pair<double, double>> ReadPoints(const Value& value, std::string_view what,
                                                  const Bound& bound, const Scope& scope);
/// Whether `tags` fulfil what `ReadMatch` read.
bool Matches(const std::vector<std::vector<std::string>>& match,
             const std::vector<std::string>& tags);

/// The shortest text that reads back as the same number.
std::string Shown(double number);

/// A wrong-type complaint: "<what> must be <wanted>, got <kind>".
void WrongType(const Value& value, std::string_view what, std::string_view wanted,
               const Scope& scope);

/// The hint for an unknown key: the likely one, or one that only lacks its unit.
std::string KeyHint(std::string_view key, const std::vector<std::string>& known);

/// `DidYouMean`, unless there is so much to compare that it would take long.
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
  scope.out.Error(value.at, std::string(what) + " cannot be \"" + value.text + "\"",
                  NameHint(value.text, names));
  return std::nullopt;
}

/// A map whose keys are all known beforehand. Not a map: one complaint, then it behaves like an
/// empty one whose missing keys nobody complains about.
class MapReader {
 public:
  /// `what` names the map: "rod", "terrain".
  MapReader(const Value& value, std::string what, const Scope& scope);
  void Call(const char* what) { what_ = what; }
  void Know(std::string_view key);
  void RefuseOthers() const;  ///< Complains about every key that is not known by now.

  bool is_map() const { return value_.kind == Value::Kind::kMap; }
  const std::string& what() const { return what_; }
  const SourceRef& at() const { return value_.at; }
  const Scope& scope() const { return scope_; }
  /// "rod.radius_m", or just the key at the top of a file.
  std::string Path(std::string_view key) const;

  bool Has(std::string_view key) const { return Find(key) != nullptr; }
  bool HasAnyBut(std::string_view key) const;        ///< Of those known by now.
  const Value* Find(std::string_view key) const;     ///< Null if absent.
  const Value* Require(std::string_view key) const;  ///< Null and a complaint if absent.
  SourceRef KeyAt(std::string_view key) const;       ///< The key's place; the map's if absent.
  void Error(std::string_view key, std::string what, std::string hint = {}) const;  ///< At a key.

  /// The one key of `keys` that is there. Complains (and returns "") if none or several are.
  std::string ExactlyOne(const std::vector<std::string>& keys) const;

  double Number(std::string_view key, const Bound& bound) const;  ///< Required.
  double NumberOr(std::string_view key, double fallback, const Bound& bound) const;

 private:
  const Value& value_;
  std::string what_;
  std::vector<std::string> known_;
  Scope scope_;
};

/// The place of a key of a map; the map's if it is absent.
SourceRef KeyAt(const Value& map, std::string_view key);

/// The items of a list; a complaint and no items if it is something else. `value` may be null.
const std::vector<ValuePtr>& Items(const Value* value, std::string_view what, const Scope& scope);
/// The entries of a map with free keys (names); a complaint and no entries if it is something
/// else. `value` may be null.
const std::vector<Entry>& Entries(const Value* value, std::string_view what, const Scope& scope);

/// Checks `taut: 1` and `kind: <kind>`. False if the rest is not worth reading.
bool CheckHeader(const Value& root, std::string_view kind, Diagnostics& out);

/// The path that a value names, if such a file is there: beside the file that says so, which may be
/// a base. `value` may be null.
std::optional<std::string> FindFile(const Value* value, const std::string& what,
                                    const Scope& scope);

/// `path` as seen from the folder of `file`, unless it is absolute.
std::string PathBeside(const std::string& file, const std::string& path);

}  // namespace taut::description
