#include "description/yaml/reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/brief.h"
#include "description/yaml/kinds.h"
#include "description/yaml/quantity.h"

namespace taut::description {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Returns whether a list has commas followed by a space and commas followed by a digit, as in
/// `[0,5, 0, 0]`.
bool HasDecimalComma(const Value& list) {
  bool tight = false, wide = false;
  for (std::size_t i = 1; i < list.items.size(); ++i) {
    const Value &before = *list.items[i - 1], &after = *list.items[i];
    const int end = before.at.column + static_cast<int>(before.text.size()) + 1;
    if (before.kind != Value::Kind::kScalar || before.at.line != after.at.line) continue;
    (after.at.column == end ? tight : wide) = true;
  }
  return tight && wide;
}

/// Returns the violated bound as text, such as " must be positive". Returns an empty text for valid
/// numbers and NaN.
std::string Beyond(double number, const Bound& bound) {
  const bool low = number < bound.least || (bound.above_least && number == bound.least);
  const bool high = number > bound.most || (bound.below_most && number == bound.most);
  if (!low && !high) return {};
  const std::string least = bound.least_text ? bound.least_text : Shown(bound.least);
  const std::string most = bound.most_text ? bound.most_text : Shown(bound.most);
  const bool positive = bound.least > 0.0 || (bound.least == 0.0 && bound.above_least);
  if (positive && number <= 0.0) return " must be positive";
  const bool closed = !bound.above_least && !bound.below_most;
  if (closed && std::isfinite(bound.least) && std::isfinite(bound.most)) {
    return " must be within " + least + ".." + most;
  }
  if (low && bound.least == 0.0) return " must not be negative";
  if (low) return (bound.above_least ? " must be above " : " must not be below ") + least;
  return (bound.below_most ? " must be below " : " must not be above ") + most;
}

}  // namespace

std::string Shown(double number) { return base::Shortest(number); }

void WrongType(const Value& value, std::string_view what, std::string_view wanted,
               const Scope& scope) {
  scope.out.Error("value.wrong_kind", value.at,
                  std::string(what) + " must be " + std::string(wanted) + ", got " +
                      std::string(KindName(value)));
}

std::string NameHint(std::string_view name, const std::vector<std::string>& known) {
  return known.size() <= 300 && name.size() <= 60 ? DidYouMean(name, known) : std::string();
}

double ReadNumber(const Value& value, std::string_view what, const Bound& bound,
                  const Scope& scope) {
  if (value.kind != Value::Kind::kScalar) {
    WrongType(value, what, "a number", scope);
    return kMissing;
  }
  std::string text = value.text;
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (text == ".nan" || text == "nan" || text == ".inf" || text == "inf" || text == "-.inf" ||
      text == "-inf") {
    scope.out.Error("value.not_finite", value.at,
                    std::string(what) + " must be a finite number, got " + value.text);
    return kMissing;
  }
  if (scope.used) {
    for (std::string& name : NamesIn(value.text)) scope.used->insert(std::move(name));
  }
  Evaluated result = EvaluateQuantity(value.text, scope.names, what, scope.unit);
  if (!result.error.empty()) {
    scope.out.Error("value.bad_expression", value.at, std::string(what) + ": " + result.error,
                    std::move(result.hint));
    return kMissing;
  }
  const double number = result.value;
  const std::string wrong = Beyond(number, bound);
  if (wrong.empty()) return number;
  const bool too_much = number >= bound.most;
  scope.out.Error("value.out_of_range", value.at,
                  std::string(what) + wrong + ", got " + Shown(number), too_much ? bound.hint : "");
  return kMissing;
}

std::optional<int> ReadInteger(const Value& value, std::string_view what, int least, int most,
                               const Scope& scope) {
  const double number = ReadNumber(value, what, Bound::kAny, scope);
  if (std::isnan(number)) return std::nullopt;
  if (number != std::floor(number) || number < least || number > most) {
    scope.out.Error("value.not_whole", value.at,
                    std::string(what) + " must be a whole number within " + std::to_string(least) +
                        ".." + std::to_string(most) + ", got " + Shown(number));
    return std::nullopt;
  }
  return static_cast<int>(number);
}

std::optional<bool> ReadBool(const Value& value, std::string_view what, const Scope& scope) {
  if (value.kind == Value::Kind::kScalar && !value.quoted) {
    if (value.text == "true") return true;
    if (value.text == "false") return false;
    scope.out.Error("value.not_boolean", value.at,
                    std::string(what) + " must be true or false, got \"" + value.text + "\"");
    return std::nullopt;
  }
  WrongType(value, what, "true or false", scope);
  return std::nullopt;
}

std::optional<std::vector<double>> ReadNumbers(const Value& value, std::string_view what,
                                               std::size_t count, const Scope& scope) {
  if (value.kind != Value::Kind::kSequence) {
    WrongType(value, what, "a list of " + std::to_string(count) + " numbers", scope);
    return std::nullopt;
  }
  if (value.items.size() != count) {
    scope.out.Error("value.wrong_length", value.at,
                    std::string(what) + " must have " + std::to_string(count) + " numbers, got " +
                        std::to_string(value.items.size()),
                    HasDecimalComma(value) ? "write decimal fractions with a point" : "");
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const ValuePtr& item : value.items) {
    numbers.push_back(ReadNumber(*item, what, Bound::kAny, scope));
  }
  if (std::any_of(numbers.begin(), numbers.end(), [](double x) { return std::isnan(x); })) {
    return std::nullopt;
  }
  return numbers;
}

Vec3 ReadVec3(const Value& value, std::string_view what, const Scope& scope) {
  const auto numbers = ReadNumbers(value, what, 3, scope);
  return numbers ? Vec3{(*numbers)[0], (*numbers)[1], (*numbers)[2]}
                 : Vec3{kMissing, kMissing, kMissing};
}

Vec3 ReadDirection(const Value& value, std::string_view what, const Scope& scope) {
  const Vec3 v = ReadVec3(value, what, scope);
  // Scale first to avoid overflow and underflow of the squares, such as of 1e200 and 1e-200.
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  if (largest == 0.0) {
    scope.out.Error("value.zero", value.at, std::string(what) + " must not be zero",
                    "it is a direction");
    return {kMissing, kMissing, kMissing};
  }
  // Keep a vector of length 1 (up to rounding) unchanged, so that files written by taut are read
  // back bit for bit.
  if (std::fabs(v.x * v.x + v.y * v.y + v.z * v.z - 1.0) < 1e-15) return v;
  const Vec3 s{v.x / largest, v.y / largest, v.z / largest};
  const double length = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
  return {s.x / length, s.y / length, s.z / length};
}

std::string ReadText(const Value& value, std::string_view what, const Scope& scope) {
  if (value.kind == Value::Kind::kScalar) return value.text;
  WrongType(value, what, "a text", scope);
  return {};
}

SourceRef KeyAt(const Value& map, std::string_view key) {
  for (const Entry& entry : map.entries) {
    if (entry.key == key) return entry.key_at;
  }
  return map.at;
}

std::optional<std::string> FindFile(const Value* value, const std::string& what,
                                    const Scope& scope) {
  if (!value) return std::nullopt;
  const std::string text = ReadText(*value, what, scope);
  if (value->kind != Value::Kind::kScalar) return std::nullopt;
  const std::string path = PathBeside(value->at.file, text);
  std::error_code ignored;
  if (!text.empty() && std::filesystem::is_regular_file(path, ignored)) return path;
  scope.out.Unreadable("file.missing", value->at, what + ": there is no file \"" + path + "\"",
                       "paths are relative to the folder of the file that contains them");
  return std::nullopt;
}

const std::vector<ValuePtr>& Items(const Value* value, std::string_view what, const Scope& scope) {
  static const std::vector<ValuePtr> kNone;
  if (!value) return kNone;
  if (value->kind != Value::Kind::kSequence) {
    WrongType(*value, what, "a list", scope);
    return kNone;
  }
  return value->items;
}

const std::vector<Entry>& Entries(const Value* value, std::string_view what, const Scope& scope) {
  static const std::vector<Entry> kNone;
  if (!value) return kNone;
  if (value->kind != Value::Kind::kMap) {
    WrongType(*value, what, "a map", scope);
    return kNone;
  }
  return value->entries;
}

bool CheckHeader(const Value& root, std::string_view kind, Diagnostics& out) {
  if (root.kind != Value::Kind::kMap) {
    out.Error("file.not_a_map", root.at,
              "the file must be a map, got " + std::string(KindName(root)),
              "begin the file with `taut: 1` and `kind: " + std::string(kind) + "`");
    return false;
  }
  bool good = true;
  const auto check = [&](const char* key, std::string_view wanted, const std::string& hint) {
    const Value* found = root.Find(key);
    if (!found) {
      out.Error("key.missing", root.at, std::string("the file needs the key \"") + key + "\"",
                "write `" + std::string(key) + ": " + std::string(wanted) + "`");
    } else if (found->kind != Value::Kind::kScalar || found->text != wanted) {
      const std::string got =
          found->kind == Value::Kind::kScalar ? found->text : std::string(KindName(*found));
      out.Error("value.wrong_constant", found->at,
                std::string(key) + " must be " + std::string(wanted) + ", got " + got, hint);
    } else {
      return;
    }
    good = false;
  };
  check("taut", "1", "it is the version of the file format; this program reads version 1");
  const Value* const found = root.Find("kind");
  check("kind", kind, HintOfKind(found ? found->text : ""));
  return good;
}

std::string PathBeside(const std::string& file, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  return (folder / path).lexically_normal().string();
}

}  // namespace taut::description
