// Readers of names, lists of names, tags and points in YAML files.
#include <algorithm>
#include <cmath>

#include "description/yaml/reader.h"

namespace taut {

bool IsName(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
}

namespace description {
namespace {

std::string ReadNameText(const Value& value, std::string_view what, bool dots, const Scope& scope) {
  if (value.kind != Value::Kind::kScalar) {
    WrongType(value, what, "a name", scope);
    return {};
  }
  if (value.text.size() > kMaxNameLength) {
    scope.out.Error("name.too_long", value.at,
                    std::string(what) + ": a name has at most " + std::to_string(kMaxNameLength) +
                        " characters");
    return {};
  }
  if (dots ? IsFullName(value.text) : IsName(value.text)) return value.text;
  scope.out.Error("name.bad", value.at,
                  std::string(what) + ": \"" + value.text + "\" cannot be a name",
                  "use letters, digits, _ and -");
  return {};
}

std::vector<std::string> ReadNameTexts(const Value& value, std::string_view what, bool dots,
                                       const Scope& scope) {
  std::vector<std::string> names;
  const auto add = [&](const Value& item) {
    std::string name = ReadNameText(item, what, dots, scope);
    if (!name.empty()) names.push_back(std::move(name));
  };
  if (value.kind == Value::Kind::kSequence) {
    for (const ValuePtr& item : value.items) add(*item);
  } else if (value.kind == Value::Kind::kScalar) {
    add(value);
  } else {
    WrongType(value, what, "a name or a list of names", scope);
  }
  return names;
}

}  // namespace

bool IsFullName(std::string_view text) {
  for (std::size_t dot; (dot = text.find('.')) != text.npos; text.remove_prefix(dot + 1)) {
    if (!IsName(text.substr(0, dot))) return false;
  }
  return IsName(text);
}

std::string ReadName(const Value& value, std::string_view what, const Scope& scope) {
  return ReadNameText(value, what, false, scope);
}

std::string ReadKey(const Entry& entry, std::string_view what, const Scope& scope) {
  Value key;
  key.kind = Value::Kind::kScalar;
  key.at = entry.key_at;
  key.text = entry.key;
  return ReadName(key, what, scope);
}

std::vector<std::string> ReadNames(const Value& value, std::string_view what, const Scope& scope) {
  return ReadNameTexts(value, what, false, scope);
}

std::vector<std::vector<std::string>> ReadMatch(const Value& value, std::string_view what,
                                                const Scope& scope) {
  const auto is_list = [](const ValuePtr& item) { return item->kind == Value::Kind::kSequence; };
  std::vector<std::vector<std::string>> match;
  if (value.kind == Value::Kind::kSequence && value.items.empty()) {
    scope.out.Error("value.empty", value.at, std::string(what) + " must not be empty",
                    "name the tags to match");
  } else if (value.kind == Value::Kind::kSequence &&
             std::any_of(value.items.begin(), value.items.end(), is_list)) {
    for (const ValuePtr& item : value.items) {
      std::vector<std::string> set = ReadNameTexts(*item, what, true, scope);
      if (is_list(item) && item->items.empty()) {
        scope.out.Error("value.empty", item->at, std::string(what) + " must not be empty",
                        "name the tags to match");
      }
      if (!set.empty()) match.push_back(std::move(set));
    }
  } else {
    std::vector<std::string> set = ReadNameTexts(value, what, true, scope);
    if (!set.empty()) match.push_back(std::move(set));
  }
  return match;
}

bool Matches(const std::vector<std::vector<std::string>>& match,
             const std::vector<std::string>& tags) {
  const auto has = [&](const std::string& tag) {
    return std::find(tags.begin(), tags.end(), tag) != tags.end();
  };
  return std::any_of(match.begin(), match.end(), [&](const std::vector<std::string>& set) {
    return std::all_of(set.begin(), set.end(), has);
  });
}

std::vector<std::pair<double, double>> ReadPoints(const Value& value, std::string_view what,
                                                  const Bound& bound, const Scope& scope) {
  std::vector<std::pair<double, double>> points;
  if (value.kind != Value::Kind::kSequence || value.items.empty()) {
    scope.out.Error("value.not_a_course", value.at,
                    std::string(what) + " must be a list of [time_s, value]",
                    "such as [[0, 1], [5, 2]]");
    return points;
  }
  bool good = true;
  double before = -1.0;
  for (const ValuePtr& item : value.items) {
    if (item->kind != Value::Kind::kSequence || item->items.size() != 2) {
      scope.out.Error("value.not_a_point", item->at,
                      std::string(what) + ": a point must be [time_s, value]");
      good = false;
      continue;
    }
    const double time_s =
        ReadNumber(*item->items[0], std::string(what) + ": time_s", Bound::kNonNegative, scope);
    const double number = ReadNumber(*item->items[1], what, bound, scope);
    if (time_s <= before) {
      scope.out.Error("value.times_not_increasing", item->items[0]->at,
                      std::string(what) + ": times must increase, but " + Shown(time_s) +
                          " s follows " + Shown(before) + " s");
      good = false;
    }
    good = good && !std::isnan(time_s) && !std::isnan(number);
    if (!std::isnan(time_s)) before = time_s;
    points.emplace_back(time_s, number);
  }
  return good ? points : std::vector<std::pair<double, double>>();
}

}  // namespace description
}  // namespace taut
