/// The little of SQLite's interface that a study's log needs. Every result of the library is looked
/// at in `Database::Check` and nowhere else, so that an error is never taken for the end of the
/// rows.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace taut::learn {

/// A connection. It keeps the first error until `TakeError`.
class Database {
 public:
  enum class Open { kThatIsThere, kOrMake };
  /// What the file holds is not looked at yet. Nothing in it is trusted to be code. A file that is
  /// there opens where its folder cannot be written (a read-only medium, another user's), if no
  /// rows of it are left in its write-ahead log.
  Database(const std::string& path, Open how);
  /// In memory.
  Database() : Database(":memory:", Open::kOrMake) {}
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Statements whose rows nobody needs.
  bool Execute(const std::string& sql);
  /// All of it becomes what `to` holds, whatever that was: at once or not at all.
  bool CopyTo(Database& to);
  /// Whether the file is no longer where it was opened: deleted, moved, or its folder was.
  bool IsGone();

  /// Whether nothing has gone wrong since the last `TakeError`.
  bool good() const { return error_.empty(); }
  /// What went wrong first: "database or disk is full".
  std::string TakeError();

 private:
  friend class Statement;
  /// Whether a call went well.
  bool Check(int result);
  /// Opens the connection anew for a file in WAL mode in a folder that cannot be written, where
  /// SQLite could not make the files beside it that it needs.
  void OpenWithoutFolder(const std::string& path);
  void Protect();

  sqlite3* db_ = nullptr;
  std::string error_;
};

/// One row of an answer. The first value that is not of the type asked for is named in `wrong`.
class Row {
 public:
  explicit Row(sqlite3_stmt* statement) : statement_(statement) {}

  std::int64_t Integer(int column);
  double Number(int column);  ///< NULL: NaN.
  std::string Text(int column);
  /// A whole number as text, which may need all 64 bits.
  std::uint64_t Whole(int column);

  void Wrong(int column, const std::string& what);
  /// "score is not a number"; empty if all is well.
  const std::string& wrong() const { return wrong_; }

 private:
  bool Is(int column, int type, const char* what);

  sqlite3_stmt* statement_;
  std::string wrong_;
};

/// A prepared statement with its values. Not to outlive its database.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// The next value.
  Statement& Bind(std::int64_t x);
  Statement& Bind(double x);  ///< NaN becomes NULL.
  Statement& Bind(const std::string& x);

  /// Runs it; `use` sees each row. False if anything went wrong, also after some rows. It may be
  /// bound and run again.
  [[nodiscard]] bool Run(const std::function<void(Row&)>& use = {});

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
  bool good_;
};

}  // namespace taut::learn
