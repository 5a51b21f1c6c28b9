#include "compare/mapping_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/foreign_units.h"
#include "base/input_file.h"

namespace taut {

MappingJson::Json MappingJson::Parse(const std::string& text) {
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
    return Json::parse(text, watch, true, true);
  } catch (const Json::exception& failure) {
    const std::string what = failure.what();  // "[json...] parse error at line 1, ...: ..."
    Error("mapping.not_json", "", "the mapping is not JSON: " + what.substr(what.find("] ") + 2));
    return {};
  }
}

void MappingJson::Error(MessageId id, const std::string& at, const std::string& what,
                        std::string hint) {
  out_.Error(id, {path_}, at.empty() ? what : at + " " + what, std::move(hint));
  good_ = false;
}

std::string MappingJson::Text(const Json& object, const char* key, const std::string& at) {
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

double MappingJson::Number(const Json& object, const char* key, const std::string& at,
                           double otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  if (found->is_number()) return *found;
  Error("mapping.not_a_number", fmt::format("{}.{}", at, key), "must be a number");
  return otherwise;
}

bool MappingJson::IsObject(const Json& json, const std::string& at,
                           const std::vector<std::string>& keys) {
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

double MappingJson::UnitIn(const std::string& name, const std::string& wanted,
                           const std::string& at) {
  const auto unit = base::FindUnit(name);
  if (!unit) {
    Error("mapping.unknown_unit", at, fmt::format("is the unknown unit \"{}\"", name),
          DidYouMean(name, base::UnitNames()));
  } else if (unit->si != wanted) {
    Error("mapping.wrong_unit", at, fmt::format("is {}, but the result is in {}", name, wanted));
  }
  return unit ? unit->factor : 1.0;
}

}  // namespace taut
