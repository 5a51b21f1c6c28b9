#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/open_input.h"
#include "taut/files.h"

namespace taut {
namespace {

/// Returns true for a device or pipe, which can be written to but not replaced.
bool IsDevice(const std::string& path) {
  for (const char* open_already : {"/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/"}) {
    if (path.starts_with(open_already)) return true;  // a link to an open file
  }
  struct stat info {};
  return lstat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISLNK(info.st_mode) &&
         !S_ISDIR(info.st_mode);
}

/// Flushes a file to the disk. Files that do not support this, such as pipes, are no error.
bool SyncDescriptor(int descriptor) {
  return fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
}

/// Flushes the folder of a file; a new file name is on the disk only after that.
bool SyncFolderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return true;  // the folder is writable but not readable
  const bool good = SyncDescriptor(descriptor);
  const int error = errno;
  close(descriptor);
  errno = error;
  return good;
}

}  // namespace

FileIdentity IdentityOf(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino};
}

NewFile::~NewFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (!published_ && !left_) unlink(made_at_.c_str());
}

bool NewFile::Fail() {
  why_ = std::strerror(errno);
  return false;
}

bool NewFile::Create() {
  if (IsDevice(path_)) {
    made_at_ = path_;
    published_ = true;
    descriptor_ = base::OpenToAppend(path_).Release();
    if (descriptor_ >= 0) return true;
    why_ = base::OpenError(errno);
    return false;
  }
  const std::string name = path_ + "." + std::to_string(getpid());
  for (int i = 1; descriptor_ < 0; ++i) {
    made_at_ = name + (i == 1 ? "" : "_" + std::to_string(i)) + ".part";
    descriptor_ =
        open(made_at_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) return Fail();
  }
  return true;
}

bool NewFile::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return Fail();
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool NewFile::WriteAllOrNone(std::string_view bytes) {
  struct stat before {};
  if (fstat(descriptor_, &before) != 0) return Fail();
  if (Write(bytes)) return true;
  // Truncate to the previous size and continue there. This is impossible for devices and pipes.
  if (ftruncate(descriptor_, before.st_size) == 0) lseek(descriptor_, before.st_size, SEEK_SET);
  return false;
}

bool NewFile::Publish() {
  if (published_) return true;
  if (!Sync()) return false;
  if (std::rename(made_at_.c_str(), path_.c_str()) != 0) return Fail();
  published_ = true;
  return SyncFolderOf(path_) || Fail();
}

bool NewFile::Sync() { return SyncDescriptor(descriptor_) || Fail(); }

bool WriteWholeFile(const std::string& path, std::string_view text, Diagnostics& out) {
  NewFile file(path);
  if (file.Create() && file.Write(text) && file.Publish()) return true;
  out.Error("file.not_writable", {path}, "cannot write: " + file.why());
  return false;
}

}  // namespace taut
