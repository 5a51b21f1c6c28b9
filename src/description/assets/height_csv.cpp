#include "description/assets/height_csv.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/brief.h"
#include "base/input_file.h"
#include "base/number_text.h"

namespace taut::description {
namespace {

constexpr std::size_t kMostTableBytes = std::size_t{1} << 30;

/// Appends the numbers of a line to `row`. Returns the character position of the first invalid
/// number, if any.
std::optional<std::size_t> AddRow(std::string_view line, std::vector<double>& row) {
  std::size_t at = 0;
  for (std::size_t number = 1;; ++number) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    std::string_view word = line.substr(at, end - at);
    while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
    while (!word.empty() && (word.back() == ' ' || word.back() == '\r')) word.remove_suffix(1);
    double value = 0;
    const auto read = base::FromChars(word.data(), word.data() + word.size(), value);
    const bool good = read.ec == std::errc() && read.ptr == word.data() + word.size();
    if (!good || !std::isfinite(value)) return number;
    row.push_back(value);
    if (end == line.size()) return std::nullopt;
    at = end + 1;
  }
}

}  // namespace

std::optional<HeightTable> ReadHeightCsv(const std::string& path, trace::TableBudget& budget,
                                         Diagnostics& out) {
  const auto text = base::ReadInputFile(path, kMostTableBytes, "use fewer, larger cells", out);
  if (!text) return std::nullopt;
  const std::size_t errors_before = out.items().size();
  constexpr std::size_t kMostErrors = 10;
  HeightTable table;
  int line_number = 0;
  std::vector<double> row;
  for (std::size_t at = 0; at < text->size();) {
    const std::size_t end = std::min(text->find('\n', at), text->size());
    const std::string_view line = std::string_view(*text).substr(at, end - at);
    at = end + 1;
    ++line_number;
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    const SourceRef place{path, line_number, 0};
    // Check the budget before reading the row: one line may contain millions of numbers.
    const auto count = static_cast<double>(1 + std::count(line.begin(), line.end(), ','));
    const double with_line = static_cast<double>(table.height_m.size()) + count;
    if (with_line > budget.left()) {
      out.Error(
          "heights.too_many", place,
          "the file has " + base::Brief(with_line) + " heights up to this line" + budget.MoreThan(),
          "use fewer, larger cells");
      break;
    }
    row.clear();
    if (const auto wrong = AddRow(line, row)) {
      out.Error("heights.not_a_number", place,
                "value " + std::to_string(*wrong) + " of this line is not a number",
                "expected finite numbers in m, separated by commas");
    } else if (table.columns > 0 && row.size() != static_cast<std::size_t>(table.columns)) {
      out.Error("heights.ragged_row", place,
                "this line has " + std::to_string(row.size()) +
                    " heights, but the lines before have " + std::to_string(table.columns));
    } else {
      table.columns = static_cast<int>(row.size());
      ++table.rows;
      table.height_m.insert(table.height_m.end(), row.begin(), row.end());
    }
    if (out.items().size() - errors_before >= kMostErrors) break;
  }
  if (out.items().size() != errors_before) return std::nullopt;
  budget.Add(static_cast<double>(table.height_m.size()));
  return table;
}

}  // namespace taut::description
