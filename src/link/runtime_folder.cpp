#include "link/runtime_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace taut::link {

std::string RuntimeFolder(Diagnostics& out) {
  const char* const given = std::getenv("XDG_RUNTIME_DIR");
  std::string folder = given != nullptr && *given != '\0' ? std::string(given) + "/taut"
                                                          : "/tmp/taut-" + std::to_string(getuid());
  if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    out.Error("folder.not_made", {folder},
              std::string("cannot create the folder: ") + std::strerror(errno));
    return {};
  }
  // Another user may have created a folder with this name in /tmp.
  struct stat is {};
  if (lstat(folder.c_str(), &is) != 0 || !S_ISDIR(is.st_mode) || is.st_uid != getuid() ||
      (is.st_mode & 077) != 0) {
    out.Error("folder.not_private", {folder},
              "the folder must be yours, and accessible to you only",
              "run chmod 700 on it, or delete it");
    return {};
  }
  return folder;
}

}  // namespace taut::link
