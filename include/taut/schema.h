/// JSON schemas of the file formats, for editors and documents.
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut {

/// Returns the names of the formats: "model", "experiment", "gait", "study", "fit", "faults",
/// "calibration" and "catalogue".
const std::vector<std::string>& FormatNames();

/// Returns the JSON schema (2020-12) of a format: all keys with types, ranges, defaults and
/// descriptions. Keys with a unit have the property `unit`. Returns nothing for an unknown format.
std::optional<std::string> FormatSchema(std::string_view format);

}  // namespace taut
