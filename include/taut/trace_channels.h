/// Selection of channels by patterns of their names, as in `taut compare --channels`.
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "taut/trace.h"

namespace taut {

/// Returns the indices of the channels whose names match `pattern`, in the order of the trace. `*`
/// matches any number of characters, including slashes; every other character matches itself.
std::vector<std::size_t> MatchingChannels(const Trace& trace, std::string_view pattern);

}  // namespace taut
