/// Export of traces to CSV, and to MCAP for Foxglove, PlotJuggler and Rerun (docs/export.md,
/// section 3).
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/model_def.h"
#include "taut/trace.h"

namespace taut {

/// Selects channels and rows of a trace. Channels: all that match any of the patterns with `*` (no
/// patterns: all channels). Rows: at least `period_s` apart, on a grid that starts at the first row
/// (0: all rows). Returns nothing and adds an error at `path` if no channel matches.
std::optional<Trace> SelectFrom(Trace trace, const std::vector<std::string>& channels,
                                double period_s, const std::string& path, Diagnostics& out);

enum class Conversion { kDone, kStopped, kFailed };

/// Progress callback, called every few hundred rows with the completed share (0..1). Returning
/// false stops the conversion.
using GoOn = std::function<bool(double share)>;

/// Writes a CSV file. The file appears under `path` only when it is complete and on the disk; if
/// the conversion stops or the disk is full, an older file of that name remains. Returns `kFailed`
/// and adds an error if the file cannot be written. `WriteTraceMcap` does the same.
Conversion WriteTraceCsv(const Trace& trace, const std::string& path, const GoOn& go_on,
                         Diagnostics& out);

/// Writes an MCAP file with one topic for each first part of channel names (`/cable`, `/body`) and
/// one message per row. If the trace contains positions and orientations of bodies, `/tf` has their
/// frames. If also `robot` (as described when the trace was recorded) is not null,
/// `/scene/robot` has its shapes, once, and, if the trace contains all moving bodies,
/// `/scene/cables` its cables. Times are the trace's, counted from 1970; in a trace that begins
/// before 0, from its first row.
Conversion WriteTraceMcap(const Trace& trace, const ModelDef* robot, const std::string& path,
                          const GoOn& go_on, Diagnostics& out);

}  // namespace taut
