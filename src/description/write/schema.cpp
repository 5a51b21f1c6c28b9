// JSON schemas of the formats, generated from the tables of keys.
#include "taut/schema.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/name_unit.h"
#include "description/experiment/experiment_keys.h"
#include "description/gait/gait_keys.h"
#include "description/model/model_keys.h"
#include "description/robot/calibration_keys.h"
#include "description/robot/catalogue_keys.h"
#include "description/robot/fault_keys.h"
#include "description/study/fit_keys.h"
#include "description/study/study_keys.h"
#include "description/yaml/read_keys.h"

namespace taut {
namespace description {
namespace {

/// Returns the text in double quotes.
std::string Json(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

template <class List, class Text>
std::string Joined(const List& items, const Text& text) {
  std::string out;
  for (const auto& item : items) out += (out.empty() ? "" : ", ") + text(item);
  return out;
}

std::string Needs(const std::vector<std::string>& keys) {
  return R"({"required": [)" + Joined(keys, Json) + "]}";
}

std::string OneOfThese(const std::vector<std::string>& keys) {
  return Joined(keys, [](const std::string& key) { return Needs({key}); });
}

/// Definitions common to all formats. The rule for names is in `reader.cpp`.
const std::vector<std::pair<std::string, std::string>> kSpellings{
    {"number",
     R"({"type": ["number", "string"], "title": "number", "description": "A number, or an expression over parameters such as `2.3 * 9.81`."})"},
    {"name",
     R"({"type": ["string", "integer"], "title": "name", "pattern": "^[A-Za-z0-9_-]+$", "description": "Letters, digits, _ and -."})"},
    {"names",
     R"({"title": "name or list of names", "oneOf": [{"$ref": "#/$defs/name"}, {"type": "array", "items": {"$ref": "#/$defs/name"}}]})"},
    {"identifier",
     R"({"type": "string", "title": "identifier", "pattern": "^[A-Za-z_][A-Za-z0-9_]*$", "description": "Letters, digits and _, not starting with a digit."})"},
    {"vector",
     R"({"type": "array", "title": "[x, y, z]", "items": {"$ref": "#/$defs/number"}, "minItems": 3, "maxItems": 3, "description": "Three numbers."})"},
    {"points",
     R"({"type": "array", "title": "[[time_s, value], ...]", "minItems": 1, "items": {"type": "array", "items": {"$ref": "#/$defs/number"}, "minItems": 2, "maxItems": 2}, "description": "Points, linearly interpolated; times [s] are not negative and increase."})"},
    {"patterns",
     R"({"title": "pattern or list of patterns", "oneOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]})"},
    {"tags", R"({"type": "array", "items": {"$ref": "#/$defs/tag"}, "minItems": 1})"},
    {"tag", R"({"type": ["string", "integer"], "pattern": "^[A-Za-z0-9_.-]+$"})"},
    {"selector",
     R"({"title": "selector", "oneOf": [{"$ref": "#/$defs/tag"}, {"$ref": "#/$defs/tags"}, {"type": "array", "items": {"oneOf": [{"$ref": "#/$defs/tag"}, {"$ref": "#/$defs/tags"}]}, "minItems": 1, "contains": {"type": "array"}}], "description": "`a`: all with the tag a. `[a, b]`: all with both tags. `[[a, b], [c]]`: all with any of these sets."})"},
};

/// Definitions of one schema, in the order in which `Begin` adds them.
class Definitions {
 public:
  /// Adds a definition. Returns true if it is new, so that the caller must write it.
  bool Begin(const std::string& name) {
    if (!seen_.insert({name, order_.size()}).second) return false;
    order_.emplace_back(name, "");
    return true;
  }
  void End(const std::string& name, std::string json) {
    order_[seen_.at(name)].second = std::move(json);
  }
  /// Returns all definitions, plus the entries of `kSpellings` that they or `top` refer to.
  std::string Text(const std::string& top) const {
    std::string out;
    for (const auto& [name, json] : order_) out += Line(name, json);
    std::string spellings;
    for (bool more = true; std::exchange(more, false);) {
      for (const auto& [name, json] : kSpellings) {
        const std::string line = Line(name, json), use = "#/$defs/" + name + "\"";
        if (spellings.find(line) != spellings.npos) continue;
        if ((top + out + spellings).find(use) == top.npos) continue;
        spellings += line;
        more = true;
      }
    }
    out += spellings;
    return out.substr(0, out.size() - 2);  // without the last comma and line break
  }

 private:
  static std::string Line(const std::string& name, const std::string& json) {
    return "    " + Json(name) + ": " + json + ",\n";
  }
  std::vector<std::pair<std::string, std::string>> order_;
  std::map<std::string, std::size_t> seen_;
};

std::string Reference(const std::string& name) { return R"("$ref": "#/$defs/)" + name + '"'; }

/// Returns the schema of a number's range. Expressions are not checked.
std::string Range(const Bound& bound) {
  std::string out;
  const auto end = [&](double value, bool open, const char* closed_word, const char* open_word) {
    if (std::isinf(value)) return;
    out += std::string(", \"") + (open ? open_word : closed_word) + "\": " + Shown(value);
  };
  end(bound.least, bound.above_least, "minimum", "exclusiveMinimum");
  end(bound.most, bound.below_most, "maximum", "exclusiveMaximum");
  return out;
}

/// Returns the default of a key (the initial value of its field). Returns an empty text if it has
/// no JSON form.
template <class T>
std::string Default(const T& field) {
  if constexpr (std::same_as<T, bool>) {
    return field ? "true" : "false";
  } else if constexpr (std::same_as<T, double>) {
    return std::isfinite(field) ? Shown(field) : "";
  } else if constexpr (std::integral<T>) {
    return std::to_string(field);
  } else if constexpr (std::same_as<T, Vec3>) {
    return "[" + Shown(field.x) + ", " + Shown(field.y) + ", " + Shown(field.z) + "]";
  } else {
    return {};
  }
}

/// `replaces`: absent keys keep the values of a model, so the schema contains no defaults.
template <class T>
std::string MappingReference(Definitions& definitions, bool replaces = false);

template <class T>
std::string TypeOf(const Key& key, Definitions& definitions) {
  const std::string unit = base::UnitAtEnd(key.name).Text();
  const std::string of_number =
      Range(*key.bound) + (unit.empty() ? "" : ", \"unit\": " + Json(unit));
  if constexpr (std::same_as<T, double>) {
    return Reference("number") + of_number;
  } else if constexpr (std::same_as<T, int> || std::same_as<T, std::uint64_t>) {
    return Reference("number") + R"(, "title": "integer", "multipleOf": 1)" + of_number;
  } else if constexpr (std::same_as<T, bool>) {
    return R"("type": "boolean")";
  } else if constexpr (std::same_as<T, std::string> || std::same_as<T, Placed>) {
    return key.is_name ? Reference("name") : R"("type": "string")";
  } else if constexpr (std::same_as<T, Vec3>) {
    std::string out = Reference("vector");
    if (key.is_direction) out += R"(, "title": "[x, y, z], not zero")";
    const std::string range = Range(*key.bound);
    if (!range.empty()) out += R"(, "items": {)" + Reference("number") + range + "}";
    return out + (unit.empty() ? "" : ", \"unit\": " + Json(unit));
  } else if constexpr (std::same_as<T, Quat>) {
    const std::string one = MappingReference<RotationText>(definitions);
    return R"("title": "rotation", "oneOf": [{)" + one + R"(}, {"type": "array", "items": {)" +
           one + "}}]";
  } else if constexpr (std::same_as<T, std::vector<std::string>>) {
    return Reference("names");
  } else if constexpr (std::same_as<T, std::vector<std::vector<std::string>>>) {
    return Reference("selector");
  } else if constexpr (std::same_as<T, std::vector<double>>) {
    return R"("type": "array", "title": "numbers", "items": {)" + Reference("number") +
           Range(*key.bound) + "}" + (unit.empty() ? "" : ", \"unit\": " + Json(unit));
  } else if constexpr (std::same_as<T, std::vector<Vec3>>) {
    return R"("type": "array", "items": {)" + Reference("vector") + "}" +
           (unit.empty() ? "" : ", \"unit\": " + Json(unit));
  } else if constexpr (std::same_as<T, std::vector<Placed>>) {
    return R"("type": "array", "items": {"type": "string"})";
  } else if constexpr (std::same_as<T, std::pair<double, double>>) {
    return R"("type": "array", "title": "[from, to]", "items": {"$ref": "#/$defs/number"}, "minItems": 2, "maxItems": 2)" +
           (unit.empty() ? "" : ", \"unit\": " + Json(unit));
  } else if constexpr (std::same_as<T, std::vector<std::pair<double, double>>>) {
    return Reference("points") + (unit.empty() ? "" : ", \"unit\": " + Json(unit));
  } else if constexpr (kIsOptional<T>) {
    return TypeOf<typename T::value_type>(key, definitions);
  } else if constexpr (std::same_as<T, std::vector<RouteText>>) {
    return R"("type": "array", "minItems": 2, "items": {"title": "node or element", "oneOf": )"
           R"([{"type": "string"}, {)" +
           MappingReference<RouteText>(definitions) + "}]}";
  } else if constexpr (kIsList<T>) {
    return R"("type": "array", "items": {)" +
           MappingReference<typename T::value_type>(definitions) + "}";
  } else if constexpr (kIsNamed<T>) {
    using Inner = decltype(T::Item::value);
    return R"("type": "object", "additionalProperties": {)" + TypeOf<Inner>(key, definitions) +
           (key.is_name ? R"(}, "propertyNames": {"$ref": "#/$defs/name"})" : "}");
  } else if constexpr (std::same_as<T, NodeText>) {
    return R"("title": "[x, y, z] or node", "oneOf": [{"$ref": "#/$defs/vector"}, {)" +
           MappingReference<T>(definitions) + "}]";
  } else if constexpr (kIsOverlay<T>) {
    return MappingReference<typename T::Mapping>(definitions, true);
  } else if constexpr (kIsRaw<T>) {
    return T::FormType::kSchema + of_number;
  } else {
    return MappingReference<T>(definitions);
  }
}

class SchemaMaker : public KeyVisitor<SchemaMaker, false> {
 public:
  using Line = KeyText;

  explicit SchemaMaker(Definitions& definitions, bool replaces = false)
      : definitions_(definitions), replaces_(replaces) {}

  template <class T>
  void On(const KeyText& key, T& field) {
    Add(key, TypeOf<T>(key, definitions_), Default(field));
  }
  template <class T, class E>
  void On(const KeyText& key, T& field, const Choices<E>& choices) {
    std::string chosen;
    for (const auto& [name, choice] : choices) {
      if constexpr (std::same_as<T, E>) {
        if (choice == field) chosen = Json(name);
      }
    }
    const auto name = [](const auto& choice) { return Json(choice.first); };
    Add(key, R"("enum": [)" + Joined(choices, name) + "]", chosen);
  }
  void Map(const char*, const char* title, const char* meaning, const char* example = nullptr) {
    about_ = R"("title": )" + Json(title) + R"(, "description": )" + Json(meaning);
    if (example) about_ += std::string(R"(, "examples": [)") + example + "]";
  }
  void OneOf(const std::vector<std::string>& keys) {
    rules_.push_back(R"("oneOf": [)" + OneOfThese(keys) + "]");
  }
  void EitherSide(const std::vector<std::string>& one, const std::vector<std::string>& other) {
    const auto any = [](const std::vector<std::string>& keys) {
      return R"({"anyOf": [)" + OneOfThese(keys) + "]}";
    };
    rules_.push_back(R"("oneOf": [)" + any(one) + ", " + any(other) + "]");
  }
  void Rule(const char* json) { rules_.push_back(json); }
  /// Adds all alternative names of a key. Only the reader checks which name is valid.
  template <class OfName>
  void Spell(const Spellings& spellings, const OfName& of_name) {
    spellings_ = &spellings;
    for (spelt_ = 0; spelt_ < Spellings::kCount; ++spelt_) of_name(spellings.names[spelt_]);
    const std::vector<std::string> names(std::begin(spellings.names), std::end(spellings.names));
    rules_.push_back(spelt_needed_ ? R"("oneOf": [)" + OneOfThese(names) + "]"
                                   : R"("not": )" + Needs(names));
    spellings_ = nullptr;
  }

  /// Returns the schema of a map, with `indent` before each line. `whole_file`: the required keys
  /// may come from `base`.
  std::string Text(const std::string& indent, bool whole_file) const {
    std::string needed = Joined(needed_, Json), rules;
    if (rules_.size() == 1) rules = rules_[0];
    if (rules_.size() > 1) {
      rules = "\"allOf\": [" + Joined(rules_, [](auto& rule) { return "{" + rule + "}"; }) + "]";
    }
    if (whole_file) {
      rules = R"("anyOf": [{"required": ["base"]}, {"required": [)" + needed + "]" +
              (rules.empty() ? "" : ", " + rules) + "}]";
      needed = R"("taut", "kind")";
    }
    std::string out =
        about_ + ",\n" + indent + R"("type": "object", "additionalProperties": false)";
    if (!needed.empty()) out += ", \"required\": [" + needed + "]";
    if (!rules.empty()) out += ",\n" + indent + rules;
    out += ",\n" + indent + "\"properties\": {\n";
    for (const std::string& property : properties_) {
      out += indent + "  " + property + (&property == &properties_.back() ? "\n" : ",\n");
    }
    return out + indent + "}";
  }

 private:
  void Add(const KeyText& key, std::string type, const std::string& fallback) {
    if (!fallback.empty() && !key.needed && !key.inherited && !replaces_)
      type += ", \"default\": " + fallback;
    if (*key.meaning) type += ", \"description\": " + Json(Meaning(key));
    if (key.example) type += std::string(", \"examples\": [") + key.example + "]";
    properties_.push_back(Json(key.name) + ": {" + type + "}");
    spelt_needed_ = key.needed;
    if (key.needed && !spellings_) needed_.push_back(key.name);
  }
  std::string Meaning(const KeyText& key) const {
    if (!spellings_) return key.meaning;
    const std::string in = spellings_->when[spelt_] + std::string(".");
    return key.meaning + ((key.needed ? " Required in " : " In ") + in);
  }

  Definitions& definitions_;
  bool replaces_;
  const Spellings* spellings_ = nullptr;  ///< Alternative names of the present key; null if it has
                                          ///< only one name.
  int spelt_ = 0;
  bool spelt_needed_ = false;
  std::string about_;
  std::vector<std::string> needed_, rules_, properties_;
};

/// Finds the heading of a key table.
class TitleFinder : public KeyVisitor<TitleFinder, false> {
 public:
  template <class T, class... Choices>
  void On(const Key&, const T&, const Choices&...) {}
  void Map(const char*, const char* heading, const char*, const char* = nullptr) {
    title = heading;
  }
  std::string title;
};

template <class T>
std::string MappingReference(Definitions& definitions, bool replaces) {
  T defaults{};
  TitleFinder finder;
  Keys(finder, defaults);
  if (definitions.Begin(finder.title)) {
    SchemaMaker maker(definitions, replaces);
    Keys(maker, defaults);
    definitions.End(finder.title, "{\n      " + maker.Text("      ", false) + "\n    }");
  }
  return Reference(finder.title);
}

template <class T>
std::string Schema() {
  Definitions definitions;
  SchemaMaker maker(definitions);
  T defaults{};
  Keys(maker, defaults);
  const std::string top = maker.Text("  ", true);
  return "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  " + top +
         ",\n  \"$defs\": {\n" + definitions.Text(top) + "\n  }\n}\n";
}

}  // namespace
}  // namespace description

const std::vector<std::string>& FormatNames() {
  static const std::vector<std::string> names{"model", "experiment", "gait",        "study",
                                              "fit",   "faults",     "calibration", "catalogue"};
  return names;
}

std::optional<std::string> FormatSchema(std::string_view format) {
  if (format == "model") return description::Schema<description::ModelText>();
  if (format == "experiment") return description::Schema<description::ExperimentText>();
  if (format == "gait") return description::Schema<description::GaitText>();
  if (format == "study") return description::Schema<description::StudyFileText>();
  if (format == "fit") return description::Schema<description::FitFileText>();
  if (format == "faults") return description::Schema<description::FaultFileText>();
  if (format == "calibration") return description::Schema<description::CalibrationFileText>();
  if (format == "catalogue") return description::Schema<description::CatalogueFileText>();
  return std::nullopt;
}

}  // namespace taut
