#include <cmath>
#include <map>
#include <set>

#include "base/pattern.h"
#include "description/study_parts.h"

namespace taut::description {
namespace {

constexpr std::size_t kMostParameters = 1000;

/// Which tunables patterns stand for. Empty after a complaint.
std::vector<std::size_t> Match(const Value& value, const std::string& what,
                               const std::vector<Tunable>& tunables, const Scope& scope) {
  std::vector<const Value*> patterns;
  if (value.kind == Value::Kind::kSequence) {
    for (const ValuePtr& item : value.items) patterns.push_back(item.get());
  } else {
    patterns.push_back(&value);
  }
  std::set<std::size_t> found;
  for (const Value* pattern : patterns) {
    const std::string text = ReadText(*pattern, what, scope);
    if (pattern->kind != Value::Kind::kScalar) continue;
    std::vector<std::string> names;
    bool any = false;
    for (std::size_t i = 0; i < tunables.size(); ++i) {
      names.push_back(tunables[i].name);
      if (!base::FitsAny({text}, tunables[i].name)) continue;
      found.insert(i);
      any = true;
    }
    if (any) continue;
    std::string hint = NameHint(text, names);
    if (hint.size() > 200) hint = "`taut learn --parameters EXPERIMENT` lists them all";
    scope.out.Error(pattern->at, what + ": nothing is called \"" + text + "\"", hint);
  }
  return {found.begin(), found.end()};
}

struct Bounds {
  double low = 0, high = 0;
  bool log = false, good = false;
};

Bounds ReadBounds(const MapReader& map) {
  Bounds bounds;
  bounds.low = map.Number("low", Bound::kAny);
  bounds.high = map.Number("high", Bound::kAny);
  bounds.log = map.ChoiceOr<bool>("scale", false, {{"linear", false}, {"log", true}});
  if (std::isnan(bounds.low) || std::isnan(bounds.high)) return bounds;
  bounds.good = true;
  if (!(bounds.low < bounds.high)) {
    map.Error("low",
              bounds.low == bounds.high
                  ? "vary: nothing lies between low and high, both " + Shown(bounds.low)
                  : "vary: low " + Shown(bounds.low) + " is above high " + Shown(bounds.high),
              "to keep a number fixed, write it in the experiment");
    bounds.good = false;
  }
  if (bounds.log && !(bounds.low > 0)) {
    map.Error("low", "vary: scale: log needs bounds above 0, got " + Shown(bounds.low));
    bounds.good = false;
  }
  return bounds;
}

}  // namespace

std::vector<StudyParameter> ReadVary(const Value* list, const std::vector<Tunable>* tunables,
                                     const Scope& scope) {
  std::vector<StudyParameter> out;
  std::map<std::size_t, SourceRef> taken;
  std::set<std::string> names;
  if (!list) return out;
  for (const ValuePtr& item : Items(list, "vary", scope)) {
    const MapReader map(*item, "vary", {"name", "each", "all", "low", "high", "scale"}, scope);
    const std::string key = map.ExactlyOne({"each", "all"});
    const Bounds bounds = ReadBounds(map);
    const std::string name = map.NameOr("name", "");
    if (key.empty() || !tunables) continue;
    const auto found = Match(*map.Find(key), map.Path(key), *tunables, scope);
    for (const std::size_t i : found) {
      const Tunable& tunable = (*tunables)[i];
      const auto [first, fresh] = taken.emplace(i, item->at);
      if (!fresh) {
        map.Error(key, "vary: " + tunable.name + " is varied twice",
                  "first in line " + std::to_string(first->second.line));
      }
      if (bounds.good && (bounds.low < tunable.min || bounds.high > tunable.max)) {
        map.Error(key, "vary: " + tunable.name + " must stay within " + Shown(tunable.min) + ".." +
                           Shown(tunable.max) + " " + tunable.unit);
        break;
      }
    }
    const auto add = [&](const std::string& wanted, const std::vector<std::size_t>& chosen) {
      std::vector<std::string> targets;
      for (const std::size_t i : chosen) targets.push_back((*tunables)[i].name);
      StudyParameter parameter{
          wanted,    (*tunables)[chosen[0]].unit, std::move(targets), bounds.low, bounds.high,
          bounds.log};
      if (!names.insert(wanted).second) {
        map.Error("name", "vary: two parameters are called " + wanted);
      }
      out.push_back(std::move(parameter));
    };
    if (key == "all" && !found.empty()) {
      add(name.empty() ? (*tunables)[found[0]].name : name, found);
    }
    for (std::size_t i = 0; key == "each" && i < found.size(); ++i) {
      add((name.empty() ? "" : name + ".") + (*tunables)[found[i]].name, {found[i]});
    }
  }
  if (out.size() > kMostParameters) {
    scope.out.Error(
        list->at, "vary: " + std::to_string(out.size()) + " parameters are too many, at most 1000",
        "let groups share one: `all` instead of `each`");
  }
  if (list->kind == Value::Kind::kSequence && list->items.empty()) {
    scope.out.Error(list->at, "vary is empty: there is nothing to learn");
  }
  return out;
}

}  // namespace taut::description
