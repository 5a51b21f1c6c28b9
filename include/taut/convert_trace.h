/// Recordings for other programs: as CSV, and as MCAP, which Foxglove, PlotJuggler and Rerun open
/// (docs/export.md, section 3).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/model_def.h"
#include "taut/trace.h"

namespace taut {

/// Of a trace some channels, those that fit any of the patterns with `*` (none: all), and rows that
/// are `period_s` apart at least, on a grid from the first on (0: all). Nothing, and a complaint at
/// `path`, if no channel fits.
std::optional<Trace> SelectFrom(Trace trace, const std::vector<std::string>& channels,
                                double period_s, const std::string& path, Diagnostics& out);

enum class Conversion { kDone, kStopped, kFailed };

/// Is asked now and then, with the share that is done; false: to stop.
using GoOn = std::function<bool(double share)>;

/// Both write a file that takes its name when all of it is on the disk: one that was stopped, or
/// that there was no room for, leaves what had the name before. `kFailed`: with a complaint.
Conversion WriteTraceCsv(const Trace& trace, const std::string& path, const GoOn& go_on,
                         Diagnostics& out);

/// A topic for each first part of channels' names (`/cable`, `/body`), with a message a row; where
/// the trace has places and turns of bodies `/tf` with their frames, and where `robot`, as it was
/// described when it was recorded, is not null `/scene/robot` with its shapes, once, and
/// `/scene/cables`, if all of its bodies that move are there. Times are those of the trace, from
/// 1970 on; of one that begins before 0 from its first row.
Conversion WriteTraceMcap(const Trace& trace, const ModelDef* robot, const std::string& path,
                          const GoOn& go_on, Diagnostics& out);

}  // namespace taut
