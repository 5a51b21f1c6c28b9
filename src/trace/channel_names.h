/// Rules for channel names, which all trace formats share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/trace.h"

namespace taut::trace {

/// Reports names that a trace cannot contain: empty, duplicate, `time_s`, or with characters that
/// CSV headers or HDF5 paths do not permit. Returns false if there are any.
bool CheckChannelNames(const std::string& path, const std::vector<ChannelInfo>& channels,
                       Diagnostics& out);

/// Returns whether a name is one of taut's own channels, whose unit is part of the name, such as
/// `cable/c1/tension_n`.
bool IsTautChannel(const std::string& name);

/// Returns the unit of a table's column: of taut's own channels the unit in the name, otherwise 1.
std::string TableUnit(const std::string& name);

}  // namespace taut::trace
