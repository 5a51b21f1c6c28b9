/// Results that contradict the standard error of an estimate: residuals, groups, other starts, and
/// the cost at a distance of one standard error (docs/theory/identification.md, section 4).
#pragma once

#include "taut/fit_verdict.h"

namespace taut::fit {

/// Returns the sentence on an unreliable parameter, with its contradictions.
std::string UnreliableText(const FitParameter& p, const ParameterVerdict& v);

/// Adds contradictions by chi-square of the data, if it is significant at `least_p`.
void ContradictByResiduals(const FitProblem& problem, double least_p, FitVerdict& verdict);

/// Adds contradictions by the jackknife, or appends its error to the sentences.
void ContradictByGroups(const FitProblem& problem, FitVerdict& verdict);

/// Adds contradictions by other starts that ended at a similar cost but other values.
void ContradictByStarts(const FitProblem& problem, const FitResult& fit, FitVerdict& verdict);

/// Computes two points per estimate, one standard error from the fit, with all others refitted to
/// first order. Adds a contradiction unless chi-square rises by about 1 (eq. F.13a).
void ContradictByCost(const FitProblem& problem, FitVerdict& verdict);

/// Adds contradictions by experiments whose fits alone disagree.
void ContradictByExperiments(FitVerdict& verdict);

/// Adds contradictions by effects that are not estimated, but significant at `least_p`, and that
/// would change an estimate by more than its standard error.
void ContradictByAliases(double least_p, FitVerdict& verdict);

/// Changes the verdict on each contradicted estimate to kUnreliable.
void ApplyContradictions(const FitProblem& problem, FitVerdict& verdict);

}  // namespace taut::fit
