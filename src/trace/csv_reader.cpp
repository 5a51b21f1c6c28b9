// CSV reader for traces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/number_text.h"
#include "trace/channel_names.h"
#include "trace/csv_lines.h"
#include "trace/readers.h"

namespace taut::trace {
namespace {

constexpr std::size_t kMaxErrors = 20;

/// Parses the lines of one file into a trace.
class CsvParser {
 public:
  CsvParser(const std::string& path, Diagnostics& out) : path_(path), out_(out) {}

  /// Processes a line. Returns false after too many errors.
  bool Line(std::string_view line) {
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line_ == 1) return Header(line);
    if (line.empty()) {
      empty_line_ = empty_line_ == 0 ? line_ : empty_line_;
      return true;
    }
    if (empty_line_ > 0)
      return Error("csv.empty_line", empty_line_, 0, "there is an empty line between rows");
    Row(line);
    return error_count_ < kMaxErrors;
  }

  std::optional<Trace> Take() {
    if (line_ == 0) Error("csv.no_header", 1, 0, "the trace has no header line");
    if (error_count_ > 0) return std::nullopt;
    return std::move(trace_);
  }

 private:
  bool Header(std::string_view line) {
    std::size_t column = 0;
    ForEachCell(line, [&](std::string_view cell, int) {
      if (column++ > 0) {
        trace_.channels.push_back({std::string(cell), UnitOfName(cell)});
      } else if (cell != "time_s") {
        Error("csv.no_time", 1, 1, fmt::format("the first column is \"{}\"", cell),
              "expected time_s; for a log of another program, write a mapping with `taut new "
              "mapping` "
              "and pass it to `--map`");
      }
    });
    trace_.values.resize(trace_.channels.size());
    if (error_count_ == 0 && !CheckChannelNames(path_, trace_.channels, out_)) ++error_count_;
    return error_count_ == 0;
  }

  void Row(std::string_view line) {
    row_.clear();
    bool good = true;
    const std::size_t columns = trace_.channels.size() + 1;
    // Decimal commas split each number in two. Report this once, since all rows have the same
    // error.
    if (trace_.time_s.empty() &&
        static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1 == 2 * columns) {
      Error("csv.decimal_comma", line_, 0,
            fmt::format("the row has two values per column ({} columns): numbers have a decimal "
                        "comma",
                        columns),
            "write the table with decimal points");
      error_count_ = kMaxErrors;
      return;
    }
    ForEachCell(line, [&](std::string_view cell, int column) {
      double number = 0.0;
      const auto [end, failure] = base::FromChars(cell.data(), cell.data() + cell.size(), number);
      if (failure == std::errc::result_out_of_range) {
        good = Error("csv.out_of_range", line_, column,
                     fmt::format("number \"{}\" is out of range", cell));
      } else if (failure != std::errc() || end != cell.data() + cell.size()) {
        good = Error("csv.not_a_number", line_, column, fmt::format("\"{}\" is not a number", cell),
                     cell.empty() ? "write nan for a missing value" : "");
      }
      row_.push_back(number);
    });
    if (row_.size() != columns) {
      good = Error("csv.ragged_row", line_, 0,
                   fmt::format("the row has {} values, but the header has {} columns", row_.size(),
                               columns));
    }
    if (!good) return;
    if (!std::isfinite(row_[0]) || (!trace_.time_s.empty() && !(row_[0] > trace_.time_s.back()))) {
      Error("csv.times_not_increasing", line_, 1,
            fmt::format("the time {} is not after the time of the previous row", row_[0]),
            "times must increase");
      return;
    }
    trace_.time_s.push_back(row_[0]);
    for (std::size_t i = 0; i < trace_.channels.size(); ++i) {
      trace_.values[i].push_back(row_[i + 1]);
    }
  }

  /// Calls `use(cell, column)` for each cell. `column`: byte position, starting at 1.
  template <class Use>
  void ForEachCell(std::string_view line, const Use& use) {
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t to = std::min(line.find(',', from), line.size());
      use(Trim(line.substr(from, to - from)), static_cast<int>(from) + 1);
      from = to + 1;
    }
  }

  /// Reports an error and returns false.
  bool Error(MessageId id, int line, int column, std::string what, std::string hint = {}) {
    if (++error_count_ <= kMaxErrors) {
      out_.Error(id, {path_, line, column}, std::move(what), std::move(hint));
    }
    return false;
  }

  const std::string& path_;
  Diagnostics& out_;
  Trace trace_;
  std::vector<double> row_;
  int line_ = 0;
  int empty_line_ = 0;  ///< First empty line; such lines may occur only at the end of the file.
  std::size_t error_count_ = 0;
};

}  // namespace

std::optional<Trace> ReadCsv(const std::string& path, Diagnostics& out) {
  CsvParser parser(path, out);
  const auto line = [&](std::string_view text) { return parser.Line(text); };
  if (!ReadCsvLines(path, CsvTail::kCutOff, line, out)) return std::nullopt;
  return parser.Take();
}

}  // namespace taut::trace
