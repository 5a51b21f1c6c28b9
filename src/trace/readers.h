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

/// Reads a trace from MCAP, with one channel `topic/field` per number of a message, and rows at the
/// times of all messages. Between the messages of a topic, its values are interpolated linearly,
/// except in gaps. Times since 1970 are shifted to begin at 0 s.
std::optional<Trace> ReadMcap(const std::string& path, Diagnostics& out);

/// Reads the variables of a MATLAB file (`IsMatFile`) as columns. Uses only the clock and `ignore`
/// of the layout.
std::optional<Trace> ReadMatTable(const std::string& path, const TableLayout& layout,
                                  Diagnostics& out);

/// Returns the trace, or an error if a time is so large that spans of times are not finite.
std::optional<Trace> WithFiniteSpans(const std::string& path, std::optional<Trace> trace,
                                     Diagnostics& out);

}  // namespace taut::trace
