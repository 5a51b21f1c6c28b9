/// Atomic file replacement, and folder locks between processes.
///
/// Threads: any number may call these functions concurrently. If two processes write the same file,
/// the file contains the complete text of one of them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "taut/diagnostics.h"

namespace taut {

/// Writes `text` to `path` atomically: after a kill or power failure, the file is either the old or
/// the new one. The text is written to `<path>.<process>.part` in the same folder, flushed to the
/// disk, and renamed. A symbolic link at `path` is replaced; its target stays unchanged. Pipes,
/// terminals and files below /dev are written directly. Returns false and adds an error on failure.
bool WriteWholeFile(const std::string& path, std::string_view text, Diagnostics& out);

/// File that appears under its name only when complete. Until then, an older file of that name
/// remains.
///
/// Thread-compatible: one thread at a time. If a function returns false, `why()` contains the
/// reason.
class NewFile {
 public:
  explicit NewFile(std::string path) : path_(std::move(path)) {}
  ~NewFile();  ///< Removes an unpublished file, unless `Leave` was called.
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Creates the file under a unique name in the folder of its path; never follows a link.
  bool Create();
  const std::string& path() const { return path_; }
  /// Returns the temporary path; valid until `Publish`.
  const std::string& made_at() const { return made_at_; }

  bool Write(std::string_view bytes);
  /// Writes all bytes or, if the disk is full, none; the earlier contents remain.
  bool WriteAllOrNone(std::string_view bytes);
  /// Flushes the file to the disk and renames it to its final name. A second call has no effect.
  bool Publish();
  /// Flushes the file to the disk.
  bool Sync();
  /// Keeps the temporary file `made_at()` even without `Publish`.
  void Leave() { left_ = true; }

  bool published() const { return published_; }
  const std::string& why() const { return why_; }

 private:
  bool Fail();

  std::string path_, made_at_, why_;
  int descriptor_ = -1;
  bool published_ = false, left_ = false;
};

/// Identity of the file at a path. The identity changes if another file replaces that file.
struct FileIdentity {
  std::uint64_t device = 0, file = 0;  ///< Device and file number; 0, 0: no file.
  bool operator==(const FileIdentity&) const = default;
};
/// Returns the identity of the file at `path`; {0, 0} without a file.
FileIdentity IdentityOf(const std::string& path);

/// Lock on a folder for exclusive writing by one process. The lock ends with the object or with the
/// process, even after a crash; the empty file `.lock` remains.
class FolderLock {
 public:
  /// Locks a folder; creates it if necessary. Returns null and adds an error if the folder cannot
  /// be created or written, or if another process holds the lock.
  static std::unique_ptr<FolderLock> Take(const std::string& folder, Diagnostics& out);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Returns false if the folder was deleted or replaced; the lock does not cover a new folder.
  bool Holds() const;

 private:
  FolderLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

  std::string path_;
  int descriptor_;
};

}  // namespace taut
