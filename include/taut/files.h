/// Atomic file replacement, and folder locks between processes.
///
/// Threads: any number may call these functions concurrently. If two processes write the same file,
/// it contains the complete text of one of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "taut/diagnostics.h"

namespace taut {

/// Writes `text` to `path` atomically. At any time, also after a kill or a power failure, the file
/// is the old one or the new one: the text is written to a file in the same folder
/// (`<path>.<process>.part`), flushed to the disk and then renamed. A symbolic link at `path` is
/// replaced and its target stays unchanged. Pipes, terminals and everything below /dev are written
/// directly. Returns false and adds an error on failure.
bool WriteWholeFile(const std::string& path, std::string_view text, Diagnostics& out);

/// File that gets its final name once it is complete. Until then, an older file of that name stays.
///
/// Thread-compatible: one thread at a time. After a function has returned false, `why()` is the
/// reason.
class NewFile {
 public:
  explicit NewFile(std::string path) : path_(std::move(path)) {}
  ~NewFile();  ///< Removes an unpublished file, unless `Leave` was called.
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Creates the file in the folder of its path, under a unique name that no link points to.
  bool Create();
  const std::string& path() const { return path_; }
  /// Returns the temporary path, valid until the file is published.
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
/// Returns the identity of the file at `path`; {0, 0} without a file.
FileIdentity IdentityOf(const std::string& path);

/// Lock on a folder, held by one process at a time, for exclusive writing. It ends with the object
/// or with the process, also if that crashes; the empty file `.lock` stays.
class FolderLock {
 public:
  /// Locks a folder, and creates it if it is missing. Returns null and adds an error if it cannot
  /// be created or written, or if another process holds the lock.
  static std::unique_ptr<FolderLock> Take(const std::string& folder, Diagnostics& out);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Returns false once the folder was deleted or replaced by another one, which this lock does not
  /// cover.
  bool Holds() const;

 private:
  FolderLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

  std::string path_;
  int descriptor_;
};

}  // namespace taut
