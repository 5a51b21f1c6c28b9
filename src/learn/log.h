/// A study's memory: one SQLite file with what was asked and every evaluation (docs/learning.md).
/// Write-ahead: a process killed at any moment leaves every evaluation that it has logged, and no
/// half of one. Every record has a checksum: one that was changed since is found and named.
///
/// Threads: a `Log` belongs to one at a time. Several processes may read a file while one writes.
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

/// All that a log holds, looked at closely.
struct LogContents {
  int version = 0;  ///< 0: the file is empty.
  /// About the study as a whole: "name", "study", "experiment", "taut_version".
  std::map<std::string, std::string> facts;
  std::vector<StudyParameter> parameters;
  std::vector<Evaluation> evaluations;  ///< By id; the good ones.
  /// What is not good, and so not in `evaluations`: "evaluation 17: score is not a number".
  std::vector<std::string> damage;
};

/// Whether the contents may be used. Damage is an error unless it is to be skipped.
bool Accept(const LogContents& contents, const std::string& path, bool skip_damaged,
            Diagnostics& out);

class Log {
 public:
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Opens the file for writing, or makes it; the caller holds the folder's lock. Null and a
  /// complaint if it cannot.
  static std::unique_ptr<Log> Open(const std::string& path, Diagnostics& out);
  /// For reading; it must be there.
  static std::unique_ptr<Log> OpenToRead(const std::string& path, Diagnostics& out);

  /// Nothing and a complaint if the file is something else, or so damaged that no evaluation in it
  /// can be trusted.
  std::optional<LogContents> Read(Diagnostics& out);

  /// To be called once before `Add`. What was read stays, or becomes the file if that was empty, of
  /// an older version or damaged (then the old file stays as `PATH.damaged`): at once or not at
  /// all.
  bool Begin(const LogContents& contents, Diagnostics& out);
  /// Adds an evaluation with all its worlds, at once or not at all. False and a complaint if it
  /// cannot, or if the file is gone.
  bool Add(const Evaluation& evaluation, Diagnostics& out);
  /// False and a complaint if the file was deleted or moved.
  bool IsThere(Diagnostics& out);

 private:
  Log(const std::string& path, Database::Open how) : database_(path, how), path_(path) {}
  bool Unwritten(const std::string& why, Diagnostics& out);  ///< False.

  Database database_;
  std::string path_;
  std::uint64_t count_ = 0, sum_ = 0;  ///< Of what the file holds: evaluations, their checksums.
};

}  // namespace taut::learn
