/// Cells of the lines of text tables.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut::trace {

struct TableCell {
  std::string text;  ///< Without quotes and surrounding blanks.
  int column;        ///< Byte of the line, from 1.
};

/// Splits a line. Separators within double quotes belong to the text; the separator ' ' is any
/// number of blanks.
std::vector<TableCell> SplitCells(std::string_view line, char separator);

/// Returns whether a cell is a gap: empty, "NaN", "nan" or "NA".
bool IsGapCell(std::string_view text);

/// Returns the number of a cell; nothing for gaps and other texts. With a decimal comma, a point is
/// a separator of thousands, which is no number.
std::optional<double> CellNumber(std::string_view text, char decimal);

/// Adds a line of a header to the names of the columns, joined by a blank. `fill`: an empty cell
/// repeats the one before it.
void JoinHeader(const std::vector<TableCell>& cells, bool fill, std::vector<std::string>& names);

}  // namespace taut::trace
