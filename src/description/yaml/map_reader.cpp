// Checks of the keys of a map: required keys, unknown keys with suggested fixes, conditions on
// several keys.
#include <algorithm>
#include <limits>
#include <utility>

#include "base/foreign_units.h"
#include "description/yaml/reader.h"

namespace taut::description {
namespace {

std::string Joined(const std::vector<std::string>& words, std::string_view between) {
  std::string out;
  for (const std::string& word : words) (out += out.empty() ? "" : between) += word;
  return out;
}

/// Fix for an unknown key, and the known keys that the fix mentions.
struct KeyFix {
  std::string hint;
  std::vector<std::string> meant;
};

KeyFix SimilarKeys(std::string_view key, const std::vector<std::string>& known) {
  KeyFix fix;
  for (const std::string& candidate : known) {
    if (candidate.size() > key.size() && candidate.compare(0, key.size(), key) == 0 &&
        candidate[key.size()] == '_') {
      fix.meant.push_back(candidate);
    }
  }
  if (!fix.meant.empty()) {
    fix.hint = "did you mean \"" + Joined(fix.meant, "\" or \"") + "\"?";
    return fix;
  }
  fix.hint = NameHint(key, known);
  const std::string closest(fix.hint.empty() ? std::string_view() : ClosestMatch(key, known));
  if (!closest.empty()) fix.meant.push_back(closest);
  return fix;
}

/// Returns the end of a key with this unit: "_n_per_mm" for "N/mm".
std::string KeyEnd(const std::string& unit) {
  std::string end = "_";
  for (const char c : unit) {
    if (c == '/') {
      end += "_per_";
    } else if (c != '^') {
      end += c == ' ' ? '_' : static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    }
  }
  return end;
}

/// Returns the fix for an unknown key: the key with taut's unit and the value with its unit (for
/// `radius_mm: 4`, `radius_m: 4 mm`), a synonym, or the key with the most similar name.
KeyFix FixOf(const Entry& entry, const std::vector<std::string>& known) {
  const std::string& key = entry.key;
  const auto is_known = [&](const std::string& one) {
    return std::find(known.begin(), known.end(), one) != known.end();
  };
  std::size_t longest = 0;
  KeyFix converted;
  for (const base::ForeignUnit& unit : base::Units()) {
    const std::string end = KeyEnd(unit.name);
    if (end.size() <= longest || !key.ends_with(end)) continue;
    const std::string other = key.substr(0, key.size() - end.size()) + KeyEnd(unit.si);
    if (!is_known(other)) continue;
    longest = end.size();
    const std::string value = entry.value->kind == Value::Kind::kScalar ? entry.value->text : "...";
    converted = {"write \"" + other + ": " + value + " " + unit.name + "\"", {other}};
  }
  if (longest > 0) return converted;
  for (const char* const theirs : {"pretension_n", "pretension"}) {
    if (key == theirs && is_known("prestress_n")) {
      return {"did you mean \"prestress_n\"?", {"prestress_n"}};
    }
  }
  return SimilarKeys(key, known);
}

}  // namespace

std::string KeyHint(std::string_view key, const std::vector<std::string>& known) {
  return SimilarKeys(key, known).hint;
}

MapReader::MapReader(const Value& value, std::string what, const Scope& scope)
    : value_(value), what_(std::move(what)), scope_(scope) {}

MapReader::MapReader(const MapReader& other, Diagnostics& out)
    : value_(other.value_),
      what_(other.what_),
      known_(other.known_),
      meant_(other.meant_),
      knows_all_(other.knows_all_),
      scope_{other.scope_.names, out, other.scope_.used, other.scope_.spelling, other.scope_.unit} {
}

void MapReader::Know(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
}

void MapReader::RefuseOthers() {
  if (!is_map()) {
    WrongType(value_, what_.empty() ? "the file" : what_, "a map", scope_);
    return;
  }
  for (const Entry& entry : value_.entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    KeyFix fix = FixOf(entry, known_);
    scope_.out.Error("key.unknown", entry.key_at,
                     "unknown key \"" + entry.key + "\"" + (what_.empty() ? "" : " in " + what_),
                     std::move(fix.hint));
    meant_.insert(meant_.end(), fix.meant.begin(), fix.meant.end());
  }
  knows_all_ = true;
  const std::vector<Missing> missing = std::move(missing_);
  for (const Missing& one : missing) ReportMissing(one);
}

void MapReader::ReportMissing(const Missing& missing) const {
  if (!knows_all_) {
    missing_.push_back(missing);
    return;
  }
  const std::vector<std::string>& keys = missing.keys;
  const auto is_meant = [&](const std::string& key) {
    return std::find(meant_.begin(), meant_.end(), key) != meant_.end();
  };
  if (std::any_of(keys.begin(), keys.end(), is_meant)) return;
  const std::string what = what_.empty() ? "the file" : what_;
  if (!missing.one_of) {
    scope_.out.Error("key.missing", at(), what + " needs the key \"" + keys.front() + "\"");
    return;
  }
  scope_.out.Error("key.one_of_missing", at(),
                   what + " needs " + (keys.size() == 1 ? "" : "one of ") + Joined(keys, ", "));
}

void MapReader::CheckWith(const std::function<void(const MapReader&)>& check) const {
  if (meant_.empty()) return check(*this);
  Diagnostics found;
  check(MapReader(*this, found));
  const auto is_own = [&](const SourceRef& where) {
    const auto same = [&](const SourceRef& other) {
      return where.file == other.file && where.line == other.line && where.column == other.column;
    };
    return same(value_.at) || std::any_of(value_.entries.begin(), value_.entries.end(),
                                          [&](const Entry& entry) { return same(entry.key_at); });
  };
  for (const Diagnostic& error : found.items()) {
    if (!is_own(error.at)) scope_.out.AddError(error);
  }
  for (const Diagnostic& warning : found.warnings()) scope_.out.AddWarning(warning);
}

std::string MapReader::Path(std::string_view key) const {
  return what_.empty() ? std::string(key) : what_ + "." + std::string(key);
}

const Value* MapReader::Find(std::string_view key) const { return value_.Find(key); }

bool MapReader::HasAnyBut(std::string_view key) const {
  return std::any_of(known_.begin(), known_.end(),
                     [&](const std::string& known) { return known != key && Has(known); });
}

const Value* MapReader::Require(std::string_view key) const {
  const Value* found = Find(key);
  if (!found && is_map()) ReportMissing({{std::string(key)}, false});
  return found;
}

SourceRef MapReader::KeyAt(std::string_view key) const { return description::KeyAt(value_, key); }

void MapReader::Error(MessageId id, std::string_view key, std::string what,
                      std::string hint) const {
  scope_.out.Error(id, KeyAt(key), std::move(what), std::move(hint));
}

std::string MapReader::ExactlyOne(const std::vector<std::string>& keys) const {
  if (!is_map()) return {};
  std::vector<std::string> present;
  for (const std::string& key : keys) {
    if (Has(key)) present.push_back(key);
  }
  if (present.size() == 1) return present[0];
  if (present.empty()) {
    ReportMissing({keys, true});
  } else {
    const std::string what = what_.empty() ? "the file" : what_;
    Error("key.both_given", present[1], what + " has both " + Joined(present, " and "),
          "give only one of them");
  }
  return {};
}

double MapReader::Number(std::string_view key, const Bound& bound) const {
  const Value* found = Require(key);
  return found ? ReadNumber(*found, Path(key), bound, scope_)
               : std::numeric_limits<double>::quiet_NaN();
}

double MapReader::NumberOr(std::string_view key, double fallback, const Bound& bound) const {
  const Value* found = Find(key);
  return found ? ReadNumber(*found, Path(key), bound, scope_) : fallback;
}

}  // namespace taut::description
