/// SQLite wrapper for a study's log. Every result code is checked in `Database::Check` only, so
/// that an error is never mistaken for the end of the rows.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace taut::learn {

/// Connection. It keeps the first error until `TakeError`.
class Database {
 public:
  enum class Open { kThatIsThere, kOrMake };
  /// Opens the file without reading its contents. Nothing in it is trusted as code. An existing
  /// file also opens in a folder without write permission (a read-only medium, another user's
  /// folder), if its write-ahead log contains no rows.
  Database(const std::string& path, Open how);
  /// In memory.
  Database() : Database(":memory:", Open::kOrMake) {}
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Executes statements and discards their rows.
  bool Execute(const std::string& sql);
  /// Replaces the contents of `to` by this database, in one transaction.
  bool CopyTo(Database& to);
  /// Returns whether the file, or its folder, was deleted or moved since it was opened.
  bool IsGone();

  /// Returns whether there was no error since the last `TakeError`.
  bool good() const { return error_.empty(); }
  /// Returns and clears the first error, such as "database or disk is full".
  std::string TakeError();

 private:
  friend class Statement;
  /// Returns whether a call succeeded.
  bool Check(int result);
  /// Reopens a file in WAL mode whose folder cannot be written, where SQLite cannot create the
  /// accompanying files that it needs.
  void OpenWithoutFolder(const std::string& path);
  void Protect();

  sqlite3* db_ = nullptr;
  std::string error_;
};

/// Row of a result. `wrong` describes the first value of an unexpected type.
class Row {
 public:
  explicit Row(sqlite3_stmt* statement) : statement_(statement) {}

  std::int64_t Integer(int column);
  double Number(int column);  ///< NULL: NaN.
  std::string Text(int column);
  /// Returns a 64-bit unsigned integer stored as text.
  std::uint64_t Whole(int column);

  void Wrong(int column, const std::string& what);
  /// Returns a description such as "score is not a number"; empty if all values are valid.
  const std::string& wrong() const { return wrong_; }

 private:
  bool Is(int column, int type, const char* what);

  sqlite3_stmt* statement_;
  std::string wrong_;
};

/// Prepared statement with its values. Must not outlive its database.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// Binds the next value.
  Statement& Bind(std::int64_t x);
  Statement& Bind(double x);  ///< NaN becomes NULL.
  Statement& Bind(const std::string& x);

  /// Executes the statement; `use` receives each row. Returns false on any error, also after some
  /// rows. The statement may be bound and executed again.
  [[nodiscard]] bool Run(const std::function<void(Row&)>& use = {});

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
  bool good_;
};

}  // namespace taut::learn
