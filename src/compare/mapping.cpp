// Strict reader of mapping files (JSON). Splits vectors and quaternions into rules for their
// components.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "base/input_file.h"
#include "compare/foreign_units.h"
#include "taut/compare.h"

namespace taut {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kAxisNames[] = {"x", "y", "z"};
constexpr std::size_t kMaxBytes = 10'000'000;
constexpr std::string_view kAxisMark = "{axis}";

/// Axis of the file that corresponds to an axis of taut, and its sign.
struct Axis {
  int of_file = 0;
  double sign = 1.0;
};
using Axes = std::array<Axis, 3>;

/// Returns +1 for a rotation, -1 for a reflection, 0 if an axis is missing.
double Handedness(const Axes& axes) {
  const int i = axes[0].of_file, j = axes[1].of_file, k = axes[2].of_file;
  const double order = 0.5 * ((j - i) * (k - i) * (k - j));  // sign of the permutation
  return order * axes[0].sign * axes[1].sign * axes[2].sign;
}

std::string WithAxis(std::string name, std::string_view axis) {
  const std::size_t at = name.find(kAxisMark);
  return name.replace(at, kAxisMark.size(), axis);
}

class MappingReader {
 public:
  MappingReader(const std::string& path, Diagnostics& out) : path_(path), out_(out) {}

  std::optional<Mapping> Read() {
    const auto text =
        base::ReadInputFile(path_, kMaxBytes, "expected a mapping", out_, base::NamedBy::kUser);
    if (!text) return std::nullopt;
    const Json json = Parse(*text);
    if (good_) Root(json);
    if (!good_) return std::nullopt;
    return std::move(mapping_);
  }

 private:
  /// Parses the text. Rejects duplicate keys, which JSON permits.
  Json Parse(const std::string& text) {
    std::vector<std::set<std::string>> keys;
    const auto watch = [&](int, Json::parse_event_t event, Json& value) {
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      if (event == Json::parse_event_t::object_end) keys.pop_back();
      if (event == Json::parse_event_t::key && !keys.back().insert(value).second) {
        Error("mapping.duplicate_key", "",
              fmt::format("key \"{}\" occurs twice in one object", std::string(value)));
      }
      return true;
    };
    try {
      return Json::parse(text, watch);
    } catch (const Json::exception& failure) {
      const std::string what = failure.what();  // such as "[json...] parse error at line 1, ...:
                                                // ..."
      Error("mapping.not_json", "", "the mapping is not JSON: " + what.substr(what.find("] ") + 2));
      return {};
    }
  }

  void Root(const Json& root) {
    if (!IsObject(
            root, "",
            {"version", "description", "table", "axes", "channels", "vectors", "quaternions"})) {
      return;
    }
    if (root.value("version", Json()) != 1) {
      Error("mapping.unknown_version", "version",
            "must be 1, the version of mapping files that this taut reads");
    }
    if (root.contains("description") && !root["description"].is_string()) {
      Error("mapping.description_no_text", "description", "must be a string");
    }
    if (root.contains("table")) Table(root["table"]);
    ReadAxes(root);
    ForEach(root, "channels", {"from", "to", "from_unit", "unit", "scale", "offset", "wrap"},
            [&](const Json& rule, const std::string& at) { Channel(rule, at); });
    ForEach(root, "vectors", {"from", "to", "from_unit", "unit", "scale", "offset"},
            [&](const Json& rule, const std::string& at) { Vector(rule, at); });
    ForEach(root, "quaternions", {"from", "to"},
            [&](const Json& rule, const std::string& at) { Quaternion(rule, at); });
  }

  void ReadAxes(const Json& root) {
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)] = {i, 1.0};
    if (!root.contains("axes")) return;
    if (!IsObject(root["axes"], "axes", {"x", "y", "z"})) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string text = Text(root["axes"], kAxisNames[i], "axes");
      const bool negative = text.starts_with('-');
      const std::string letter = text.substr(negative ? 1 : 0);
      if (letter != "x" && letter != "y" && letter != "z") {
        Error("mapping.bad_axis", fmt::format("axes.{}", kAxisNames[i]),
              "must be one of x, y, z, -x, -y, -z");
        return;
      }
      axes_[i] = {letter[0] - 'x', negative ? -1.0 : 1.0};
    }
    if (Handedness(axes_) == 0.0) {
      Error("mapping.duplicate_axis", "axes", "uses an axis twice");
    } else if (Handedness(axes_) < 0.0) {
      Error("mapping.mirrored_axes", "axes", "must be a rotation, not a reflection");
    }
  }

  void Channel(const Json& rule, const std::string& at) {
    Mapping::Rule result{Pattern(rule, "from", at), Pattern(rule, "to", at), Unit(rule, at),
                         Number(rule, "scale", at, 1.0), Number(rule, "offset", at, 0.0)};
    result.scale *= FromUnit(rule, result, at);
    if (rule.contains("wrap")) result.period = Period(rule["wrap"], result, at + ".wrap");
    if (StarsDiffer(result))
      Error("mapping.unpaired_star", at, "has a `*` in only one of \"from\" and \"to\"");
    mapping_.rules.push_back(std::move(result));
  }

  /// Returns the period of wrapped values, in the result's unit.
  double Period(const Json& wrap, const Mapping::Rule& whole, const std::string& at) {
    if (wrap == "turn") {
      const std::string unit = whole.unit.empty() ? UnitOfName(whole.to) : whole.unit;
      if (unit != "rad") {
        Error("mapping.turn_of_no_angle", at,
              fmt::format("is \"turn\", but the result is in {}, not in rad", unit));
      }
      return 2.0 * std::numbers::pi;
    }
    if (wrap.is_number() && wrap > 0.0) return std::abs(whole.scale) * wrap.get<double>();
    Error("mapping.bad_wrap", at,
          "must be \"turn\", or the period of the file's values, a number above 0");
    return 0.0;
  }

  void Vector(const Json& rule, const std::string& at) {
    const Mapping::Rule whole = AxisRule(rule, at);
    std::array<double, 3> offset{};
    if (rule.contains("offset")) {
      const Json& given = rule["offset"];
      if (!given.is_array() || given.size() != 3 ||
          !std::all_of(given.begin(), given.end(), [](const Json& j) { return j.is_number(); })) {
        Error("mapping.bad_offset", at + ".offset",
              "must be a list of three numbers, along taut's x, y and z");
        return;
      }
      for (std::size_t i = 0; i < 3; ++i) offset[i] = given[i];
    }
    const double scale = Number(rule, "scale", at, 1.0) * FromUnit(rule, whole, at);
    if (good_) AddComponents(whole, scale, offset);
  }

  /// Returns the conversion factor from `from_unit` to the result's unit.
  double FromUnit(const Json& rule, const Mapping::Rule& whole, const std::string& at) {
    if (!rule.contains("from_unit")) return 1.0;
    const std::string name = Text(rule, "from_unit", at);
    if (name.empty()) return 1.0;
    std::string to = whole.to;
    if (const std::size_t mark = to.find(kAxisMark); mark != to.npos) to = WithAxis(to, "x");
    const std::string wanted = whole.unit.empty() ? UnitOfName(to) : whole.unit;
    return UnitIn(name, wanted, at + ".from_unit");
  }

  double UnitIn(const std::string& name, const std::string& wanted, const std::string& at) {
    const auto unit = FindUnit(name);
    if (!unit) {
      Error("mapping.unknown_unit", at, fmt::format("is the unknown unit \"{}\"", name),
            DidYouMean(name, UnitNames()));
    } else if (unit->si != wanted) {
      Error("mapping.wrong_unit", at, fmt::format("is {}, but the result is in {}", name, wanted));
    }
    return unit ? unit->factor : 1.0;
  }

  void Table(const Json& json) {
    TableLayout& table = mapping_.table.emplace();
    if (!IsObject(
            json, "table",
            {"skip_lines", "header", "columns", "separator", "ignore", "time", "names", "value"})) {
      return;
    }
    const double skip = Number(json, "skip_lines", "table", 0.0);
    if (!(skip >= 0 && skip <= 1e6 && skip == static_cast<int>(skip))) {
      Error("mapping.bad_skip_lines", "table.skip_lines", "must be a whole number of lines");
    } else {
      table.skip_lines = static_cast<int>(skip);
    }
    if (json.contains("header") && !json["header"].is_boolean()) {
      Error("mapping.bad_header", "table.header", "must be true or false");
    } else {
      table.header = json.value("header", true);
    }
    if (json.contains("separator")) {
      const std::string text = Separator(json["separator"]);
      if (text.size() == 1) table.separator = text[0];
    }
    table.columns = Texts(json, "columns");
    table.ignore = Texts(json, "ignore");
    table.name_columns = Texts(json, "names");
    if (json.contains("value")) table.value_column = Text(json, "value", "table");
    if (json.contains("names") != json.contains("value")) {
      Error(
          "mapping.names_without_value", "table",
          "must have both \"names\" and \"value\", or neither",
          "they select the columns of channel names and values, for tables with one value per row");
    }
    if (!table.header && table.columns.empty()) {
      Error("mapping.no_columns", "table.columns", "is missing",
            "list the names of the columns, because the table has no header");
    }
    if (!json.contains("time")) {
      Error("mapping.no_time", "table.time", "is missing",
            "expected {\"column\": \"t\", \"unit\": \"ms\"} or {\"row_s\": 1}");
    } else if (IsObject(json["time"], "table.time",
                        {"column", "unit", "zero", "offset_s", "row_s"})) {
      Clock(json["time"], table);
    }
  }

  std::string Separator(const Json& json) {
    std::string text = json.is_string() ? json.get<std::string>() : "";
    if (text == "," || text == ";" || text == "\t" || text == " " || text == "|") return text;
    Error("mapping.bad_separator", "table.separator",
          "must be one of \",\", \";\", \"|\", \"\\t\" and \" \"");
    return {};
  }

  std::vector<std::string> Texts(const Json& json, const std::string& key) {
    if (!json.contains(key)) return {};
    const Json& list = json[key];
    if (!list.is_array() || list.empty() ||
        !std::all_of(list.begin(), list.end(), [](const Json& j) { return j.is_string(); })) {
      Error("mapping.bad_list", "table." + key, "must be a list of strings");
      return {};
    }
    return list.get<std::vector<std::string>>();
  }

  void Clock(const Json& json, TableLayout& table) {
    table.offset_s = Number(json, "offset_s", "table.time", 0.0);
    if (json.contains("row_s")) {
      table.row_s = Number(json, "row_s", "table.time", 1.0);
      if (!(*table.row_s > 0)) Error("mapping.bad_row_s", "table.time.row_s", "must be above 0");
      for (const char* other : {"column", "unit", "zero"}) {
        if (json.contains(other))
          Error("mapping.two_times", "table.time", fmt::format("has both row_s and {}", other));
      }
      return;
    }
    table.time_column = Text(json, "column", "table.time");
    if (json.contains("unit")) {
      const std::string unit = Text(json, "unit", "table.time");
      if (!unit.empty()) table.unit_s = UnitIn(unit, "s", "table.time.unit");
    }
    if (json.contains("zero") && json["zero"] == "first") {
      table.zero.reset();
    } else if (json.contains("zero")) {
      if (!json["zero"].is_number()) {
        Error("mapping.bad_zero", "table.time.zero", "must be a number or \"first\"");
        return;
      }
      table.zero = json["zero"];
    }
  }

  /// Converts the vector part of a quaternion to the other axes. The scalar part remains unchanged.
  void Quaternion(const Json& rule, const std::string& at) {
    const Mapping::Rule whole = AxisRule(rule, at);
    if (!good_) return;
    mapping_.rules.push_back({WithAxis(whole.from, "w"), WithAxis(whole.to, "w"), "1", 1.0, 0.0});
    AddComponents(whole, 1.0, {});
  }

  void AddComponents(const Mapping::Rule& whole, double scale,
                     const std::array<double, 3>& offset) {
    for (std::size_t i = 0; i < 3; ++i) {
      mapping_.rules.push_back({WithAxis(whole.from, kAxisNames[axes_[i].of_file]),
                                WithAxis(whole.to, kAxisNames[i]), whole.unit,
                                axes_[i].sign * scale, offset[i]});
    }
  }

  Mapping::Rule AxisRule(const Json& rule, const std::string& at) {
    Mapping::Rule result{Pattern(rule, "from", at), Pattern(rule, "to", at), Unit(rule, at)};
    for (const auto& [key, text] : {std::pair("from", result.from), std::pair("to", result.to)}) {
      const std::size_t mark = text.find(kAxisMark);
      if (mark == text.npos || text.find(kAxisMark, mark + 1) != text.npos) {
        Error("mapping.no_axis_place", fmt::format("{}.{}", at, key),
              "must contain {axis} once, in the place of x, y and z");
      }
    }
    if (StarsDiffer(result))
      Error("mapping.unpaired_star", at, "has a `*` in only one of \"from\" and \"to\"");
    return result;
  }

  static bool StarsDiffer(const Mapping::Rule& rule) {
    return (rule.from.find('*') == std::string::npos) != (rule.to.find('*') == std::string::npos);
  }

  std::string Pattern(const Json& rule, const char* key, const std::string& at) {
    std::string text = Text(rule, key, at);
    if (std::count(text.begin(), text.end(), '*') > 1) {
      Error("mapping.several_stars", fmt::format("{}.{}", at, key), "has more than one `*`");
    }
    return text;
  }

  std::string Unit(const Json& rule, const std::string& at) {
    return rule.contains("unit") ? Text(rule, "unit", at) : std::string();
  }

  std::string Text(const Json& object, const char* key, const std::string& at) {
    const auto found = object.find(key);
    if (found != object.end() && found->is_string() && !found->get<std::string>().empty()) {
      std::string text = *found;
      if (std::any_of(text.begin(), text.end(), base::IsControl)) {
        Error("mapping.control_character", fmt::format("{}.{}", at, key),
              "contains a control character");
      }
      return text;
    }
    Error("mapping.missing_text", fmt::format("{}.{}", at, key),
          found == object.end() ? "is missing" : "must be a string");
    return {};
  }

  double Number(const Json& object, const char* key, const std::string& at, double otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (found->is_number()) return *found;
    Error("mapping.not_a_number", fmt::format("{}.{}", at, key), "must be a number");
    return otherwise;
  }

  bool IsObject(const Json& json, const std::string& at, const std::vector<std::string>& keys) {
    if (!json.is_object()) {
      Error("mapping.not_an_object", at,
            at.empty() ? "the mapping must be an object { ... }" : "must be an object { ... }");
      return false;
    }
    for (const auto& [key, value] : json.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      Error("mapping.unknown_key", at.empty() ? key : at + "." + key, "is not a known key",
            DidYouMean(key, keys));
    }
    return true;
  }

  template <class Use>
  void ForEach(const Json& root, const char* key, const std::vector<std::string>& keys,
               const Use& use) {
    if (!root.contains(key)) return;
    if (!root[key].is_array()) return Error("mapping.not_a_list", key, "must be a list [ ... ]");
    for (std::size_t i = 0; i < root[key].size(); ++i) {
      const std::string at = fmt::format("{}[{}]", key, i);
      if (IsObject(root[key][i], at, keys)) use(root[key][i], at);
    }
  }

  void Error(MessageId id, const std::string& at, const std::string& what, std::string hint = {}) {
    out_.Error(id, {path_}, at.empty() ? what : at + " " + what, std::move(hint));
    good_ = false;
  }

  const std::string& path_;
  Diagnostics& out_;
  bool good_ = true;
  Axes axes_;
  Mapping mapping_;
};

}  // namespace

std::optional<Mapping> LoadMapping(const std::string& path, Diagnostics& out) {
  return MappingReader(path, out).Read();
}

}  // namespace taut
