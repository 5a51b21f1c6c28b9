/// What to call runs that are shown beside each other.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/trace.h"

namespace taut::viewer {

/// What a trace's metadata say under a key; empty if nothing.
std::string Said(const Trace& trace, std::string_view key);

struct NamedTrace {
  const Trace* trace = nullptr;
  std::string path;
};

/// For each what it says of itself, and its folder and file: every run's is a trace.h5. Where two
/// would have one name, as much more of their paths as tells them apart.
std::vector<std::string> RunNames(const std::vector<NamedTrace>& traces);

}  // namespace taut::viewer
