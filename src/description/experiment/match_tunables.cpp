#include "description/experiment/match_tunables.h"

#include <set>

#include "base/pattern.h"

namespace taut::description {

std::vector<std::size_t> MatchTunables(const Value& value, const std::string& what,
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
    scope.out.Error("tunable.unknown_name", pattern->at,
                    what + ": there is no parameter \"" + text + "\"", hint);
  }
  return {found.begin(), found.end()};
}

}  // namespace taut::description
