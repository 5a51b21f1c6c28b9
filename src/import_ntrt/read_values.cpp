// Readers of single values in NTRT's structure files: numbers, points, maps, lists, pairs of names.
#include <cmath>

#include "description/gait/gait_parts.h"
#include "description/yaml/reader.h"
#include "import_ntrt/read.h"

namespace taut::import_ntrt {

double ReadPlain(const Value& value, std::string_view what, Diagnostics& out) {
  double number = NAN;
  const std::string text = value.text.starts_with('+') ? value.text.substr(1) : value.text;
  if (value.kind != Value::Kind::kScalar || !description::ToNumber(text, number)) {
    out.Error("ntrt.not_a_number", value.at,
              std::string(what) + " must be a number" +
                  (value.text.empty() ? "" : ", not \"" + value.text + "\""));
    return NAN;
  }
  if (std::fabs(number) > kFarthest) {
    out.Error("ntrt.number_too_large", value.at,
              std::string(what) + " is too large: " + value.text);
    return NAN;
  }
  return number;
}

Vec3 ReadPoint(const Value& value, std::string_view what, Diagnostics& out) {
  if (value.kind != Value::Kind::kSequence || value.items.size() != 3) {
    out.Error("ntrt.not_a_vector", value.at, std::string(what) + " must be [x, y, z]");
    return {NAN, NAN, NAN};
  }
  return {ReadPlain(*value.items[0], what, out), ReadPlain(*value.items[1], what, out),
          ReadPlain(*value.items[2], what, out)};
}

const std::vector<Entry>& MapOf(const Value* value, std::string_view what, Diagnostics& out) {
  static const std::vector<Entry> kNone;
  if (!value || value->kind == Value::Kind::kNull) return kNone;
  if (value->kind == Value::Kind::kMap) return value->entries;
  out.Error(
      "ntrt.not_a_map", value->at,
      std::string(what) + " must be a map, not " + std::string(description::KindName(*value)));
  return kNone;
}

const std::vector<ValuePtr>& ListOf(const Value* value, std::string_view what, Diagnostics& out) {
  static const std::vector<ValuePtr> kNone;
  if (!value || value->kind == Value::Kind::kNull) return kNone;
  if (value->kind == Value::Kind::kSequence) return value->items;
  out.Error(
      "ntrt.not_a_list", value->at,
      std::string(what) + " must be a list, not " + std::string(description::KindName(*value)));
  return kNone;
}

void OnlyKeys(const Value& map, const std::vector<std::string>& known, Diagnostics& out) {
  for (const Entry& entry : map.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    out.Error("ntrt.unknown_key", entry.key_at, "unknown key \"" + entry.key + "\"",
              DidYouMean(entry.key, known));
  }
}

std::vector<std::string> AtSlashes(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t slash; (slash = text.find('/', begin)) != text.npos; begin = slash + 1) {
    parts.push_back(text.substr(begin, slash - begin));
  }
  parts.push_back(text.substr(begin));
  return parts;
}

bool ReadTwo(const Value& value, std::string& a, std::string& b, Diagnostics& out) {
  const bool two = value.kind == Value::Kind::kSequence && value.items.size() == 2 &&
                   value.items[0]->kind == Value::Kind::kScalar &&
                   value.items[1]->kind == Value::Kind::kScalar;
  if (two) {
    a = value.items[0]->text;
    b = value.items[1]->text;
  } else {
    out.Error("ntrt.bad_pair", value.at, "a pair must be two names, such as [bottom, top]");
  }
  return two;
}

}  // namespace taut::import_ntrt
