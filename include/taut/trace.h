/// Traces: recordings of runs as named channels against time (docs/formats/trace.md).
///
/// Threads: any number may read and write traces at once, each with a separate writer, file and
/// diagnostics (HDF5 as built by Debian is thread safe). A writer is used by one thread at a time;
/// a `Trace` is plain data.
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

/// Channel (column) of a trace. The name ends with the quantity and its unit:
/// `cable/outer_top_1/tension_n`, `body/segment_0/position_x_m`.
struct ChannelInfo {
  std::string name;
  std::string unit;  ///< SI: "N", "m", "m/s", "rad", "1".
  /// Values that differ by a multiple of it are equal, such as wrapped angles; 0: none. Mappings
  /// set it; trace files do not contain it.
  double period = 0.0;
};

/// Returns the unit at the end of a name: "N" for `cable/a/tension_n`, "kg/m" for `mass_kg_per_m`,
/// "1" without a known unit. For formats that cannot store units.
std::string UnitOfName(std::string_view name);

/// Metadata that make a run reproducible: pairs such as ("taut_version", "0.1.0"), ("seed", "0").
using TraceMetadata = std::vector<std::pair<std::string, std::string>>;

/// Writer of a trace during a run. Its file appears with the first row, or when it is finished;
/// until then, an earlier file at its path stays. A file truncated at any moment (kill -9) is
/// readable and lacks at most the last second of wall-clock time.
class TraceWriter {
 public:
  virtual ~TraceWriter() = default;

  /// Appends a row. `values` has one entry per channel, in the order given at the start. Returns
  /// false once writing has failed (disk full, ...); `error()` then has the reason.
  virtual bool Append(double time_s, const double* values) = 0;

  /// Writes the first row at once, later rows when they have been in memory for half a second.
  /// `Append` includes this; call it if rows are rare. Returns as `Append` does.
  virtual bool FlushOld() = 0;

  /// Writes remaining rows from memory, syncs the file to the disk, marks it as finished (HDF5) and
  /// closes it. Returns false on failure: see `error()`.
  virtual bool Finish() = 0;

  /// Returns the reason of a failure; else empty.
  virtual const std::string& error() const = 0;
};

/// Starts an HDF5 trace (single writer, multiple readers). Returns null, with a diagnostic, if the
/// file cannot be created.
std::unique_ptr<TraceWriter> CreateHdf5Trace(const std::string& path,
                                             const std::vector<ChannelInfo>& channels,
                                             const TraceMetadata& metadata, Diagnostics& out);

/// Starts a CSV trace: one header line `time_s,cable/outer_top_1/tension_n,...`. Returns null, with
/// a diagnostic, if the file cannot be created.
std::unique_ptr<TraceWriter> CreateCsvTrace(const std::string& path,
                                            const std::vector<ChannelInfo>& channels,
                                            Diagnostics& out);

/// Returns a writer that runs `writer` on a separate thread: `Append` never waits for the disk, and
/// reports failures with a delay. For programs that drive a robot meanwhile. `channels`: their
/// number.
std::unique_ptr<TraceWriter> WriteBehind(std::unique_ptr<TraceWriter> writer, std::size_t channels);

/// A trace in memory.
struct Trace {
  std::vector<ChannelInfo> channels;
  std::vector<double> time_s;
  std::vector<std::vector<double>> values;  ///< values[channel][row].
  TraceMetadata metadata;
  /// HDF5: the writer was killed or is still running in another process. Unknown (false) for other
  /// formats.
  bool unfinished = false;

  /// Returns the index of a channel, or nothing.
  std::optional<std::size_t> Find(const std::string& name) const;
};

/// Reads `.h5`, `.csv` or `.csv.gz`. Returns nothing, with a diagnostic, if that fails. A truncated
/// `.h5` or `.csv` gives the rows that are complete in every channel; a truncated `.csv.gz`, links
/// to other files, and files that unpack to far more than their size are refused
/// (docs/formats/trace.md).
std::optional<Trace> ReadTrace(const std::string& path, Diagnostics& out);

/// Layout of a text table of another program that is not a trace (docs/formats/mapping.md).
struct TableLayout {
  int skip_lines = 0;                ///< Before the header, or before the rows if there is none.
  bool header = true;                ///< Whether a line names the columns.
  std::vector<std::string> columns;  ///< Their names, to replace the header's.
  char separator = ',';              ///< A blank represents any number of blanks.
  std::vector<std::string> ignore;   ///< Patterns with `*` of columns to skip.

  // Clock: a column in units of `unit_s` [s], in which the value `zero` (nothing: the first value)
  // is 0 s; or, without such a column, rows at intervals of `row_s`.
  std::string time_column;
  double unit_s = 1.0;
  std::optional<double> zero = 0.0;
  double offset_s = 0.0;  ///< Added to all times.
  std::optional<double> row_s;

  // For tables with one value per row (long format): columns whose values, joined by `_`, give the
  // name of the channel, and column of the value.
  std::vector<std::string> name_columns;
  std::string value_column;
};

/// Reads such a table (.csv, .csv.gz or any other name); channels have the names of its columns and
/// the unit 1. Empty cells, `nan` and `NA` are NaN. Returns nothing, with diagnostics with file,
/// line and column, after errors: cells that are not numbers, times that do not increase.
std::optional<Trace> ReadTable(const std::string& path, const TableLayout& layout,
                               Diagnostics& out);

}  // namespace taut
