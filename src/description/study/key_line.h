/// Lines of texts that identify a study or a fit.
#pragma once

#include <string>

namespace taut::description {

inline std::string KeyLine(const std::string& key, const std::string& value) {
  return key + ": " + value + "\n";
}

}  // namespace taut::description
