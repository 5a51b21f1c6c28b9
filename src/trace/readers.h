/// Trace readers behind `ReadTrace`, one per file format.
#pragma once

#include <optional>
#include <string>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Reads a trace in HDF5. The library is known to crash on damaged files, so a child process opens
/// the file and sends its content.
std::optional<Trace> ReadHdf5(const std::string& path, Diagnostics& out);

/// Reads a trace in CSV, compressed with gzip or not.
std::optional<Trace> ReadCsv(const std::string& path, Diagnostics& out);

}  // namespace taut::trace
