/// Structure of an HDF5 trace file: opening, checks and columns. Use it in a child process only,
/// since HDF5 may crash on a damaged file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/trace.h"
#include "trace/hdf5.h"

namespace taut::trace {

/// Dataset with the values of one channel, or with the times.
struct Hdf5Column {
  std::string name;  ///< Path of the dataset, without leading slash.
  std::string unit;
  Hdf5Id dataset;
  hsize_t rows = 0;
  hsize_t chunk_rows = 0;  ///< Number of rows per chunk, which must be unpacked together; 0: not
                           ///< chunked.
  int place = 0;           ///< Attribute `column`: position in a row. Columns without it are last.
};

/// Open trace without its numbers.
struct Hdf5File {
  Hdf5Id file;
  bool cut_off = false;  ///< Whether the file is unfinished, or still being written.
  TraceMetadata metadata;
  Hdf5Column time;
  std::vector<Hdf5Column> channels;  ///< In the order of the columns in a row.
  hsize_t rows = 0;                  ///< Number of rows that are complete in all columns.
};

/// Opens a trace. Returns nothing and sets `error` if the file is not a trace.
std::optional<Hdf5File> OpenHdf5Trace(const std::string& path, std::string& error);

/// Reads `count` rows, starting at row `from`. Returns false and sets `error` on failure.
bool ReadHdf5Rows(const Hdf5Column& column, hsize_t from, hsize_t count, double* to,
                  std::string& error);

}  // namespace taut::trace
