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
  TableLayout layout;   ///< All but the clock, ignored columns, and columns of names.
  std::vector<std::string> names;              ///< Of the columns, unique.
  std::vector<std::vector<std::string>> rows;  ///< Cells of the first rows.
  std::vector<std::string> units;              ///< By column; empty: not stated outside of names.
  std::optional<double> rate_hz;               ///< Stated outside of the rows.
  std::string length_unit;                     ///< Of positions, stated outside of the header.
  std::vector<std::string> doubts;             ///< What may be misread.
  bool is_trace = false;                       ///< Times and columns need no layout (MCAP).
  bool y_up = false;                           ///< The program's default for the vertical axis.
};

/// Returns nothing, with a diagnostic, without rows of numbers.
std::optional<LogForm> RecognizeLog(const std::string& path, Diagnostics& out);

/// Returns whether a cell is a number with this decimal mark, or a gap ("", NaN, NA).
bool IsNumberCell(const std::string& cell, char decimal);
/// Returns its value; NaN for a gap or other text.
double CellValue(const std::string& cell, char decimal);

}  // namespace taut
