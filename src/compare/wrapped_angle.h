/// Wrapped values, such as recorded angles that jump from 359 to 0 degrees or counters that
/// overflow. Values that differ by a multiple of the period are equal.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "taut/trace.h"

namespace taut::compare {

/// Adds the multiple of `period` that brings `value` nearest to `to`. Returns `value` unchanged if
/// a number is not finite or `period` is 0.
double NearestTurn(double value, double to, double period);

/// Removes jumps: adds multiples of the period so that each finite value is nearest to the previous
/// finite value.
void Unwrap(std::vector<double>& values, double period);

/// Adds multiples of the period so that each value is nearest to the same row of `to`.
void AlignTurns(const std::vector<double>& to, double period, std::vector<double>& values);

/// Unwraps all channels of a trace that have a period.
void Unwrap(Trace& trace);

/// Returns the row before the first jump of about a full turn. Only for channels in rad or degrees
/// without a period, whose values all lie within one turn.
std::optional<std::size_t> FindWrap(const ChannelInfo& channel, const std::vector<double>& values);

}  // namespace taut::compare
