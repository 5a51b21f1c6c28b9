/// Report of a run as one HTML file that opens from disk: the viewer's page with the data embedded.
#pragma once

#include <optional>
#include <string>

#include "recorded.h"
#include "taut/diagnostics.h"

namespace taut::viewer {

/// Limit on the numbers from traces in a report, frames excluded: 24 MB, 32 MB in base64. All
/// compared runs share this limit.
inline constexpr std::size_t kMaxReportNumbers = 3'000'000;

/// Returns the Report of web/protocol/messages.json. A trace with more numbers than its share of
/// `max_numbers` is reduced to blocks of rows.
Json ReportOf(const Recorded& recorded, std::size_t max_numbers = kMaxReportNumbers);

/// Inserts the data into the empty <script id="taut-report"> of `page`. Returns nothing if the page
/// has no such element.
std::optional<std::string> ReportPage(const Json& report, const std::string& page);

/// Reads the trace at `trace` (and the other files of its folder) and writes the report to `path`.
/// Returns false, with errors in the diagnostics, on failure. `compare`: as for `Recorded::Load`.
bool WriteReport(const std::string& trace, const std::vector<std::string>& compare,
                 const std::string& path, Diagnostics& out);

}  // namespace taut::viewer
