/// Rules for the names of channels, the same for every kind of trace file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Complains about names that a trace cannot hold: empty, given twice, `time_s`, characters that a
/// CSV header or an HDF5 path cannot carry. False if there are any.
bool CheckChannelNames(const std::string& path, const std::vector<ChannelInfo>& channels,
                       Diagnostics& out);

}  // namespace taut::trace
