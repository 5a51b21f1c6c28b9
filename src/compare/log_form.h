/// Layout of a log, recognized from its first lines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut {

struct LogForm {
  std::string program;  ///< Name of a known layout, such as "OptiTrack"; empty: any table.
  TableLayout layout;   ///< Without clock, ignored columns and name columns.
  std::vector<std::string> names;              ///< Column names, unique.
  std::vector<std::vector<std::string>> rows;  ///< Cells of the first rows.
  std::vector<std::string> units;              ///< By column; empty: not stated outside of names.
  std::optional<double> rate_hz;               ///< Row rate, if stated outside of the rows.
  std::string length_unit;                     ///< Unit of positions, from outside the header.
  std::vector<std::string> doubts;             ///< Items for the user to check.
  bool is_trace = false;                       ///< Times and columns need no layout (MCAP).
  bool y_up = false;                           ///< The program's default for the vertical axis.
};

/// Recognizes the layout of a log. Returns nothing and adds a diagnostic if it has no rows of
/// numbers.
std::optional<LogForm> RecognizeLog(const std::string& path, Diagnostics& out);

}  // namespace taut
