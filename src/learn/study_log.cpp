#include "learn/study_log.h"

#include <algorithm>
#include <filesystem>
#include <new>

#include "learn/log_rows.h"

namespace taut::learn {
namespace {

namespace fs = std::filesystem;

/// Limit of errors reported per file.
constexpr std::size_t kMostComplaints = 20;

/// Size of a database without tables (one page). If a larger file seems to have no tables, it is
/// damaged.
constexpr std::uintmax_t kEmptyBytes = 4096;

constexpr const char* kYours = "check the permissions of the folder and the free disk space";

/// Reads the schema of the file: the SQL text of each table.
bool ReadSchema(Database& database, std::string& schema) {
  Statement get(database, "SELECT type, name, sql FROM sqlite_schema ORDER BY name, type");
  return get.Run([&](Row& row) {
    for (int column = 0; column < 3; ++column) schema += row.Text(column) + "\n";
  });
}

/// Returns the log version with these tables. Returns nothing if no version has them.
std::optional<int> VersionOf(const std::string& schema) {
  for (int version = 0; version <= kLogVersion; ++version) {
    Database empty;
    std::string known;
    // A database in memory fails only if memory is exhausted.
    if (!empty.Execute(Schema(version)) || !ReadSchema(empty, known)) throw std::bad_alloc();
    if (known == schema) return version;
  }
  return std::nullopt;
}

/// Returns the version in a file of a later version of the log. Returns an empty text if there is
/// none.
std::string OtherVersion(Database& database) {
  std::string version;
  Statement get(database, "SELECT value FROM fact WHERE name = 'log_version'");
  const bool good = get.Run([&](Row& row) {
    const std::uint64_t number = row.Whole(0);
    if (row.wrong().empty()) version = std::to_string(number);
  });
  if (!good) database.TakeError();
  return version;
}

/// Checks the structure of the database file.
void CheckStructure(Database& database, std::vector<std::string>& damage) {
  Statement check(database, "PRAGMA integrity_check(20)");
  const bool whole = check.Run([&](Row& row) {
    if (std::string text = row.Text(0); text != "ok") {
      std::replace(text.begin(), text.end(), '\n', ' ');
      damage.push_back("structure: " + text);
    }
  });
  if (!whole) damage.push_back("structure: " + database.TakeError());
}

}  // namespace

bool Accept(const LogContents& contents, const std::string& path, bool skip_damaged,
            Diagnostics& out) {
  if (contents.damage.empty() || skip_damaged) return true;
  for (std::size_t i = 0; i < std::min(contents.damage.size(), kMostComplaints); ++i) {
    out.Error("study.log_damaged", {path}, contents.damage[i]);
  }
  out.Error("study.log_damaged", {path},
            "the log is damaged; " + std::to_string(contents.evaluations.size()) +
                " evaluations are intact",
            "use these with `--skip_damaged`; a search repeats the others");
  return false;
}

std::unique_ptr<Log> Log::Open(const std::string& path, Diagnostics& out) {
  std::unique_ptr<Log> log(new Log(path, Database::Open::kOrMake));
  if (log->database_.good()) return log;
  out.Error("study.log_not_opened", {path}, "cannot open: " + log->database_.TakeError(), kYours);
  return nullptr;
}

std::unique_ptr<Log> Log::OpenToRead(const std::string& path, Diagnostics& out) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    out.Error("study.log_missing", {path}, "the file does not exist",
              "give the folder that `taut learn STUDY` wrote");
    return nullptr;
  }
  std::unique_ptr<Log> log(new Log(path, Database::Open::kThatIsThere));
  if (log->database_.good()) return log;
  out.Error("study.log_not_opened", {path}, "cannot open: " + log->database_.TakeError(), kYours);
  return nullptr;
}

bool Log::Unwritten(const std::string& why, Diagnostics& out) {
  out.Error("study.log_not_written", {path_}, "cannot write: " + why,
            "the logged evaluations are safe; free disk space and run the same command again");
  return false;
}

std::optional<LogContents> Log::Read(Diagnostics& out) {
  const auto refuse = [&](MessageId id, const std::string& what, const std::string& hint = {}) {
    out.Error(id, {path_}, what, hint);
    return std::nullopt;
  };
  std::string schema;
  // Read in a transaction, since another process may be writing to the file.
  const bool readable = database_.Execute("BEGIN") && ReadSchema(database_, schema);
  if (!readable)
    return refuse("study.not_a_log",
                  "the file is not the log of a study, or damaged: " + database_.TakeError());
  const std::optional<int> version = VersionOf(schema);
  if (!version) {
    const std::string other = OtherVersion(database_);
    const bool newer = !other.empty() && other != "1" && other != std::to_string(kLogVersion);
    if (newer) {
      return refuse("study.newer_log", "the log has version " + other +
                                           "; this taut reads versions 1 to " +
                                           std::to_string(kLogVersion));
    }
    return refuse("study.not_a_log",
                  "the file is not the log of a study: it contains other tables");
  }
  std::error_code ignored;
  if (*version == 0 && fs::file_size(path_, ignored) > kEmptyBytes) {
    return refuse("study.not_a_log", "the file is not the log of a study: it contains no tables");
  }
  std::vector<std::string> damage;
  CheckStructure(database_, damage);
  std::string error;
  LogContents contents;
  if (*version > 0) contents = ReadRows(database_, *version, error);
  database_.Execute("COMMIT");
  database_.TakeError();  // ignore errors: the file is open for reading only
  if (!error.empty()) {
    return refuse("study.log_damaged", "the log is damaged: " + error,
                  "its evaluations are unusable; choose another folder with `--out`");
  }
  contents.damage.insert(contents.damage.begin(), damage.begin(), damage.end());
  return contents;
}

bool Log::Begin(const LogContents& contents, Diagnostics& out) {
  count_ = contents.evaluations.size();
  for (const Evaluation& evaluation : contents.evaluations) sum_ += Checksum(evaluation);
  if (!contents.damage.empty()) {
    database_.Execute("PRAGMA wal_checkpoint(TRUNCATE)");
    database_.TakeError();  // ignore errors: this is a best effort
    const std::string kept = path_ + ".damaged";
    std::error_code error;
    fs::remove(kept, error);
    if (!error) fs::copy_file(path_, kept, error);
    if (error) {
      out.Error("file.not_writable", {kept}, "cannot write: " + error.message(), kYours);
      return false;
    }
  }
  const bool good = database_.Execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;");
  if (!good) return Unwritten(database_.TakeError(), out);
  if (contents.version == kLogVersion && contents.damage.empty()) return true;
  Database fresh;
  if (Insert(fresh, contents) && fresh.CopyTo(database_)) return true;
  return Unwritten(fresh.TakeError() + database_.TakeError(), out);
}

bool Log::Add(const Evaluation& evaluation, Diagnostics& out) {
  const std::uint64_t sum = sum_ + Checksum(evaluation);
  if (!database_.Execute("BEGIN IMMEDIATE") ||
      !Insert(database_, evaluation, Tally(count_ + 1, sum)) || !database_.Execute("COMMIT")) {
    Unwritten(database_.TakeError(), out);
    database_.Execute("ROLLBACK");
    return false;
  }
  ++count_;
  sum_ = sum;
  return IsThere(out);
}

bool Log::IsThere(Diagnostics& out) {
  if (!database_.IsGone()) return true;
  out.Error("study.log_deleted", {path_},
            "the log or its folder was deleted or moved during the search",
            "if it was moved, resume with `--out` and its new path");
  return false;
}

}  // namespace taut::learn
