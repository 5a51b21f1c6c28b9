// Loads equilibrated by measured forces (`carried:` of a fit).
#include <algorithm>
#include <cmath>

#include "base/pattern.h"
#include "description/study/fit_parts.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// Reports patterns that match no body of an experiment.
void CheckBodies(const FitCarriedText& text, const FitExperiment& one, const Scope& scope) {
  std::vector<std::string> names;
  for (const BodyDef& body : one.experiment.robot.def.bodies) names.push_back(body.name);
  for (const Placed& pattern : text.bodies) {
    const auto fits = [&](const std::string& name) { return base::Fits(pattern.text, name); };
    if (std::any_of(names.begin(), names.end(), fits)) continue;
    scope.out.Error("carried.unknown_body", pattern.at,
                    "carried.bodies: " + one.name + " has no body \"" + pattern.text + "\"",
                    NameHint(pattern.text, names));
  }
}

}  // namespace

std::vector<FitCarried> ToCarried(const std::vector<FitCarriedText>& texts,
                                  const std::vector<FitExperiment>& experiments,
                                  const std::vector<bool>& known, const Scope& scope) {
  std::vector<FitCarried> out;
  for (const FitCarriedText& text : texts) {
    FitCarried& carried = out.emplace_back();
    carried.name = text.name;
    carried.at = text.at;
    for (const Placed& body : text.bodies) carried.bodies.push_back(body.text);
    const double length = std::sqrt(Dot(text.direction, text.direction));
    if (length > 0 && std::isfinite(length)) {
      carried.direction = (1 / length) * text.direction;
    } else {
      scope.out.Error("carried.no_direction", text.at, "carried.direction must not be zero");
    }
    for (const std::size_t e : NamedExperiments(text.experiments, "carried", experiments, scope)) {
      const FitExperiment& one = experiments[e];
      if (one.forward == FitForward::kDynamic) {
        if (!text.experiments.empty()) {
          scope.out.Error(
              "carried.experiment_moves", text.at,
              "carried: " + one.name + " is dynamic, but carried loads are compared at rest",
              "write `forward: static` or `forward: load_cases`");
        }
        continue;
      }
      carried.experiments.push_back(e);
      if (known[e]) CheckBodies(text, one, scope);
    }
    if (carried.experiments.empty() && text.experiments.empty() && !experiments.empty()) {
      scope.out.Error("carried.no_rest", text.at, "carried: no experiment is at rest",
                      "write `forward: static` or `forward: load_cases`");
    }
  }
  return out;
}

}  // namespace taut::description
