#include "apps/virtual_robot/robot_log.h"

#include <fmt/format.h>

namespace taut::virtual_robot {

std::string LogLine(Time at, std::string_view who, std::string_view what) {
  return fmt::format("{}.{:09} {}: {}\n", at / kSecond, at % kSecond / kNanosecond, who, what);
}

std::string Hex(const unsigned char* bytes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format("{}{:02x}", i == 0 ? "" : " ", bytes[i]);
  }
  return text;
}

}  // namespace taut::virtual_robot
