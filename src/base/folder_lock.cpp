#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "taut/files.h"

namespace taut {

std::unique_ptr<FolderLock> FolderLock::Take(const std::string& folder, Diagnostics& out) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    out.Error("folder.not_made", {folder}, "cannot create the folder: " + error.message());
    return nullptr;
  }
  const std::string path = (std::filesystem::path(folder) / ".lock").string();
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  std::unique_ptr<FolderLock> lock(new FolderLock(path, descriptor));
  if (descriptor < 0) {
    out.Error("folder.not_writable", {folder},
              std::string("cannot write to the folder: ") + std::strerror(errno));
  } else if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) {
      out.Error("folder.locked", {folder}, "another process is writing into this folder",
                "wait for it, stop it, or give `--out` another folder");
    } else {
      out.Error("folder.lock_failed", {path},
                std::string("cannot lock the file: ") + std::strerror(errno));
    }
  } else if (!lock->Holds()) {
    out.Error("folder.deleted", {folder}, "the folder has just been deleted");
  } else {
    return lock;
  }
  return nullptr;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool FolderLock::Holds() const {
  struct stat ours {
  }, there{};
  return fstat(descriptor_, &ours) == 0 && lstat(path_.c_str(), &there) == 0 &&
         ours.st_dev == there.st_dev && ours.st_ino == there.st_ino;
}

}  // namespace taut
