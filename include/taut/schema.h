/// What the formats allow, for editors and for documents.
///
/// Threads: any number may call these functions at once.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace taut {

/// "model", "experiment", "gait", "study", "fit", "faults", "calibration"
/// and "catalogue".
const std::vector<std::string>& FormatNames();

/// The JSON schema (2020-12) of a format: all of its keys with their types, ranges, defaults and
/// meanings. A key with a unit has it as `unit`. Nothing if there is no such format.
std::optional<std::string> FormatSchema(std::string_view format);

}  // namespace taut
