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

/// Selects channels and rows of a trace. `channels`: patterns with `*`; a channel is kept if any
/// pattern matches; empty: all. `period_s`: minimum time between rows, on a grid that starts at the
/// first row; 0: all rows. Returns nothing and adds an error at `path` if no channel matches.
std::optional<Trace> SelectFrom(Trace trace, const std::vector<std::string>& channels,
                                double period_s, const std::string& path, Diagnostics& out);

enum class Conversion { kDone, kStopped, kFailed };

/// Progress callback with the completed fraction (0..1), called every few hundred rows. Return
/// false to stop the conversion.
using GoOn = std::function<bool(double share)>;

/// Writes a CSV file. `path` gets the new file only after it is completely on the disk; if the
/// conversion stops or fails, an older file remains. Returns `kFailed` and adds an error if the
/// file cannot be written. `WriteTraceMcap` behaves the same way.
Conversion WriteTraceCsv(const Trace& trace, const std::string& path, const GoOn& go_on,
                         Diagnostics& out);

/// Writes an MCAP file with one message per row and one topic per first part of the channel names
/// (`/cable`, `/body`). If the trace contains body positions and orientations, `/tf` contains their
/// frames. If `robot` (as described at recording) is also given, `/scene/robot` contains its shapes
/// once. If the trace contains all moving bodies, `/scene/cables` contains its cables. Time 0 of
/// the trace, or its first row if that is before 0, becomes Unix time 0 (1970).
Conversion WriteTraceMcap(const Trace& trace, const ModelDef* robot, const std::string& path,
                          const GoOn& go_on, Diagnostics& out);

}  // namespace taut
