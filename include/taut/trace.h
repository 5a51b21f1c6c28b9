/// Recordings of a run: named channels against time (docs/formats/trace.md).
///
/// Threads: any number may read and write traces at once, each its own writer, file and diagnostics
/// (HDF5 as Debian builds it is safe for that). A writer belongs to one thread at a time; a `Trace`
/// is plain data.
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

/// One column of a trace. The name ends with the quantity and its unit:
/// `cable/outer_top_1/tension_n`, `body/segment_0/position_x_m`.
struct ChannelInfo {
  std::string name;
  std::string unit;  ///< SI: "N", "m", "m/s", "rad", "1".
};

/// The unit that a name ends with: "N" for `cable/a/tension_n`, "kg/m" for `mass_kg_per_m`, "1"
/// where it states none that is known. For what cannot store units.
std::string UnitOfName(std::string_view name);

/// Text that makes a run reproducible: pairs such as ("taut_version", "0.1.0"), ("seed", "0").
using TraceMetadata = std::vector<std::pair<std::string, std::string>>;

/// Writes a trace while the run goes on. Its file appears with the first row, or when it is
/// finished; until then what was at its path stays. A file cut off at any moment (kill -9) is
/// readable and lacks at most the last second of wall-clock time.
class TraceWriter {
 public:
  virtual ~TraceWriter() = default;

  /// Appends a row. `values` has one entry a channel, in the order given at the start.
  /// Returns false once writing has failed (disk full, ...); `error()` then says why.
  virtual bool Append(double time_s, const double* values) = 0;

  /// Writes the first row at once, later ones when they have been in memory for half a second.
  /// `Append` does so, too; a program whose rows are seldom calls this in between. Returns as
  /// `Append` does.
  virtual bool FlushOld() = 0;

  /// Writes what is still in memory, brings all to the disk and closes the file, which from then on
  /// says that it is finished (HDF5). False: see `error()`.
  virtual bool Finish() = 0;

  virtual const std::string& error() const = 0;
};

/// Starts an HDF5 trace (single writer, multiple readers). Nothing and a diagnostic if the file
/// cannot be made.
std::unique_ptr<TraceWriter> CreateHdf5Trace(const std::string& path,
                                             const std::vector<ChannelInfo>& channels,
                                             const TraceMetadata& metadata, Diagnostics& out);

/// Starts a CSV trace: one header line `time_s,cable/outer_top_1/tension_n,...`.
std::unique_ptr<TraceWriter> CreateCsvTrace(const std::string& path,
                                            const std::vector<ChannelInfo>& channels,
                                            Diagnostics& out);

/// The same, on a thread of its own: `Append` never waits for a disk, and says a little later that
/// writing has failed. For who drives a robot meanwhile. `channels`: how many there are.
std::unique_ptr<TraceWriter> WriteBehind(std::unique_ptr<TraceWriter> writer, std::size_t channels);

/// A trace in memory.
struct Trace {
  std::vector<ChannelInfo> channels;
  std::vector<double> time_s;
  std::vector<std::vector<double>> values;  ///< values[channel][row].
  TraceMetadata metadata;
  /// HDF5: the writer was killed, or goes on in another process. Other files do not tell.
  bool unfinished = false;

  /// The position of a channel, or nothing.
  std::optional<std::size_t> Find(const std::string& name) const;
};

/// Reads `.h5`, `.csv` or `.csv.gz`. Nothing and a diagnostic if that fails. An `.h5` or `.csv`
/// that was cut off gives the rows that are complete in every channel; a cut-off `.csv.gz`,
/// anything that leads to other files and anything that unpacks to far more than its size are
/// refused (docs/formats/trace.md).
std::optional<Trace> ReadTrace(const std::string& path, Diagnostics& out);

/// A table of another program, as text, that is not laid out as a trace (docs/formats/mapping.md).
struct TableLayout {
  int skip_lines = 0;                ///< Before the header, or before the rows if there is none.
  bool header = true;                ///< Whether a line names the columns.
  std::vector<std::string> columns;  ///< Their names, if not those of the header.
  char separator = ',';              ///< A blank stands for any number of them.
  std::vector<std::string> ignore;   ///< Columns that are not read, as patterns with `*`.

  // The clock is a column, of which `unit_s` is one [s] and `zero`, in that unit, is 0 s: nothing:
  // its first value. Or there is none, and rows are `row_s` apart.
  std::string time_column;
  double unit_s = 1.0;
  std::optional<double> zero = 0.0;
  double offset_s = 0.0;  ///< Comes on top.
  std::optional<double> row_s;

  // Of a table with one value a row, as some programs write theirs: which columns make the name of
  // the channel, joined by `_`, and which has its value.
  std::vector<std::string> name_columns;
  std::string value_column;
};

/// Reads such a table (.csv, .csv.gz or any other name); channels are called as its columns are and
/// have the unit 1. A cell that is empty, `nan` or `NA` is NaN. Nothing and diagnostics, with file,
/// line and column, if there are errors: cells that are no numbers, times that do not rise.
std::optional<Trace> ReadTable(const std::string& path, const TableLayout& layout,
                               Diagnostics& out);

}  // namespace taut
