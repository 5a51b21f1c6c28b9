#include "trace/table_cells.h"

#include "base/number_text.h"
#include "trace/csv_lines.h"

namespace taut::trace {

std::vector<TableCell> SplitCells(std::string_view line, char separator) {
  std::vector<TableCell> cells;
  for (std::size_t at = 0; at <= line.size();) {
    while (separator == ' ' && at < line.size() && line[at] == ' ') ++at;
    if (separator == ' ' && at == line.size()) break;
    const std::size_t from = at;
    std::string text;
    bool quoted = false;
    for (; at < line.size() && (quoted || line[at] != separator); ++at) {
      if (line[at] != '"') {
        text += line[at];
      } else if (quoted && at + 1 < line.size() && line[at + 1] == '"') {
        text += line[at++];
      } else {
        quoted = !quoted;
      }
    }
    cells.push_back({std::string(Trim(text)), static_cast<int>(from) + 1});
    ++at;
  }
  return cells;
}

bool IsGapCell(std::string_view text) {
  return text.empty() || text == "NaN" || text == "nan" || text == "NA";
}

std::optional<double> CellNumber(std::string_view text, char decimal) {
  if (IsGapCell(text)) return std::nullopt;
  if (text.front() == '+') text.remove_prefix(1);
  std::string with_point;
  if (decimal == ',') {
    with_point = text;
    for (char& c : with_point) c = c == ',' ? '.' : c == '.' ? ',' : c;
    text = with_point;
  }
  double number = 0;
  const auto [end, failure] = base::FromChars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

void JoinHeader(const std::vector<TableCell>& cells, bool fill, std::vector<std::string>& names) {
  if (names.size() < cells.size()) names.resize(cells.size());
  std::string before;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string text = i < cells.size() ? cells[i].text : "";
    if (fill && text.empty()) text = before;
    before = text;
    if (!names[i].empty() && !text.empty()) names[i] += ' ';
    names[i] += text;
  }
}

}  // namespace taut::trace
