/// A run as one HTML file that opens from disk: the viewer's page with the data inside.
#pragma once

#include <optional>
#include <string>

#include "recorded.h"
#include "taut/diagnostics.h"

namespace taut::viewer {

/// Numbers of traces that a report holds at most, besides its frames: 24 MB, in base64 32. Runs
/// that are compared share them.
inline constexpr std::size_t kMaxReportNumbers = 3'000'000;

/// The Report of web/protocol/messages.json. A trace with more numbers than its share of
/// `max_numbers` is in it as blocks of rows.
Json ReportOf(const Recorded& recorded, std::size_t max_numbers = kMaxReportNumbers);

/// The page `page` with the data in its empty <script id="taut-report">. Nothing if it has none.
std::optional<std::string> ReportPage(const Json& report, const std::string& page);

/// Reads the trace at `trace` (and what is beside it), writes the report to `path`. False and
/// diagnostics if that fails.
/// `compare`: as `Recorded::Load` takes it.
bool WriteReport(const std::string& trace, const std::vector<std::string>& compare,
                 const std::string& path, Diagnostics& out);

}  // namespace taut::viewer
