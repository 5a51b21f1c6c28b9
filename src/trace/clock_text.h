/// Times of day and dates in the text forms of measurement programs.
#pragma once

#include <optional>
#include <string_view>

#include "taut/trace.h"

namespace taut::trace {

constexpr double kDay_s = 86400;

/// Returns the seconds since midnight, or, for forms with a date, since 1970-01-01 in the time zone
/// of the text (UTC if it names none). Nothing if the text has another form or no such date exists.
/// The seconds may have a decimal point or comma.
std::optional<double> ParseClock(std::string_view text, ClockFormat format);

}  // namespace taut::trace
