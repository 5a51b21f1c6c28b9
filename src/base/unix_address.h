/// Address of a Unix domain socket in the file system.
#pragma once

#include <sys/un.h>

#include <cstring>
#include <string>

namespace taut {

/// Fills in the address. Returns false if the path is empty or longer than `sun_path`.
inline bool UnixAddress(const std::string& path, sockaddr_un* to) {
  *to = {};
  to->sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof to->sun_path) return false;
  std::memcpy(to->sun_path, path.c_str(), path.size() + 1);
  return true;
}

}  // namespace taut
