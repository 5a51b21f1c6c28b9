#include "learn/sqlite.h"

#include <sqlite3.h>

#include <charconv>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <utility>

namespace taut::learn {

Database::Database(const std::string& path, Open how) {
  const int make = how == Open::kOrMake ? SQLITE_OPEN_CREATE : 0;
  if (!Check(sqlite3_open_v2(path.c_str(), &db_, SQLITE_OPEN_READWRITE | make, nullptr))) return;
  Protect();
  if (how == Open::kThatIsThere) OpenWithoutFolder(path);
}

void Database::Protect() {
  sqlite3_busy_timeout(db_, 10'000);
  // Settings for untrusted files (https://sqlite.org/security.html): they may contain SQL code.
  sqlite3_db_config(db_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(db_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  Execute("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0;");
  TakeError();  // if the file is unreadable, the first read reports it
}

void Database::OpenWithoutFolder(const std::string& path) {
  const int result = sqlite3_exec(db_, "SELECT 1 FROM sqlite_schema", nullptr, nullptr, nullptr);
  if ((result & 0xff) != SQLITE_CANTOPEN && (result & 0xff) != SQLITE_READONLY) return;
  namespace fs = std::filesystem;
  const std::string log = path + "-wal";
  std::error_code ignored;
  if (fs::exists(log, ignored) && fs::file_size(log, ignored) > 0) {
    error_ = "some rows are in " + log + ", and the folder cannot be written; read a copy of both";
    return;
  }
  std::string uri = "file:";
  for (const char c : path) {
    uri += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  }
  sqlite3_close(std::exchange(db_, nullptr));
  constexpr int kFlags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI;
  // Immutable mode needs no locks and no WAL files.
  if (Check(sqlite3_open_v2((uri + "?immutable=1").c_str(), &db_, kFlags, nullptr))) Protect();
}

Database::~Database() { sqlite3_close(db_); }

bool Database::Check(int result) {
  if (result == SQLITE_OK || result == SQLITE_ROW || result == SQLITE_DONE) return true;
  if (!error_.empty()) return false;
  error_ = db_ == nullptr ? sqlite3_errstr(result) : sqlite3_errmsg(db_);
  const int primary = result & 0xff, number = db_ == nullptr ? 0 : sqlite3_system_errno(db_);
  if (number != 0 && (primary == SQLITE_IOERR || primary == SQLITE_CANTOPEN)) {
    error_ += std::string(": ") + std::strerror(number);
  }
  return false;
}

std::string Database::TakeError() { return std::exchange(error_, {}); }

bool Database::Execute(const std::string& sql) {
  return Check(sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr));
}

bool Database::CopyTo(Database& to) {
  sqlite3_backup* const backup = sqlite3_backup_init(to.db_, "main", db_, "main");
  if (backup == nullptr) return to.Check(sqlite3_errcode(to.db_));
  sqlite3_backup_step(backup, -1);
  return to.Check(sqlite3_backup_finish(backup));  // includes the errors of the backup step
}

bool Database::IsGone() {
  int moved = 0;
  return !Check(sqlite3_file_control(db_, "main", SQLITE_FCNTL_HAS_MOVED, &moved)) || moved != 0;
}

Statement::Statement(Database& database, const std::string& sql) : database_(database) {
  good_ = database_.Check(sqlite3_prepare_v2(database_.db_, sql.c_str(), -1, &statement_, nullptr));
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::Bind(std::int64_t x) {
  good_ = good_ && database_.Check(sqlite3_bind_int64(statement_, ++bound_, x));
  return *this;
}

Statement& Statement::Bind(double x) {
  good_ = good_ && database_.Check(sqlite3_bind_double(statement_, ++bound_, x));
  return *this;
}

Statement& Statement::Bind(const std::string& x) {
  good_ = good_ && database_.Check(sqlite3_bind_text(statement_, ++bound_, x.data(),
                                                     static_cast<int>(x.size()), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::Run(const std::function<void(Row&)>& use) {
  if (!good_) return false;
  bool good = true;
  for (int result = SQLITE_ROW; result == SQLITE_ROW;) {
    result = sqlite3_step(statement_);
    good = database_.Check(result);
    if (result != SQLITE_ROW || !use) continue;
    Row row(statement_);
    use(row);
  }
  sqlite3_reset(statement_);  // returns the same error as the step
  bound_ = 0;
  return good;
}

bool Row::Is(int column, int type, const char* what) {
  if (sqlite3_column_type(statement_, column) == type) return true;
  Wrong(column, std::string("is not ") + what);
  return false;
}

void Row::Wrong(int column, const std::string& what) {
  if (wrong_.empty()) wrong_ = sqlite3_column_name(statement_, column) + (" " + what);
}

std::int64_t Row::Integer(int column) {
  return Is(column, SQLITE_INTEGER, "a whole number") ? sqlite3_column_int64(statement_, column)
                                                      : 0;
}

double Row::Number(int column) {
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL ||
      !Is(column, SQLITE_FLOAT, "a number")) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return sqlite3_column_double(statement_, column);
}

std::string Row::Text(int column) {
  if (!Is(column, SQLITE_TEXT, "text")) return {};
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
  if (text == nullptr) throw std::bad_alloc();  // SQLite's only reason for null
  return std::string(text, size);
}

std::uint64_t Row::Whole(int column) {
  const std::string text = Text(column);
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) Wrong(column, "is not a whole number");
  return number;
}

}  // namespace taut::learn
