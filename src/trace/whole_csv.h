/// Traces in CSV that are there complete or not at all.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/trace.h"

namespace taut::trace {

/// As `CreateCsvTrace`, but the file takes its name when it is finished, and never otherwise.
std::unique_ptr<TraceWriter> CreateWholeCsvTrace(const std::string& path,
                                                 const std::vector<ChannelInfo>& channels,
                                                 Diagnostics& out);

}  // namespace taut::trace
