// Residuals of a fit: channels, references, windows and statistics.
#include <algorithm>

#include "description/study/fit_parts.h"

namespace taut::description {
namespace {

void CheckForward(const FitResidual& residual, const FitResidualText& text,
                  const FitExperiment& one, const Scope& scope) {
  const auto wrong = [&](const std::string& what, const std::string& hint) {
    scope.out.Error("residual.bad_channels", text.at, "residuals: " + what, hint);
  };
  const bool window = text.window.has_value();
  if (residual.channels.empty()) {
    const auto& references = one.experiment.references;
    const bool any = std::any_of(references.begin(), references.end(), [&](const auto& r) {
      return !residual.references || r.statistic == *residual.references;
    });
    if (!any) {
      wrong(one.name + " has no reference values with this statistic",
            "add a `reference` to the experiment, or limit the residual with `experiments`");
    }
    return;
  }
  if (one.forward == FitForward::kStatic && !residual.after_setpoint_s) {
    wrong(one.name + " is static, so it is compared only after its set points",
          "write `window: {after_setpoint_s: [2, 3]}`");
  }
  if (one.forward == FitForward::kLoadCases && window) {
    wrong(one.name + " has load cases, which have no time",
          "leave out `window`: row i of the data belongs to case i");
  }
  if (!residual.phase) return;
  std::vector<std::string> phases;
  for (const PhaseSpec& phase : one.experiment.phases) phases.push_back(phase.name);
  if (std::find(phases.begin(), phases.end(), *residual.phase) == phases.end()) {
    scope.out.Error("residual.unknown_phase", text.window->phase.at,
                    "residuals.window: " + one.name + " has no phase \"" + *residual.phase + "\"",
                    NameHint(*residual.phase, phases));
  }
}

}  // namespace

void Check(const MapReader& map, FitWindowText& window) {
  const int kinds = int{map.Has("phase")} + int{map.Has("from_s") || map.Has("to_s")} +
                    int{map.Has("after_setpoint_s")};
  if (kinds != 1 && map.is_map()) {
    map.scope().out.Error("residual.window_incomplete", map.at(),
                          "residuals.window needs exactly one of `phase`, `from_s` with `to_s`, "
                          "`after_setpoint_s`");
  }
  if (map.Has("from_s") != map.Has("to_s")) {
    map.scope().out.Error("residual.window_incomplete", map.at(),
                          "residuals.window needs both from_s and to_s");
  }
  const auto rises = [&](const char* key, double from, double to) {
    if (to <= from) {
      map.Error("residual.window_empty", key,
                "residuals.window: the end " + Shown(to) + " s is not after the start " +
                    Shown(from) + " s");
    }
  };
  if (window.from_s && window.to_s) rises("to_s", *window.from_s, *window.to_s);
  if (const auto& after = window.after_setpoint_s) {
    rises("after_setpoint_s", after->first, after->second);
  }
}

void Check(const MapReader& map, FitResidualText& residual) {
  residual.has_reference = map.Has("reference");
  if (residual.has_reference && !map.Has("channel")) {
    for (const char* key : {"window", "statistic"}) {
      if (map.Has(key)) {
        map.Error(
            "residual.key_of_references", key,
            std::string("residuals.") + key + " has no effect: the reference values define it");
      }
    }
  }
  if (residual.loss_sd && residual.loss == RobustLoss::kSquares) {
    map.Error("residual.loss_sd_without_loss", "loss_sd",
              "residuals.loss_sd needs `loss: huber` or `loss: cauchy`");
  }
}

std::vector<FitResidual> ToResiduals(const std::vector<FitResidualText>& texts,
                                     const std::vector<FitExperiment>& experiments,
                                     const std::vector<bool>& known, bool of_design,
                                     const Scope& scope) {
  std::vector<FitResidual> out;
  for (const FitResidualText& text : texts) {
    FitResidual& r = out.emplace_back();
    r.at = text.at;
    r.channels = text.channel.text;
    if (text.has_reference) r.references = text.reference;
    r.sd = text.sd;
    r.relative_sd = text.relative_sd;
    r.statistic = text.statistic;
    r.loss = text.loss;
    r.loss_sd = text.loss_sd.value_or(text.loss == RobustLoss::kHuber ? 1.345 : 2.385);
    if (text.window) {
      if (!text.window->phase.text.empty()) r.phase = text.window->phase.text;
      if (text.window->from_s && text.window->to_s) {
        r.span_s = {*text.window->from_s, *text.window->to_s};
      }
      r.after_setpoint_s = text.window->after_setpoint_s;
    }
    if (of_design && r.statistic == FitStatistic::kRows) {
      scope.out.Error("residual.design_has_no_rows", text.at,
                      "design: a measurement without data has no rows",
                      "write `statistic: mean`, `max` or `min`");
    }
    const bool meant = !r.channels.empty() || text.has_reference;
    for (const std::size_t e :
         NamedExperiments(text.experiments, "residuals", experiments, scope)) {
      const FitExperiment& one = experiments[e];
      if (!r.channels.empty() && one.data_file.empty() && !of_design) {
        // Skip an experiment without data, since it can have only reference values.
        if (!text.experiments.empty() && known[e]) {
          scope.out.Error("residual.no_data", text.at, "residuals: " + one.name + " has no `data`");
        }
        continue;
      }
      r.experiments.push_back(e);
      if (known[e] && meant) CheckForward(r, text, one, scope);
    }
    if (meant && r.experiments.empty() && text.experiments.empty() && !experiments.empty()) {
      scope.out.Error("residual.no_data", text.at, "residuals: no experiment has `data`");
    }
  }
  return out;
}

}  // namespace taut::description
