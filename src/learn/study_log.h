/// Log of a study: an SQLite file with the study's definition and all evaluations
/// (docs/learning.md). With write-ahead logging, all logged evaluations remain complete if the
/// process is killed. Every record has a checksum, so that later changes are detected.
///
/// Threads: only one thread at a time may use a `Log`. Several processes may read a file while one
/// writes to it.
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

/// Version 2 added checksums.
inline constexpr int kLogVersion = 2;

/// Contents of a log after all checks.
struct LogContents {
  int version = 0;  ///< 0: the file is empty.
  /// Facts of the study. Keys: "name", "study", "experiment", "taut_version".
  std::map<std::string, std::string> facts;
  std::vector<StudyParameter> parameters;
  std::vector<Evaluation> evaluations;  ///< Valid evaluations in ascending order of id.
  /// Descriptions of invalid records, such as "evaluation 17: score is not a number". `evaluations`
  /// excludes them.
  std::vector<std::string> damage;
};

/// Returns whether the contents can be used. Reports damage as an error unless `skip_damaged`.
bool Accept(const LogContents& contents, const std::string& path, bool skip_damaged,
            Diagnostics& out);

class Log {
 public:
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Opens the file for writing; creates it if missing. The caller must hold the folder's lock.
  /// Returns null with an error on failure.
  static std::unique_ptr<Log> Open(const std::string& path, Diagnostics& out);
  /// Opens an existing file for reading.
  static std::unique_ptr<Log> OpenToRead(const std::string& path, Diagnostics& out);

  /// Reads and checks the file. Returns nothing with an error if the file is not a log, or too
  /// damaged to trust any evaluation.
  std::optional<LogContents> Read(Diagnostics& out);

  /// Prepares the file for `Add`; call it once. If the file is empty, damaged or of an older
  /// version, replaces it by `contents` in one transaction. Keeps a damaged file as `PATH.damaged`.
  bool Begin(const LogContents& contents, Diagnostics& out);
  /// Adds an evaluation with all its worlds in one transaction. Returns false with an error on
  /// failure, or if the file was deleted.
  bool Add(const Evaluation& evaluation, Diagnostics& out);
  /// Returns whether the file still exists at its path. Reports an error otherwise.
  bool IsThere(Diagnostics& out);

 private:
  Log(const std::string& path, Database::Open how) : database_(path, how), path_(path) {}
  bool Unwritten(const std::string& why, Diagnostics& out);  ///< Reports the error. Returns false.

  Database database_;
  std::string path_;
  /// Number of evaluations in the file, and sum of their checksums.
  std::uint64_t count_ = 0, sum_ = 0;
};

}  // namespace taut::learn
