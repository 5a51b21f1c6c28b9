#include <algorithm>
#include <cmath>

#include "description/experiment_parts.h"
#include "description/study_parts.h"

namespace taut {

const std::vector<std::string>& NloptAlgorithms() {
  static const std::vector<std::string> names{"nelder_mead", "subplex", "bobyqa", "cobyla"};
  return names;
}

namespace description {
namespace {

const std::vector<std::pair<std::string, Measure>> kMeasures{
    {"distance", Measure::kDistance},
    {"heading", Measure::kHeading},
    {"distance_per_energy", Measure::kDistancePerEnergy},
    {"tracking", Measure::kTracking}};

FallSpec ReadFall(const Value& value, const Scope& scope) {
  const MapReader map(value, "objective.fall",
                      {"max_tilt_rad", "min_height_m", "max_height_m", "penalty"}, scope);
  FallSpec fall;
  fall.max_tilt_rad = map.NumberOr("max_tilt_rad", fall.max_tilt_rad, Bound::kPositive);
  if (fall.max_tilt_rad > FallSpec().max_tilt_rad + 1e-12) {
    map.Error("max_tilt_rad", "objective.fall.max_tilt_rad must not be above pi");
  }
  fall.min_height_m = map.FindNumber("min_height_m", Bound::kAny);
  fall.max_height_m = map.FindNumber("max_height_m", Bound::kAny);
  if (fall.min_height_m && fall.max_height_m && *fall.min_height_m >= *fall.max_height_m) {
    map.Error("min_height_m", "objective.fall: min_height_m " + Shown(*fall.min_height_m) +
                                  " is not below max_height_m " + Shown(*fall.max_height_m));
  }
  fall.penalty = map.Number("penalty", Bound::kNonNegative);
  return fall;
}

int ReadCount(const MapReader& map, std::string_view key, int fallback, int least, int most) {
  const Value* value = map.Find(key);
  if (!value) return fallback;
  return ReadInteger(*value, map.Path(key), least, most, map.scope()).value_or(fallback);
}

SearchSpec ReadSearch(const Value& value, std::size_t dimensions, const Scope& scope) {
  const MapReader map(value, "search",
                      {"method", "evaluations", "batch", "deviation", "adapt", "algorithm",
                       "starts", "initial_step"},
                      scope);
  SearchSpec search;
  enum class Kind { kMonteCarlo, kHillClimbing, kNlopt, kCmaEs };
  const auto kind = map.ChoiceOr<Kind>("method", Kind::kMonteCarlo,
                                       {{"monte_carlo", Kind::kMonteCarlo},
                                        {"hill_climbing", Kind::kHillClimbing},
                                        {"nlopt", Kind::kNlopt},
                                        {"cma_es", Kind::kCmaEs}});
  map.Require("method");
  map.Require("evaluations");
  search.evaluations = ReadCount(map, "evaluations", 1, 1, 1'000'000'000);
  search.batch = ReadCount(map, "batch", search.batch, kind == Kind::kCmaEs ? 4 : 1, 100'000);
  const auto only = [&](std::string_view key, Kind owner, const char* who) {
    if (map.Has(key) && kind != owner) {
      map.Error(key, "search." + std::string(key) + " has no effect here",
                "it belongs to method: " + std::string(who));
    }
  };
  only("adapt", Kind::kHillClimbing, "hill_climbing");
  only("algorithm", Kind::kNlopt, "nlopt");
  only("starts", Kind::kNlopt, "nlopt");
  only("initial_step", Kind::kNlopt, "nlopt");
  const auto deviation = [&](double fallback) {
    const double read = map.NumberOr("deviation", fallback, Bound::kPositive);
    if (read > 10)
      map.Error("deviation", "search.deviation is in widths of the bounds: at most 10");
    return read;
  };
  switch (kind) {
    case Kind::kMonteCarlo:
      if (map.Has("deviation")) {
        map.Error("deviation", "search.deviation has no effect here",
                  "it belongs to hill_climbing and cma_es");
      }
      search.method = MonteCarloSpec{};
      break;
    case Kind::kHillClimbing: {
      HillClimbingSpec hill;
      hill.deviation = deviation(hill.deviation);
      if (const Value* adapt = map.Find("adapt")) {
        hill.adapt = ReadBool(*adapt, map.Path("adapt"), scope).value_or(true);
      }
      search.method = hill;
      break;
    }
    case Kind::kNlopt: {
      NloptSpec nlopt;
      if (const Value* name = map.Find("algorithm")) {
        std::vector<std::pair<std::string, std::string>> choices;
        for (const std::string& known : NloptAlgorithms()) choices.emplace_back(known, known);
        nlopt.algorithm = ReadChoice<std::string>(*name, map.Path("algorithm"), choices, scope)
                              .value_or(nlopt.algorithm);
        if (dimensions == 1 && nlopt.algorithm == "bobyqa") {
          scope.out.Error(name->at, "search.algorithm: bobyqa needs two parameters or more",
                          "take nelder_mead");
        }
      }
      nlopt.starts = ReadCount(map, "starts", nlopt.starts, 1, 1000);
      nlopt.initial_step = map.NumberOr("initial_step", nlopt.initial_step, Bound::kPositive);
      if (nlopt.initial_step > 0.5) {
        map.Error("initial_step", "search.initial_step must not be above 0.5, half the bounds");
      }
      if (map.Has("batch") || map.Has("deviation")) {
        map.Error(map.Has("batch") ? "batch" : "deviation",
                  "search: nlopt has neither batch nor deviation",
                  "it runs `starts` side by side, with steps of `initial_step`");
      }
      search.batch = nlopt.starts;
      search.method = nlopt;
      break;
    }
    case Kind::kCmaEs: {
      CmaEsSpec cma;
      cma.deviation = deviation(cma.deviation);
      search.method = cma;
      break;
    }
  }
  return search;
}

}  // namespace

ObjectiveSpec ReadObjective(const Value& value, double duration_s, const Scope& scope) {
  const MapReader map(
      value, "objective",
      {"measure", "direction", "from_s", "tension_limit", "fall", "max_speed_m_per_s"}, scope);
  ObjectiveSpec out;
  map.Require("measure");
  out.measure = map.ChoiceOr<Measure>("measure", Measure::kDistance, kMeasures);
  const Value* direction = map.Find("direction");
  if (direction) out.direction = ReadDirection(*direction, map.Path("direction"), scope);
  if (!direction && out.measure == Measure::kHeading) {
    map.Error("measure", "objective: heading needs the key \"direction\"", "such as [1, 0, 0]");
  }
  out.from_s = map.NumberOr("from_s", 0.0, Bound::kNonNegative);
  if (out.from_s >= duration_s) {
    map.Error("from_s", "objective.from_s is not before the experiment's end",
              "that is at " + Shown(duration_s) + " s");
  }
  if (const Value* limit = map.Find("tension_limit")) {
    const MapReader inner(*limit, "objective.tension_limit", {"limit_n", "penalty_per_n"}, scope);
    out.tension_limit = TensionLimit{inner.Number("limit_n", Bound::kPositive),
                                     inner.Number("penalty_per_n", Bound::kNonNegative)};
  }
  if (const Value* fall = map.Find("fall")) out.fall = ReadFall(*fall, scope);
  out.max_speed_m_per_s =
      map.NumberOr("max_speed_m_per_s", out.max_speed_m_per_s, Bound::kPositive);
  return out;
}

PerturbationSpec ReadPerturbation(const Value& value, const Scope& scope) {
  const MapReader map(
      value, "worlds",
      {"count", "friction", "mass", "stiffness", "damping", "start", "redraw", "score"}, scope);
  PerturbationSpec out;
  map.Require("count");
  out.worlds = ReadCount(map, "count", 1, 1, 1000);
  const auto share = [&](std::string_view key) {
    const double read = map.NumberOr(key, 0.0, Bound::kNonNegative);
    if (read >= 1.0) {
      map.Error(key, "worlds." + std::string(key) + " must be below 1, got " + Shown(read),
                "0.2 means factors from 0.8 to 1.2");
    }
    return read;
  };
  out.friction = share("friction");
  out.mass = share("mass");
  out.stiffness = share("stiffness");
  out.damping = share("damping");
  if (const Value* start = map.Find("start")) out.start = ReadStartNoise(*start, scope);
  if (const Value* redraw = map.Find("redraw")) {
    out.redraw = ReadBool(*redraw, map.Path("redraw"), scope).value_or(false);
  }
  out.worst = map.ChoiceOr<bool>("score", false, {{"mean", false}, {"worst", true}});
  return out;
}

std::vector<SearchSpec> ReadSearches(const Value* list, std::size_t dimensions,
                                     const Scope& scope) {
  std::vector<SearchSpec> out;
  if (!list) return out;
  for (const ValuePtr& item : Items(list, "search", scope)) {
    out.push_back(ReadSearch(*item, dimensions, scope));
  }
  if (list->kind == Value::Kind::kSequence && list->items.empty()) {
    scope.out.Error(list->at, "search is empty: there is nothing to do",
                    "such as [{method: monte_carlo, evaluations: 100}]");
  }
  return out;
}

}  // namespace description
}  // namespace taut
