#include "shape_info.h"

#include <algorithm>
#include <charconv>
#include <string>

namespace taut::viewer {

Json ShapeOf(const TraceMetadata& metadata) {
  const auto text = [&](const char* key) {
    const auto at = std::find_if(metadata.begin(), metadata.end(),
                                 [&](const auto& entry) { return entry.first == key; });
    return at == metadata.end() ? std::string() : at->second;
  };
  const std::string name = text("shape");
  const std::size_t end = name.rfind('_');
  if (name.empty() || end == name.npos || text("shape_count").empty()) return nullptr;
  const auto number = [&](const char* key) {
    const std::string digits = text(key);
    double value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
  };
  Json shape{{"kind", name.substr(0, end)},
             {"number", static_cast<int>(number("shape_number"))},
             {"count", static_cast<int>(number("shape_count"))}};
  for (const char* key : {"frequency_hz", "slowdown", "amplitude"}) {
    const std::string entry = std::string("shape_") + key;
    if (!text(entry.c_str()).empty()) shape[key] = number(entry.c_str());
  }
  return shape;
}

}  // namespace taut::viewer
