// Reader of tables of other programs, with the layout that a mapping defines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "base/pattern.h"
#include "trace/channel_names.h"
#include "trace/clock_text.h"
#include "trace/csv_lines.h"
#include "trace/mat_variables.h"
#include "trace/readers.h"
#include "trace/table_cells.h"
#include "trace/text_encoding.h"

namespace taut::trace {
namespace {

constexpr std::size_t kMaxTableErrors = 20;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Cell = TableCell;

class TableParser {
 public:
  TableParser(const std::string& path, const TableLayout& layout, Diagnostics& out)
      : path_(path), layout_(layout), out_(out) {}

  bool Line(std::string_view line) {
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line_ <= layout_.skip_lines) return true;
    if (line_ <= layout_.skip_lines + layout_.header_lines) {
      if (!Header(line)) return false;
      return line_ < layout_.skip_lines + layout_.header_lines || Columns();
    }
    if (columns_.empty() && !Columns()) return false;
    if (Trim(line).empty()) return true;
    Row(SplitCells(line, layout_.separator));
    return errors_ < kMaxTableErrors;
  }

  std::optional<Trace> Take() {
    if (errors_ == 0 && columns_.empty()) {
      Error("csv.no_rows", std::max(line_, 1), 0, "the table ends before its rows begin",
            fmt::format("the mapping skips {} lines", layout_.skip_lines));
    }
    if (errors_ == 0 && rows_ == 0) Error("csv.no_rows", line_, 0, "the table has no rows");
    if (errors_ > 0) return std::nullopt;
    if (is_long()) Spread();
    return std::move(trace_);
  }

 private:
  enum class Use { kNothing, kTime, kChannel, kName, kValue };
  bool is_long() const { return !layout_.value_column.empty(); }

  /// Adds a line of the header to the names of the columns.
  bool Header(std::string_view line) {
    if (!IsUtf8(line)) {
      Error("csv.not_utf8", line_, 0, "the header is not UTF-8",
            "add \"encoding\": \"windows-1252\" to the table in the mapping");
      return false;
    }
    const bool fill = layout_.merged_header && line_ < layout_.skip_lines + layout_.header_lines;
    JoinHeader(SplitCells(line, layout_.separator), fill, names_);
    return true;
  }

  bool Columns() {
    const std::vector<std::string>& names = layout_.columns.empty() ? names_ : layout_.columns;
    const int line = layout_.header_lines > 0 ? line_ : 0;
    const auto index = [&](const std::string& name) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        Error("csv.no_column", line, 0, fmt::format("the table has no column \"{}\"", name),
              DidYouMean(name, names));
      } else if (std::find(found + 1, names.end(), name) != names.end()) {
        Error("csv.duplicate_column", line, 0,
              fmt::format("the table has two columns \"{}\"", name),
              "rename them with `columns` in the mapping");
      }
      return static_cast<std::size_t>(found - names.begin());
    };
    columns_.assign(names.size() + 1, Use::kNothing);  // the last element: for unknown names
    if (!layout_.row_s) columns_[index(layout_.time_column)] = Use::kTime;
    if (is_long()) {
      for (const std::string& name : layout_.name_columns) columns_[index(name)] = Use::kName;
      columns_[index(layout_.value_column)] = Use::kValue;
    }
    columns_.resize(names.size());
    for (std::size_t i = 0; i < names.size() && !is_long(); ++i) {
      const bool ignored =
          std::any_of(layout_.ignore.begin(), layout_.ignore.end(),
                      [&](const std::string& pattern) { return base::Fits(pattern, names[i]); });
      if (columns_[i] == Use::kTime || ignored || names[i].empty()) continue;
      columns_[i] = Use::kChannel;
      trace_.channels.push_back({names[i], TableUnit(names[i])});
    }
    trace_.values.resize(trace_.channels.size());
    return errors_ == 0;
  }

  /// Reports decimal commas and stops reading, since all other cells have the same error.
  void RefuseDecimalCommas(const Cell& cell) {
    Error("csv.decimal_comma", line_, cell.column,
          fmt::format("numbers have a decimal comma, such as \"{}\"", cell.text),
          "add \"decimal\": \",\" to the table in the mapping");
    errors_ = kMaxTableErrors;
  }

  /// Converts a cell to a number; empty cells and "NA" become NaN.
  double Number(const Cell& cell) {
    if (IsGapCell(cell.text)) return kNan;
    if (const auto number = CellNumber(cell.text, layout_.decimal)) return *number;
    if (layout_.decimal == '.' && CellNumber(cell.text, ',')) {
      RefuseDecimalCommas(cell);
      return kNan;
    }
    Error("csv.not_a_number", line_, cell.column, fmt::format("\"{}\" is not a number", cell.text),
          "in the mapping, `skip_lines` skips lines before the rows, and `ignore` skips a column "
          "of text");
    return kNan;
  }

  double Clock(const Cell& cell) {
    if (layout_.clock == ClockFormat::kNumber) return Number(cell);
    if (const auto time_s = ParseClock(cell.text, layout_.clock)) return *time_s;
    Error("csv.not_a_time", line_, cell.column,
          fmt::format("\"{}\" is not a time of the form {}", cell.text,
                      ClockFormatName(layout_.clock)),
          "correct `time.format` in the mapping");
    return kNan;
  }

  /// Returns whether a row has a cell for each column that is used. Programs leave out empty cells
  /// at the end of a row, or end all rows with a separator.
  bool Covers(const std::vector<Cell>& cells) const {
    const auto is_used = [](Use use) { return use != Use::kNothing; };
    if (cells.size() < columns_.size()) {
      return std::none_of(columns_.begin() + static_cast<std::ptrdiff_t>(cells.size()),
                          columns_.end(), is_used);
    }
    return cells.size() == columns_.size() ||
           (cells.size() == columns_.size() + 1 && cells.back().text.empty());
  }

  void Row(const std::vector<Cell>& cells) {
    const std::size_t errors_before = errors_;
    if (!Covers(cells)) {
      Error("csv.ragged_row", line_, 0,
            fmt::format("the row has {} values, but the table has {} columns", cells.size(),
                        columns_.size()));
      return;
    }
    double time_s = layout_.row_s ? *layout_.row_s * static_cast<double>(rows_) : kNan;
    int time_at = 0;
    std::vector<double> values;
    std::string name;
    for (std::size_t i = 0; i < std::min(cells.size(), columns_.size()); ++i) {
      switch (columns_[i]) {
        case Use::kNothing:
          break;
        case Use::kTime: {
          const double read = Clock(cells[i]);
          if (rows_ == 0) zero_ = layout_.zero.value_or(read);
          time_s = (read - zero_) * layout_.unit_s;
          time_at = cells[i].column;
          break;
        }
        case Use::kName:
          name += (name.empty() ? "" : "_") + cells[i].text;
          break;
        case Use::kChannel:
        case Use::kValue:
          values.push_back(Number(cells[i]));
          break;
      }
    }
    if (errors_ != errors_before) return;
    ++rows_;
    time_s += layout_.offset_s;
    auto& last = last_[name];
    if (!std::isfinite(time_s)) {
      Error("csv.not_a_number", line_, time_at, "the time is not a number",
            "leave out rows without a time");
    } else if (last.line > 0 && !(time_s > last.time_s)) {
      const bool midnight = last.time_s - time_s > 0.5 * kDay_s;
      Error("csv.times_not_increasing", line_, time_at,
            fmt::format("the time {} s {} {} s in line {}", time_s,
                        time_s == last.time_s ? "equals the time" : "is before the time",
                        last.time_s, last.line),
            midnight ? "times must increase; the clock may have passed midnight"
                     : "times must increase");
    } else if (is_long()) {
      long_[name].emplace_back(time_s, values[0]);
    } else {
      trace_.time_s.push_back(time_s);
      for (std::size_t i = 0; i < values.size(); ++i) trace_.values[i].push_back(values[i]);
    }
    last = {time_s, line_};
  }

  /// Converts a table with one value per line to a trace with one row per time.
  void Spread() {
    std::map<double, std::size_t> rows;
    for (const auto& [name, points] : long_) {
      for (const auto& point : points) rows.emplace(point.first, 0);
    }
    for (auto& [time_s, row] : rows) {
      row = trace_.time_s.size();
      trace_.time_s.push_back(time_s);
    }
    for (const auto& [name, points] : long_) {
      trace_.channels.push_back({name, TableUnit(name)});
      std::vector<double>& values = trace_.values.emplace_back(rows.size(), kNan);
      for (const auto& [time_s, value] : points) values[rows.at(time_s)] = value;
    }
  }

  void Error(MessageId id, int line, int column, std::string what, std::string hint = {}) {
    if (++errors_ <= kMaxTableErrors) {
      out_.Error(id, {path_, line, column}, std::move(what), std::move(hint));
    }
  }

  struct Before {
    double time_s = 0;
    int line = 0;
  };
  const std::string& path_;
  const TableLayout& layout_;
  Diagnostics& out_;
  std::vector<std::string> names_;  ///< Column names from the header.
  std::vector<Use> columns_;
  std::map<std::string, Before> last_;  ///< Per channel, for tables with one value per line.
  std::map<std::string, std::vector<std::pair<double, double>>> long_;
  double zero_ = 0;
  std::size_t rows_ = 0;
  Trace trace_;
  int line_ = 0;
  std::size_t errors_ = 0;
};

}  // namespace
}  // namespace taut::trace

namespace taut {

std::optional<Trace> ReadTable(const std::string& path, const TableLayout& layout,
                               Diagnostics& out) {
  if (trace::IsMatFile(path)) {
    return trace::WithFiniteSpans(path, trace::ReadMatTable(path, layout, out), out);
  }
  trace::TableParser parser(path, layout, out);
  const auto line = [&](std::string_view text) { return parser.Line(text); };
  if (!trace::ReadCsvLines(path, trace::CsvTail::kLine, line, out, layout.encoding)) {
    return std::nullopt;
  }
  return trace::WithFiniteSpans(path, parser.Take(), out);
}

}  // namespace taut
