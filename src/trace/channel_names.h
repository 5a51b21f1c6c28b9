/// Rules for the names of channels, the same for every format of trace files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Reports names that a trace cannot contain: empty, duplicate, `time_s`, or with characters that a
/// CSV header or an HDF5 path cannot contain. Returns false if there are any.
bool CheckChannelNames(const std::string& path, const std::vector<ChannelInfo>& channels,
                       Diagnostics& out);

}  // namespace taut::trace
