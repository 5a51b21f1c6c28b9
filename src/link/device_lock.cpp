#include "link/device_lock.h"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cinttypes>
#include <cstdio>
#include <fstream>

namespace taut::link {

std::optional<pid_t> DriverOf(const std::string& device) {
  struct stat is {};
  if (stat(device.c_str(), &is) != 0) return std::nullopt;
  // Example line: "1: FLOCK  ADVISORY  WRITE 4711 00:18:5 0 EOF".
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    int process = 0;
    unsigned major_number = 0, minor_number = 0;
    std::uint64_t inode = 0;
    if (std::sscanf(line.c_str(), "%*d: FLOCK %*s WRITE %d %x:%x:%" SCNu64, &process, &major_number,
                    &minor_number, &inode) == 4 &&
        inode == is.st_ino && major_number == major(is.st_dev) &&
        minor_number == minor(is.st_dev)) {
      return process;
    }
  }
  return std::nullopt;
}

std::string DeviceKey(const std::string& device) {
  struct stat is {};
  if (stat(device.c_str(), &is) != 0) return {};
  if (S_ISCHR(is.st_mode)) {
    return std::to_string(major(is.st_rdev)) + ":" + std::to_string(minor(is.st_rdev));
  }
  return std::to_string(is.st_dev) + ":file " + std::to_string(is.st_ino);
}

}  // namespace taut::link
