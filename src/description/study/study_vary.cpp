// Varied parameters of a study.
#include <cmath>
#include <map>
#include <set>

#include "description/experiment/match_tunables.h"
#include "description/study/study_parts.h"

namespace taut::description {

namespace {

constexpr std::size_t kMostParameters = 1000;

/// Reports invalid bounds. Returns whether they are a valid range.
bool HasRoom(const VaryText& vary, const Scope& scope) {
  if (std::isnan(vary.low) || std::isnan(vary.high)) return false;
  bool good = true;
  if (!(vary.low < vary.high)) {
    scope.out.Error("vary.empty_range", vary.low_at,
                    vary.low == vary.high
                        ? "vary: low and high are equal, both " + Shown(vary.low)
                        : "vary: low " + Shown(vary.low) + " is above high " + Shown(vary.high),
                    "to keep a parameter fixed, set it in the experiment");
    good = false;
  }
  if (vary.log && !(vary.low > 0)) {
    scope.out.Error("vary.log_not_positive", vary.low_at,
                    "vary: `scale: log` needs bounds above 0, got " + Shown(vary.low));
    good = false;
  }
  return good;
}

}  // namespace

void Check(const MapReader& map, VaryText& vary) {
  vary.low_at = map.KeyAt("low");
  vary.name_at = map.KeyAt("name");
  vary.pattern_at = map.KeyAt(vary.each.value ? "each" : "all");
}

std::vector<StudyParameter> ToParameters(const Value* list, const std::vector<VaryText>& texts,
                                         const std::vector<Tunable>* tunables, const Scope& scope) {
  std::vector<StudyParameter> out;
  std::map<std::size_t, SourceRef> taken;
  std::set<std::string> names;
  for (const VaryText& vary : texts) {
    if (out.size() > kMostParameters) break;  // further entries would repeat the error
    const bool each = vary.each.value, good = HasRoom(vary, scope);
    if (each == (vary.all.value != nullptr) || !tunables) continue;
    const auto found = MatchTunables(each ? *vary.each.value : *vary.all.value,
                                     each ? "vary.each" : "vary.all", *tunables, scope);
    for (const std::size_t i : found) {
      const Tunable& tunable = (*tunables)[i];
      const auto [first, fresh] = taken.emplace(i, vary.at);
      if (!fresh) {
        scope.out.Error("vary.duplicate", vary.pattern_at,
                        "vary: " + tunable.name + " is varied twice",
                        "first in line " + std::to_string(first->second.line));
      }
      if (good && (vary.low < tunable.min || vary.high > tunable.max)) {
        scope.out.Error("vary.out_of_range", vary.pattern_at,
                        "vary: " + tunable.name + " must stay within " + Shown(tunable.min) + ".." +
                            Shown(tunable.max) + " " + tunable.unit);
        break;
      }
    }
    const auto add = [&](const std::string& wanted, const std::vector<std::size_t>& chosen) {
      std::vector<std::string> targets;
      for (const std::size_t i : chosen) targets.push_back((*tunables)[i].name);
      if (!names.insert(wanted).second) {
        scope.out.Error("vary.duplicate_name", vary.name_at,
                        "vary: two parameters are called " + wanted);
      }
      out.push_back(
          {wanted, (*tunables)[chosen[0]].unit, std::move(targets), vary.low, vary.high, vary.log});
    };
    if (!each && !found.empty()) {
      add(vary.name.empty() ? (*tunables)[found[0]].name : vary.name, found);
    }
    for (std::size_t i = 0; each && i < found.size(); ++i) {
      add((vary.name.empty() ? "" : vary.name + ".") + (*tunables)[found[i]].name, {found[i]});
    }
  }
  if (out.size() > kMostParameters) {
    scope.out.Error("vary.too_many", list->at,
                    "vary has more than " + std::to_string(kMostParameters) + " parameters",
                    "use `all` instead of `each`, so that groups share a parameter");
  }
  if (list && list->kind == Value::Kind::kSequence && list->items.empty()) {
    scope.out.Error("vary.empty", list->at, "vary is empty: there is nothing to learn");
  }
  return out;
}

}  // namespace taut::description
