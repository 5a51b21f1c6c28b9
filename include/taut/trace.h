/// Traces: recordings of runs as named channels against time (docs/formats/trace.md).
///
/// Threads: any number may read and write traces concurrently, each with a separate writer, file
/// and diagnostics (Debian's build of HDF5 is thread safe). Only one thread at a time may use a
/// writer. A `Trace` is plain data.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

/// Channel (column) of a trace. The name of a channel ends with the quantity and the unit:
/// `cable/outer_top_1/tension_n`, `body/segment_0/position_x_m`.
struct ChannelInfo {
  std::string name;
  std::string unit;  ///< SI: "N", "m", "m/s", "rad", "1".
  /// Period of values that wrap, such as angles; 0: none. Mappings set it; trace files do not
  /// contain it.
  double period = 0.0;
};

/// Returns the unit at the end of a name, for formats that cannot store units. Examples: "N" for
/// `cable/a/tension_n`, "kg/m" for `mass_kg_per_m`, "1" without a known unit.
std::string UnitOfName(std::string_view name);

/// Metadata for reproducible runs: pairs such as ("taut_version", "0.1.0"), ("seed", "0").
using TraceMetadata = std::vector<std::pair<std::string, std::string>>;

/// Writer of a trace during a run. The file of the trace appears with the first row, or when the
/// trace is finished. Until then, an earlier file at the same path remains. A file truncated at any
/// moment (kill -9) is readable and lacks at most the last second of wall-clock time.
class TraceWriter {
 public:
  virtual ~TraceWriter() = default;

  /// Appends a row. `values`: one per channel, in the order given when the writer was created.
  /// Returns false after a failure (disk full, ...); `error()` then contains the reason.
  virtual bool Append(double time_s, const double* values) = 0;

  /// Writes the first row immediately, and later rows after half a second in memory. `Append` does
  /// the same; call this function if rows are rare. Returns the same value as `Append`.
  virtual bool FlushOld() = 0;

  /// Writes remaining rows from memory, flushes the file to the disk, marks it as finished (HDF5)
  /// and closes it. Returns false on failure; see `error()`.
  virtual bool Finish() = 0;

  /// Returns the reason of a failure; otherwise empty.
  virtual const std::string& error() const = 0;
};

/// Starts an HDF5 trace (single writer, multiple readers). Returns null and adds an error if the
/// file cannot be created.
std::unique_ptr<TraceWriter> CreateHdf5Trace(const std::string& path,
                                             const std::vector<ChannelInfo>& channels,
                                             const TraceMetadata& metadata, Diagnostics& out);

/// Starts a CSV trace with the header `time_s,cable/outer_top_1/tension_n,...`. Returns null and
/// adds an error if the file cannot be created.
std::unique_ptr<TraceWriter> CreateCsvTrace(const std::string& path,
                                            const std::vector<ChannelInfo>& channels,
                                            Diagnostics& out);

/// Returns a writer that runs `writer` on a separate thread, for programs that drive a robot
/// meanwhile. `Append` never waits for the disk and reports failures with a delay. `channels`:
/// number of channels.
std::unique_ptr<TraceWriter> WriteBehind(std::unique_ptr<TraceWriter> writer, std::size_t channels);

/// Trace in memory.
struct Trace {
  std::vector<ChannelInfo> channels;
  std::vector<double> time_s;
  std::vector<std::vector<double>> values;  ///< values[channel][row].
  TraceMetadata metadata;
  /// HDF5: the writer was killed or is still running in another process. False for other formats.
  bool unfinished = false;

  /// Returns the index of a channel, or nothing.
  std::optional<std::size_t> Find(const std::string& name) const;
};

/// Adds a warning if the trace is unfinished: "the recorded part is compared". `use` is the last
/// word of this text, such as "compared".
void WarnIfUnfinished(const Trace& trace, const std::string& path, const std::string& use,
                      Diagnostics& out);

/// Reads `.h5`, `.csv`, `.csv.gz` or `.mcap`. On failure, returns nothing and adds an error. From a
/// truncated `.h5`, `.csv` or `.mcap`, it returns the complete rows. It rejects a truncated
/// `.csv.gz`, links to other files, and files that unpack to far more than their size
/// (docs/formats/trace.md).
std::optional<Trace> ReadTrace(const std::string& path, Diagnostics& out);

/// Encoding of a text file. With either value, UTF-16 is recognized by its byte order mark.
enum class TextEncoding { kUtf8, kWindows1252 };

/// Form of the clock in a table: a number, "14:03:20.5" (seconds since midnight), or a date and a
/// time of day (seconds since 1970-01-01): "2026-05-02T14:03:20.5Z", "2.5.2026 14:03:20.5",
/// "5/2/2026 14:03:20.5".
enum class ClockFormat { kNumber, kTimeOfDay, kIso8601, kDayMonthYear, kMonthDayYear };

/// Returns the name of a format in mappings: "number", "hh:mm:ss", "iso8601", "dd.mm.yyyy hh:mm:ss"
/// or "mm/dd/yyyy hh:mm:ss".
std::string_view ClockFormatName(ClockFormat format);

/// Layout of a text table from another program (docs/formats/mapping.md).
struct TableLayout {
  int skip_lines = 0;  ///< Number of lines before the header, or before the rows without a header.
  int header_lines = 1;  ///< Number of lines with column names, whose cells are joined by blanks.
  /// Except in the last header line, an empty cell repeats the previous cell.
  bool merged_header = false;
  std::vector<std::string> columns;  ///< Column names that replace those in the header.
  char separator = ',';              ///< A blank stands for any number of blanks.
  char decimal = '.';                ///< Decimal mark: point or comma.
  TextEncoding encoding = TextEncoding::kUtf8;
  std::vector<std::string> ignore;  ///< Patterns with `*` of columns to ignore.

  // Clock: a column of times in units of `unit_s` [s]. Time 0 s is at the column's value `zero`, or
  // at its first value if `zero` is absent. Without a time column, rows are `row_s` apart.
  std::string time_column;
  ClockFormat clock = ClockFormat::kNumber;
  double unit_s = 1.0;
  std::optional<double> zero = 0.0;
  double offset_s = 0.0;  ///< Offset that is added to all times.
  std::optional<double> row_s;

  // Only for tables with one value per row (long format): columns whose values, joined by `_`, are
  // the channel name, and the column of the value.
  std::vector<std::string> name_columns;
  std::string value_column;
};

/// Reads a text table, or the variables of a MATLAB file (v7.3). Channels get the column names and
/// the unit 1; channels with the name of a taut channel get the unit in that name. Empty cells,
/// `nan` and `NA` are NaN. On errors, such as cells that are not numbers or times that do not
/// increase, returns nothing and adds diagnostics with file, line and column.
std::optional<Trace> ReadTable(const std::string& path, const TableLayout& layout,
                               Diagnostics& out);

}  // namespace taut
