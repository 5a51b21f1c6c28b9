/// Wrapped values: angles of a recording that jump from 359 to 0 degrees, counters that overflow.
/// Values that differ by a multiple of the period are equal.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "taut/trace.h"

namespace taut::compare {

/// Returns `value` plus the multiple of `period` that brings it nearest to `to`; `value` if one of
/// the numbers is not finite or `period` is 0.
double NearestTurn(double value, double to, double period);

/// Removes the jumps: brings each finite value nearest to the finite value before it.
void Unwrap(std::vector<double>& values, double period);

/// Brings each value nearest to the value of `to` in the same row.
void AlignTurns(const std::vector<double>& to, double period, std::vector<double>& values);

/// Unwraps all channels of a trace that have a period.
void Unwrap(Trace& trace);

/// Returns the row before the first jump of about a full turn, if a channel in rad or degrees
/// without a period probably wraps: all its values lie within one turn.
std::optional<std::size_t> FindWrap(const ChannelInfo& channel, const std::vector<double>& values);

}  // namespace taut::compare
