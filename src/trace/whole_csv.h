/// Writer of CSV traces that are published only when complete.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::trace {

/// Like `CreateCsvTrace`, but publishes the file only in `Finish`.
std::unique_ptr<TraceWriter> CreateWholeCsvTrace(const std::string& path,
                                                 const std::vector<ChannelInfo>& channels,
                                                 Diagnostics& out);

}  // namespace taut::trace
