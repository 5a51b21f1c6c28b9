/// Structure of an HDF5 trace file: opening, checks and columns. Used in a child process only: HDF5
/// may crash on a damaged file.
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
  hsize_t chunk_rows = 0;  ///< Rows that can only be unpacked together; 0: each separately.
  int place = 0;           ///< Attribute `column`: place in a row; without it: after the others.
};

/// An open trace: its structure, without the numbers.
struct Hdf5File {
  Hdf5Id file;
  bool cut_off = false;  ///< Never finished, or still being written.
  TraceMetadata metadata;
  Hdf5Column time;
  std::vector<Hdf5Column> channels;  ///< In the order of a row.
  hsize_t rows = 0;                  ///< Rows that are complete in every column.
};

/// Returns nothing and a sentence in `error` if the file is not a trace.
std::optional<Hdf5File> OpenHdf5Trace(const std::string& path, std::string& error);

/// Reads rows from .. from + count. Returns false and a sentence in `error` on failure.
bool ReadHdf5Rows(const Hdf5Column& column, hsize_t from, hsize_t count, double* to,
                  std::string& error);

}  // namespace taut::trace
