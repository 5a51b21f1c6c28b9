/// Distinct names for runs that are shown together.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/trace.h"

namespace taut::viewer {

/// Returns the value of a key in a trace's metadata; empty if the key is missing.
std::string Said(const Trace& trace, std::string_view key);

struct NamedTrace {
  const Trace* trace = nullptr;
  std::string path;
};

/// Returns for each run the name in its metadata, with folder and file, since all traces are named
/// trace.h5. Equal names are extended by as many path components as make them distinct.
std::vector<std::string> RunNames(const std::vector<NamedTrace>& traces);

}  // namespace taut::viewer
