/// Trace readers used by `ReadTrace`, one per file format.
#pragma once

#include <optional>
#include <string>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Reads a trace in HDF5. A child process opens the file and sends its content, because the library
/// may crash on damaged files.
std::optional<Trace> ReadHdf5(const std::string& path, Diagnostics& out);

/// Reads a trace in CSV, with or without gzip compression.
std::optional<Trace> ReadCsv(const std::string& path, Diagnostics& out);

}  // namespace taut::trace
