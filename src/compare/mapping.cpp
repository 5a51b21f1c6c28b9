// Strict reader of mapping files (JSON). Splits vectors and quaternions into rules for their
// components.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/input_file.h"
#include "compare/mapping_json.h"
#include "compare/mapping_table.h"
#include "taut/compare.h"

namespace taut {
namespace {

using Json = MappingJson::Json;

constexpr const char* kAxisNames[] = {"x", "y", "z"};
constexpr std::size_t kMaxBytes = 10'000'000;
/// Placeholders for the axis in a name: x, y, z or X, Y, Z.
constexpr std::string_view kAxisMark = "{axis}", kCapitalMark = "{AXIS}";

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

std::string WithAxis(std::string name, std::string axis) {
  std::size_t at = name.find(kAxisMark);
  if (at == name.npos) {
    at = name.find(kCapitalMark);
    axis[0] = static_cast<char>(axis[0] - 'a' + 'A');
  }
  return name.replace(at, kAxisMark.size(), axis);
}

/// Returns how often a name contains `{axis}` or `{AXIS}`.
int AxisMarks(const std::string& name) {
  int marks = 0;
  for (const std::string_view mark : {kAxisMark, kCapitalMark}) {
    for (std::size_t at = 0; (at = name.find(mark, at)) != name.npos; ++at) ++marks;
  }
  return marks;
}

class MappingReader {
 public:
  MappingReader(const std::string& path, Diagnostics& out)
      : path_(path), out_(out), values_(path, out) {}

  std::optional<Mapping> Read() {
    const auto text =
        base::ReadInputFile(path_, kMaxBytes, "expected a mapping", out_, base::NamedBy::kUser);
    if (!text) return std::nullopt;
    const Json json = values_.Parse(*text);
    if (good()) Root(json);
    if (!good()) return std::nullopt;
    return std::move(mapping_);
  }

 private:
  bool good() const { return values_.good(); }

  void Root(const Json& root) {
    if (!values_.IsObject(
            root, "",
            {"version", "description", "table", "axes", "channels", "vectors", "quaternions"})) {
      return;
    }
    if (root.value("version", Json()) != 1) {
      values_.Error("mapping.unknown_version", "version",
                    "must be 1, the version of mapping files that this taut reads");
    }
    if (root.contains("description") && !root["description"].is_string()) {
      values_.Error("mapping.description_no_text", "description", "must be a string");
    }
    if (root.contains("table")) mapping_.table = ReadTableLayout(root["table"], values_);
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
    if (!values_.IsObject(root["axes"], "axes", {"x", "y", "z"})) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string text = values_.Text(root["axes"], kAxisNames[i], "axes");
      const bool negative = text.starts_with('-');
      const std::string letter = text.substr(negative ? 1 : 0);
      if (letter != "x" && letter != "y" && letter != "z") {
        values_.Error("mapping.bad_axis", fmt::format("axes.{}", kAxisNames[i]),
                      "must be one of x, y, z, -x, -y, -z");
        return;
      }
      axes_[i] = {letter[0] - 'x', negative ? -1.0 : 1.0};
    }
    if (Handedness(axes_) == 0.0) {
      values_.Error("mapping.duplicate_axis", "axes", "uses an axis twice");
    } else if (Handedness(axes_) < 0.0) {
      values_.Error("mapping.mirrored_axes", "axes", "must be a rotation, not a reflection");
    }
  }

  void Channel(const Json& rule, const std::string& at) {
    Mapping::Rule result{Pattern(rule, "from", at), Pattern(rule, "to", at), Unit(rule, at),
                         values_.Number(rule, "scale", at, 1.0),
                         values_.Number(rule, "offset", at, 0.0)};
    result.scale *= FromUnit(rule, result, at);
    if (rule.contains("wrap")) result.period = Period(rule["wrap"], result, at + ".wrap");
    if (StarsDiffer(result))
      values_.Error("mapping.unpaired_star", at, "has a `*` in only one of \"from\" and \"to\"");
    mapping_.rules.push_back(std::move(result));
  }

  /// Returns the period of wrapped values, in the result's unit.
  double Period(const Json& wrap, const Mapping::Rule& whole, const std::string& at) {
    if (wrap == "turn") {
      const std::string unit = whole.unit.empty() ? UnitOfName(whole.to) : whole.unit;
      if (unit != "rad") {
        values_.Error("mapping.turn_of_no_angle", at,
                      fmt::format("is \"turn\", but the result is in {}, not in rad", unit));
      }
      return 2.0 * std::numbers::pi;
    }
    if (wrap.is_number() && wrap > 0.0) return std::abs(whole.scale) * wrap.get<double>();
    values_.Error("mapping.bad_wrap", at,
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
        values_.Error("mapping.bad_offset", at + ".offset",
                      "must be a list of three numbers, along taut's x, y and z");
        return;
      }
      for (std::size_t i = 0; i < 3; ++i) offset[i] = given[i];
    }
    const double scale = values_.Number(rule, "scale", at, 1.0) * FromUnit(rule, whole, at);
    if (good()) AddComponents(whole, scale, offset);
  }

  /// Returns the conversion factor from `from_unit` to the result's unit.
  double FromUnit(const Json& rule, const Mapping::Rule& whole, const std::string& at) {
    if (!rule.contains("from_unit")) return 1.0;
    const std::string name = values_.Text(rule, "from_unit", at);
    if (name.empty()) return 1.0;
    std::string to = whole.to;
    if (AxisMarks(to) == 1) to = WithAxis(to, "x");
    const std::string wanted = whole.unit.empty() ? UnitOfName(to) : whole.unit;
    return values_.UnitIn(name, wanted, at + ".from_unit");
  }

  /// Converts the vector part of a quaternion to the other axes. The scalar part remains unchanged.
  void Quaternion(const Json& rule, const std::string& at) {
    const Mapping::Rule whole = AxisRule(rule, at);
    if (!good()) return;
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
      if (AxisMarks(text) != 1) {
        values_.Error("mapping.no_axis_place", fmt::format("{}.{}", at, key),
                      "must contain {axis} once, in the place of x, y and z");
      }
    }
    if (StarsDiffer(result))
      values_.Error("mapping.unpaired_star", at, "has a `*` in only one of \"from\" and \"to\"");
    return result;
  }

  static bool StarsDiffer(const Mapping::Rule& rule) {
    return (rule.from.find('*') == std::string::npos) != (rule.to.find('*') == std::string::npos);
  }

  std::string Pattern(const Json& rule, const char* key, const std::string& at) {
    std::string text = values_.Text(rule, key, at);
    if (std::count(text.begin(), text.end(), '*') > 1) {
      values_.Error("mapping.several_stars", fmt::format("{}.{}", at, key),
                    "has more than one `*`");
    }
    return text;
  }

  std::string Unit(const Json& rule, const std::string& at) {
    return rule.contains("unit") ? values_.Text(rule, "unit", at) : std::string();
  }

  template <class Use>
  void ForEach(const Json& root, const char* key, const std::vector<std::string>& keys,
               const Use& use) {
    if (!root.contains(key)) return;
    if (!root[key].is_array())
      return values_.Error("mapping.not_a_list", key, "must be a list [ ... ]");
    for (std::size_t i = 0; i < root[key].size(); ++i) {
      const std::string at = fmt::format("{}[{}]", key, i);
      if (values_.IsObject(root[key][i], at, keys)) use(root[key][i], at);
    }
  }

  const std::string& path_;
  Diagnostics& out_;
  MappingJson values_;
  Axes axes_;
  Mapping mapping_;
};

}  // namespace

std::optional<Mapping> LoadMapping(const std::string& path, Diagnostics& out) {
  return MappingReader(path, out).Read();
}

}  // namespace taut
