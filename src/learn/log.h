/// A study's memory: one SQLite file with what was asked and every evaluation
/// (docs/formats/study.md). Write-ahead: a process killed at any moment leaves every evaluation
/// that it has logged, and no half of one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/learn.h"

struct sqlite3;

namespace taut::learn {

inline constexpr int kLogVersion = 1;

class Log {
 public:
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Opens the file for writing, or makes it; the caller holds the folder's lock. Null and a
  /// complaint if it cannot or if it is something else.
  static std::unique_ptr<Log> Open(const std::string& path, Diagnostics& out);
  /// For reading; it must be there.
  static std::unique_ptr<Log> OpenToRead(const std::string& path, Diagnostics& out);

  /// Facts about the study as a whole: "study", "experiment", "taut_version" ... Nothing if
  /// unknown.
  std::optional<std::string> Fact(const std::string& name);
  bool SetFact(const std::string& name, const std::string& value);

  bool SetParameters(const std::vector<StudyParameter>& parameters);
  std::vector<StudyParameter> Parameters();

  /// Adds an evaluation with all its worlds, at once or not at all.
  bool Add(const Evaluation& evaluation);
  /// All of them, by id.
  std::vector<Evaluation> Evaluations();

  /// What went wrong last: "database or disk is full".
  std::string error() const;

 private:
  explicit Log(sqlite3* db, std::string path) : db_(db), path_(std::move(path)) {}
  bool Execute(const char* sql);

  sqlite3* db_;
  std::string path_;
};

}  // namespace taut::learn
