// Search methods of a study.
#include "description/study/study_parts.h"

namespace taut {

const std::vector<std::string>& NloptAlgorithms() {
  static const std::vector<std::string> names{"nelder_mead", "subplex", "bobyqa", "cobyla"};
  return names;
}

namespace description {
namespace {

/// Returns the search method and its settings.
SearchSpec ToSearch(const SearchText& text) {
  SearchSpec search{MonteCarloSpec{}, text.evaluations, text.batch};
  if (text.method == Method::kHillClimbing) {
    HillClimbingSpec hill;
    hill.deviation = text.deviation.value_or(hill.deviation);
    hill.adapt = text.adapt;
    search.method = hill;
  } else if (text.method == Method::kNlopt) {
    search.method = NloptSpec{text.algorithm, text.starts, text.initial_step};
    search.batch = text.starts;
  } else if (text.method == Method::kCmaEs) {
    CmaEsSpec cma;
    cma.deviation = text.deviation.value_or(cma.deviation);
    search.method = cma;
  }
  return search;
}

}  // namespace

const Choices<std::string>& NloptChoices() {
  static const Choices<std::string> choices = [] {
    Choices<std::string> all;
    for (const std::string& name : NloptAlgorithms()) all.emplace_back(name, name);
    return all;
  }();
  return choices;
}

void Check(const MapReader& map, SearchText& search) {
  const auto only = [&](std::string_view key, Method owner, const char* who) {
    if (map.Has(key) && search.method != owner) {
      map.Error("search.key_without_effect", key,
                "search." + std::string(key) + " has no effect here",
                "it is for `method: " + std::string(who) + "`");
    }
  };
  only("adapt", Method::kHillClimbing, "hill_climbing");
  only("algorithm", Method::kNlopt, "nlopt");
  only("starts", Method::kNlopt, "nlopt");
  only("initial_step", Method::kNlopt, "nlopt");
  if (search.method == Method::kMonteCarlo && map.Has("deviation")) {
    map.Error("search.key_without_effect", "deviation", "search.deviation has no effect here",
              "it is for hill_climbing and cma_es");
  }
  if (search.method == Method::kNlopt && (map.Has("batch") || map.Has("deviation"))) {
    map.Error("search.key_without_effect", map.Has("batch") ? "batch" : "deviation",
              "search: nlopt uses neither batch nor deviation", "use `starts` and `initial_step`");
  }
  if (search.method == Method::kCmaEs && search.batch < 4) {
    map.scope().out.Error(
        "search.batch_too_small", map.Find("batch")->at,
        "search.batch must be at least 4 for cma_es, got " + std::to_string(search.batch),
        "it is the population");
  }
  if (map.Has("algorithm")) search.algorithm_at = map.Find("algorithm")->at;
}

void Check(const MapReader& map, ObjectiveText& objective) {
  objective.from_at = map.KeyAt("from_s");
  objective.measure_at = map.KeyAt("measure");
  CheckObjective(map, objective);
}

std::vector<SearchSpec> ToSearches(const Value* list, const std::vector<SearchText>& texts,
                                   std::size_t dimensions, const Scope& scope) {
  std::vector<SearchSpec> out;
  for (const SearchText& text : texts) {
    out.push_back(ToSearch(text));
    if (dimensions == 1 && text.method == Method::kNlopt && text.algorithm == "bobyqa") {
      scope.out.Error("search.few_parameters", text.algorithm_at,
                      "search.algorithm: bobyqa needs two parameters or more", "use nelder_mead");
    }
  }
  if (list && list->kind == Value::Kind::kSequence && list->items.empty()) {
    scope.out.Error("search.empty", list->at, "search is empty: there is nothing to do",
                    "such as [{method: monte_carlo, evaluations: 100}]");
  }
  return out;
}

}  // namespace description
}  // namespace taut
