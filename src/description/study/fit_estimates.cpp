// Estimated quantities of a fit: parameters, offsets, gains and delays, with bounds and priors.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "description/study/fit_parts.h"
#include "taut/trace.h"

namespace taut::description {
namespace {

/// Returns the value of a parameter of an experiment or its model; null if absent.
const double* FindParameter(const FitExperiment& one, const std::string& name) {
  const auto in = [&](const std::map<std::string, double>& map) -> const double* {
    const auto at = map.find(name);
    return at == map.end() ? nullptr : &at->second;
  };
  const double* own = in(one.experiment.parameters);
  return own ? own : in(one.experiment.robot.parameters);
}

std::vector<std::string> ParameterNames(const std::vector<FitExperiment>& experiments) {
  std::set<std::string> names;
  for (const FitExperiment& one : experiments) {
    for (const auto& [name, value] : one.experiment.parameters) names.insert(name);
    for (const auto& [name, value] : one.experiment.robot.parameters) names.insert(name);
  }
  return {names.begin(), names.end()};
}

/// Checks that bounds, prior and start are consistent. Sets a default scale.
void CheckRange(const std::string& what, const SourceRef& at, bool starts, FitRange& range,
                const Scope& scope) {
  const auto wrong = [&](const std::string& text, const std::string& hint = {}) {
    scope.out.Error("estimate.bad_value", at, what + text, hint);
  };
  if (!(range.low < range.high) && !std::isnan(range.low) && !std::isnan(range.high)) {
    wrong(": low " + Shown(range.low) + " is not below high " + Shown(range.high));
    return;
  }
  if (range.mean && (*range.mean < range.low || *range.mean > range.high)) {
    wrong(": the prior's mean " + Shown(*range.mean) + " is not between its bounds");
  }
  if (range.start < range.low || range.start > range.high) {
    wrong(" starts at " + Shown(range.start) + ", which is not between its bounds",
          starts ? ""
                 : "the default start is the value in the experiment: give a `start`, or change "
                   "the bounds");
  } else if (range.start == range.low || range.start == range.high) {
    wrong(" starts on its bound " + Shown(range.start),
          "widen the bounds, or give a `start` between them");
  }
  if (range.scale > 0) return;
  if (range.sd) {
    range.scale = *range.sd;
  } else if (std::isfinite(range.high - range.low)) {
    range.scale = 0.25 * (range.high - range.low);
  } else {
    range.scale = 0.05 * std::fabs(range.start);
  }
  if (range.scale == 0) {
    wrong(": its scale is not known", "give bounds, a prior with `sd`, or a `scale`");
  }
}

struct Made {
  const FitEstimateText& text;
  const FitNuisanceText* nuisance = nullptr;
  const char* word = "";
};

FitEstimate OfNuisance(const Made& made, FitEstimate::Kind kind, double neutral,
                       const Scope& scope) {
  const FitNuisanceText& n = *made.nuisance;
  FitEstimate out;
  out.kind = kind;
  out.channels = made.text.channel.text;
  out.at = made.text.at;
  out.name = made.word + (out.channels.empty() ? "" : " " + out.channels);
  if (kind == FitEstimate::Kind::kOffset) out.unit = taut::UnitOfName(out.channels);
  if (kind == FitEstimate::Kind::kGain) out.unit = "1";
  if (kind == FitEstimate::Kind::kDelay) out.unit = "s";
  FitRange& range = out.range;
  range.low = n.low.value_or(range.low);
  range.high = n.high.value_or(range.high);
  range.sd = n.sd;
  if (n.sd) range.mean = n.mean.value_or(neutral);
  if (n.mean && !n.sd) {
    scope.out.Error("estimate.mean_without_sd", out.at,
                    std::string("estimate.") + made.word + ".mean needs an `sd`");
  }
  double start = n.mean.value_or(neutral);
  // Start a delay in the middle of its bounds.
  if (kind == FitEstimate::Kind::kDelay && !n.sd && n.low && n.high)
    start = 0.5 * (*n.low + *n.high);
  range.start = n.start.value_or(start);
  range.scale = n.scale.value_or(0.0);
  CheckRange("estimate: " + out.name, out.at, true, range, scope);
  return out;
}

std::optional<FitEstimate> OfParameter(const FitEstimateText& text,
                                       const std::vector<FitExperiment>& experiments,
                                       std::vector<std::size_t>& acts_on, const Scope& scope) {
  FitEstimate out;
  out.name = out.parameter = text.parameter.text;
  out.unit = taut::UnitOfName(out.name);
  out.at = text.at;
  std::vector<std::size_t> know;
  double value = NAN;
  for (const std::size_t e : acts_on) {
    const double* found = FindParameter(experiments[e], out.parameter);
    if (!found) {
      if (text.experiments.empty()) continue;
      scope.out.Error("estimate.unknown_parameter", text.parameter.at,
                      "estimate: " + experiments[e].name + " has no parameter \"" + out.name + "\"",
                      NameHint(out.name, ParameterNames({experiments[e]})));
      continue;
    }
    if (know.empty()) value = *found;
    know.push_back(e);
  }
  if (know.empty()) {
    if (!text.experiments.empty()) return std::nullopt;
    scope.out.Error("estimate.unknown_parameter", text.parameter.at,
                    "estimate: no experiment and no model has a parameter \"" + out.name + "\"",
                    NameHint(out.name, ParameterNames(experiments)));
    return std::nullopt;
  }
  acts_on = std::move(know);
  FitRange& range = out.range;
  range.low = text.low.value_or(range.low);
  range.high = text.high.value_or(range.high);
  if (text.prior) {
    range.sd = text.prior->sd;
    range.mean = text.prior->mean.value_or(value);
  }
  range.start = text.start.value_or(value);
  range.scale = text.scale.value_or(0.0);
  CheckRange("estimate: " + out.name, out.at, text.start.has_value(), range, scope);
  return out;
}

/// Returns a text that identifies a quantity, to detect duplicates.
std::string Identity(const FitEstimate& e) {
  return std::to_string(static_cast<int>(e.kind)) + " " + e.parameter + " " + e.channels;
}

}  // namespace

void Check(const MapReader& map, FitEstimateText& e) {
  e.has_clock = map.Has("clock");
  const bool parameter = map.Has("parameter"), channel = map.Has("channel");
  const auto only = [&](bool fits, std::initializer_list<const char*> keys, const char* whose) {
    for (const char* key : keys) {
      if (!fits && map.Has(key)) {
        map.Error("estimate.key_without_effect", key,
                  std::string("estimate.") + key + " is allowed for " + whose + " only");
      }
    }
  };
  only(parameter, {"low", "high", "start", "scale", "prior"}, "a parameter");
  only(channel, {"offset", "gain"}, "a channel");
  only(e.has_clock, {"delay_s"}, "a clock");
  if (channel && !parameter && !e.has_clock && !e.offset && !e.gain) {
    map.Error("estimate.channel_without_number", "channel",
              "estimate: a channel needs an `offset` or a `gain`", "such as `offset: {sd: 0.002}`");
  }
  if (e.has_clock && !parameter && !channel && !e.delay_s) {
    map.Error("estimate.clock_without_delay", "clock", "estimate: a clock needs a `delay_s`",
              "such as `delay_s: {low: 0, high: 3}`");
  }
}

std::vector<FitEstimate> ToEstimates(const std::vector<FitEstimateText>& texts,
                                     const std::vector<FitExperiment>& experiments,
                                     const std::vector<bool>& known, const Scope& scope) {
  std::vector<FitEstimate> out;
  std::map<std::pair<std::string, std::size_t>, SourceRef> taken;
  const auto add = [&](FitEstimate estimate, const std::vector<std::size_t>& acts_on, bool each) {
    for (const std::size_t e : acts_on) {
      const auto [first, fresh] = taken.emplace(std::pair(Identity(estimate), e), estimate.at);
      if (fresh) continue;
      scope.out.Error("estimate.duplicate", estimate.at,
                      "estimate: " + estimate.name + " is estimated twice",
                      "first in line " + std::to_string(first->second.line));
      break;
    }
    const std::string name = estimate.name;
    for (std::size_t i = 0; i < (each ? acts_on.size() : 1); ++i) {
      if (each) {
        estimate.name = name + " " + experiments[acts_on[i]].name;
        estimate.experiments = {acts_on[i]};
      } else {
        estimate.experiments = acts_on;
      }
      out.push_back(estimate);
    }
  };
  const bool all_known = std::find(known.begin(), known.end(), false) == known.end();
  for (const FitEstimateText& text : texts) {
    auto acts_on = NamedExperiments(text.experiments, "estimate", experiments, scope);
    if (!text.parameter.text.empty()) {
      if (!all_known || acts_on.empty()) continue;
      auto made = OfParameter(text, experiments, acts_on, scope);
      if (made) add(std::move(*made), acts_on, text.each);
    }
    const auto nuisance = [&](const std::optional<FitNuisanceText>& of, FitEstimate::Kind kind,
                              const char* word, double neutral) {
      if (of) add(OfNuisance({text, &*of, word}, kind, neutral, scope), acts_on, text.each);
    };
    if (!text.channel.text.empty()) {
      nuisance(text.offset, FitEstimate::Kind::kOffset, "offset", 0.0);
      nuisance(text.gain, FitEstimate::Kind::kGain, "gain", 1.0);
    }
    if (text.has_clock) nuisance(text.delay_s, FitEstimate::Kind::kDelay, "delay", 0.0);
    for (const std::size_t e : acts_on) {
      if (!text.has_clock || experiments[e].forward != FitForward::kLoadCases) continue;
      scope.out.Error("estimate.no_clock", text.at,
                      "estimate: the load cases of " + experiments[e].name +
                          " have no clock, so they cannot have a delay");
    }
  }
  return out;
}

}  // namespace taut::description
