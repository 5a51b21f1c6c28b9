/// Wrapper of SQLite for a study's log. Only `Database::Check` examines result codes, so that an
/// error is never mistaken for the end of the rows.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace taut::learn {

/// Database connection. Keeps the first error until `TakeError` is called.
class Database {
 public:
  enum class Open { kThatIsThere, kOrMake };
  /// Opens the file without reading its contents. Does not execute code stored in the file. An
  /// existing file can also be opened in a folder without write permission, if its write-ahead log
  /// contains no rows.
  Database(const std::string& path, Open how);
  /// Opens a database in memory.
  Database() : Database(":memory:", Open::kOrMake) {}
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Executes SQL statements and ignores their rows.
  bool Execute(const std::string& sql);
  /// Copies this database to `to` in one transaction, which replaces its contents.
  bool CopyTo(Database& to);
  /// Returns whether the file or its folder was deleted or moved after it was opened.
  bool IsGone();

  /// Returns whether no error occurred since the last `TakeError`.
  bool good() const { return error_.empty(); }
  /// Returns and clears the first error, such as "database or disk is full".
  std::string TakeError();

 private:
  friend class Statement;
  /// Checks a result code. Returns false and stores the message of an error.
  bool Check(int result);
  /// Reopens a file in WAL mode if its folder is not writable, because SQLite cannot create the WAL
  /// files there.
  void OpenWithoutFolder(const std::string& path);
  void Protect();

  sqlite3* db_ = nullptr;
  std::string error_;
};

/// Row of a result. `wrong` describes the first value with an unexpected type.
class Row {
 public:
  explicit Row(sqlite3_stmt* statement) : statement_(statement) {}

  std::int64_t Integer(int column);
  double Number(int column);  ///< Returns a number; NaN for NULL.
  std::string Text(int column);
  /// Returns a 64-bit unsigned integer, which is stored as text.
  std::uint64_t Whole(int column);

  void Wrong(int column, const std::string& what);
  /// Returns a description such as "score is not a number". Returns an empty text if all values are
  /// valid.
  const std::string& wrong() const { return wrong_; }

 private:
  bool Is(int column, int type, const char* what);

  sqlite3_stmt* statement_;
  std::string wrong_;
};

/// Prepared statement with bound values. The database must outlive the statement.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Binds the next value.
  Statement& Bind(std::int64_t x);
  Statement& Bind(double x);  ///< Binds a number; NaN as NULL.
  Statement& Bind(const std::string& x);

  /// Executes the statement and passes each row to `use`. Returns false after an error, also if it
  /// occurs after some rows. The statement may then be bound and executed again.
  [[nodiscard]] bool Run(const std::function<void(Row&)>& use = {});

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
  bool good_;
};

}  // namespace taut::learn
