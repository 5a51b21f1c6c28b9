/// Clock of a log: its column, unit or format, and start.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/log_form.h"

namespace taut {

struct LogClock {
  std::optional<std::size_t> column;  ///< Absent: rows at equal intervals.
  nlohmann::ordered_json time;        ///< The key `time` of a mapping's table.
  double rate_hz = 0;                 ///< Mean number of rows per second.
  std::vector<std::string> doubts;    ///< Items for the user to check.
};

LogClock GuessClock(const LogForm& form);

}  // namespace taut
