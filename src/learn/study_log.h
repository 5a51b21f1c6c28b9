/// Log of a study: an SQLite file with the study's definition and every evaluation
/// (docs/learning.md). Write-ahead logging: a process killed at any moment leaves every logged
/// evaluation complete. Every record has a checksum, so that later changes are detected and
/// reported.
///
/// Threads: a `Log` may be used by one thread at a time. Several processes may read a file while
/// one writes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "learn/sqlite.h"
#include "taut/diagnostics.h"
#include "taut/learn.h"

namespace taut::learn {

/// Version 1 had no checksums.
inline constexpr int kLogVersion = 2;

/// Contents of a log, after all checks.
struct LogContents {
  int version = 0;  ///< 0: the file is empty.
  /// Facts of the study: "name", "study", "experiment", "taut_version".
  std::map<std::string, std::string> facts;
  std::vector<StudyParameter> parameters;
  std::vector<Evaluation> evaluations;  ///< Valid evaluations, by id.
  /// Descriptions of invalid records, which `evaluations` lacks: "evaluation 17: score is not a
  /// number".
  std::vector<std::string> damage;
};

/// Returns whether the contents may be used. Damage is an error unless it is to be skipped.
bool Accept(const LogContents& contents, const std::string& path, bool skip_damaged,
            Diagnostics& out);

class Log {
 public:
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Opens the file for writing, or creates it; the caller holds the folder's lock. Returns null
  /// with an error if that fails.
  static std::unique_ptr<Log> Open(const std::string& path, Diagnostics& out);
  /// Opens an existing file for reading.
  static std::unique_ptr<Log> OpenToRead(const std::string& path, Diagnostics& out);

  /// Reads and checks the file. Returns nothing, with an error, if the file is not a log, or is so
  /// damaged that no evaluation can be trusted.
  std::optional<LogContents> Read(Diagnostics& out);

  /// Prepares the file for `Add`; call once. If the file was empty, of an older version or damaged,
  /// it is replaced by `contents` in one transaction (a damaged file is kept as `PATH.damaged`).
  bool Begin(const LogContents& contents, Diagnostics& out);
  /// Adds an evaluation with all its worlds in one transaction. Returns false with an error if that
  /// fails or the file is gone.
  bool Add(const Evaluation& evaluation, Diagnostics& out);
  /// Returns false with an error if the file was deleted or moved.
  bool IsThere(Diagnostics& out);

 private:
  Log(const std::string& path, Database::Open how) : database_(path, how), path_(path) {}
  bool Unwritten(const std::string& why, Diagnostics& out);  ///< Returns false.

  Database database_;
  std::string path_;
  /// Number of the evaluations in the file, and sum of their checksums.
  std::uint64_t count_ = 0, sum_ = 0;
};

}  // namespace taut::learn
