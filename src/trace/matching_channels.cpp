// Channels whose names match a pattern.
#include "base/pattern.h"
#include "taut/trace_channels.h"

namespace taut {

std::vector<std::size_t> MatchingChannels(const Trace& trace, std::string_view pattern) {
  std::vector<std::size_t> matching;
  for (std::size_t i = 0; i < trace.channels.size(); ++i) {
    if (base::Fits(pattern, trace.channels[i].name)) matching.push_back(i);
  }
  return matching;
}

}  // namespace taut
