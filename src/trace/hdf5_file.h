/// Opens and walks an HDF5 trace. Used in a child process only: HDF5 may crash on a damaged file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/trace.h"
#include "trace/hdf5.h"

namespace taut::trace {

/// A dataset of the file.
struct Hdf5Column {
  std::string name;  ///< Without the leading slash.
  std::string unit;
  Hdf5Id dataset;
  hsize_t rows = 0;
  hsize_t chunk_rows = 0;  ///< Rows that can only be unpacked together; 0: each alone.
  int place = 0;  ///< Attribute `column`: its place in a row. Without one: after all that have.
};

/// An open trace: what it holds, not yet the numbers.
struct Hdf5File {
  Hdf5Id file;
  bool cut_off = false;  ///< Never finished, or still being written.
  TraceMetadata metadata;
  Hdf5Column time;
  std::vector<Hdf5Column> channels;  ///< In the order of a row.
  hsize_t rows = 0;                  ///< Complete in every column.
};

/// Nothing and a sentence in `error` if the file is not a trace.
std::optional<Hdf5File> OpenHdf5Trace(const std::string& path, std::string& error);

/// Reads rows from .. from + count. False and a sentence in `error` if that fails.
bool ReadHdf5Rows(const Hdf5Column& column, hsize_t from, hsize_t count, double* to,
                  std::string& error);

}  // namespace taut::trace
