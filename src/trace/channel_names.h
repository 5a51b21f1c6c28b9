/// Rules for the names of channels, the same for every kind of trace file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// The unit that a name ends with: "N" for `cable/a/tension_n`, "m/s" for `.../rate_m_per_s`, "1"
/// where the name states none. For files that cannot store units.
std::string UnitOfName(std::string_view name);

/// Complains about names that a trace cannot hold: empty, given twice, `time_s`, characters that a
/// CSV header or an HDF5 path cannot carry. False if there are any.
bool CheckChannelNames(const std::string& path, const std::vector<ChannelInfo>& channels,
                       Diagnostics& out);

}  // namespace taut::trace
