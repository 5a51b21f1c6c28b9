/// Files that are there complete or not at all, and folders that one process writes to.
///
/// Threads: any number may call these functions at once. Processes: two that write the same file
/// leave the whole text of one of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "taut/diagnostics.h"

namespace taut {

/// Writes `text` to `path`. At every moment, also after a kill or a power cut, the file is the old
/// one or the new one: the text goes to another file beside it (`<path>.<process>.part`), to the
/// disk, and then gets the name. A symbolic link at `path` is replaced, what it points to stays as
/// it is. What is no file (a pipe, a terminal, all below /dev) is written to as it is. False and a
/// complaint if that fails.
bool WriteWholeFile(const std::string& path, std::string_view text, Diagnostics& out);

/// A file that takes its name once it is complete. Until then, an older file of that name stays.
///
/// Belongs to one thread at a time. After a function has returned false, `why()` is the reason.
class NewFile {
 public:
  explicit NewFile(std::string path) : path_(std::move(path)) {}
  ~NewFile();  ///< Removes an unpublished file, unless `Leave` was called.
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Creates the file in the folder of its path, under a unique name that no link points to.
  bool Create();
  const std::string& path() const { return path_; }
  /// Where it is until it is published.
  const std::string& made_at() const { return made_at_; }

  bool Write(std::string_view bytes);
  /// Writes all of the bytes or none: without room, the file keeps its earlier contents.
  bool WriteAllOrNone(std::string_view bytes);
  /// Flushes the file to the disk and gives it its name. Does nothing the second time.
  bool Publish();
  /// Flushes the file to the disk.
  bool Sync();
  /// Keeps the file at `made_at()` even if it is never published.
  void Leave() { left_ = true; }

  bool published() const { return published_; }
  const std::string& why() const { return why_; }

 private:
  bool Fail();

  std::string path_, made_at_, why_;
  int descriptor_ = -1;
  bool published_ = false, left_ = false;
};

/// Identity of the file at a path: differs once another file replaces it.
struct FileIdentity {
  std::uint64_t device = 0, file = 0;  ///< 0, 0: no file.
  bool operator==(const FileIdentity&) const = default;
};
FileIdentity IdentityOf(const std::string& path);

/// The right to write into a folder, which one process at a time has. It ends with the object or
/// with the process, however that ends; the empty file `.lock` stays.
class FolderLock {
 public:
  /// Makes the folder where there is none. Null and a complaint if it cannot be made or written, or
  /// if another process has the right.
  static std::unique_ptr<FolderLock> Take(const std::string& folder, Diagnostics& out);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// False once the folder was deleted or replaced by another, which is then somebody else's.
  bool Holds() const;

 private:
  FolderLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

  std::string path_;
  int descriptor_;
};

}  // namespace taut
