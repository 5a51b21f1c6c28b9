/// Headline and figures of the page of a fit.
#pragma once

#include <cstddef>
#include <string>

#include "taut/identify.h"

namespace taut::identify {

/// Channels with fewer data of an experiment have no plot against time, but rows in one figure.
inline constexpr std::size_t kFewestOfPlot = 3;

/// Returns the cards with verdict, chi-square, errors and number of estimated parameters.
std::string Headline(const Identification& fit, const FitOutcome& outcome);

/// Returns a figure with one row per parameter, each with its own scale: prior, start, estimate and
/// their 95 % intervals.
std::string ParameterBars(const Identification& fit, const FitOutcome& outcome);

/// Returns plots of measured and computed values, one per experiment and channel.
std::string MeasuredPlots(const Identification& fit, const FitOutcome& outcome);

}  // namespace taut::identify
