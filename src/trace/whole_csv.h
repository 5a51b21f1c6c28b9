/// CSV traces that are published only when complete.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::trace {

/// As `CreateCsvTrace`, but the file gets its name when it is finished, and never otherwise.
std::unique_ptr<TraceWriter> CreateWholeCsvTrace(const std::string& path,
                                                 const std::vector<ChannelInfo>& channels,
                                                 Diagnostics& out);

}  // namespace taut::trace
