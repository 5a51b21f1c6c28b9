#include "learn/log.h"

#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

namespace taut::learn {
namespace {

using nlohmann::json;

constexpr const char* kSchema = R"(
CREATE TABLE IF NOT EXISTS fact (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS parameter (
  position INTEGER PRIMARY KEY, name TEXT NOT NULL, unit TEXT NOT NULL,
  low REAL NOT NULL, high REAL NOT NULL, log INTEGER NOT NULL, targets TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS evaluation (
  id INTEGER PRIMARY KEY, search INTEGER NOT NULL, score REAL, failed TEXT NOT NULL,
  parameter_values TEXT NOT NULL, elapsed_s REAL NOT NULL);
CREATE TABLE IF NOT EXISTS world (
  evaluation INTEGER NOT NULL, world INTEGER NOT NULL, seed TEXT NOT NULL, score REAL,
  failed TEXT NOT NULL, distance_m REAL, along_m REAL, energy_j REAL, max_tension_n REAL,
  tracking_n REAL, fell_s REAL, state_hash TEXT NOT NULL,
  PRIMARY KEY (evaluation, world)) WITHOUT ROWID;
)";

/// A prepared statement with its values.
class Statement {
 public:
  Statement(sqlite3* db, const char* sql) {
    good_ = sqlite3_prepare_v2(db, sql, -1, &statement_, nullptr) == SQLITE_OK;
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& Bind(std::int64_t x) {
    good_ = good_ && sqlite3_bind_int64(statement_, ++bound_, x) == SQLITE_OK;
    return *this;
  }
  /// SQLite keeps a NaN as NULL.
  Statement& Bind(double x) {
    good_ = good_ && sqlite3_bind_double(statement_, ++bound_, x) == SQLITE_OK;
    return *this;
  }
  Statement& Bind(const std::string& x) {
    good_ = good_ && sqlite3_bind_text(statement_, ++bound_, x.data(), static_cast<int>(x.size()),
                                       SQLITE_TRANSIENT) == SQLITE_OK;
    return *this;
  }
  /// Of a change.
  bool Do() { return good_ && sqlite3_step(statement_) == SQLITE_DONE; }
  /// Of a question: whether there is a row more.
  bool Next() { return good_ && sqlite3_step(statement_) == SQLITE_ROW; }

  std::int64_t Integer(int column) { return sqlite3_column_int64(statement_, column); }
  double Number(int column) {
    if (sqlite3_column_type(statement_, column) == SQLITE_NULL) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return sqlite3_column_double(statement_, column);
  }
  std::string Text(int column) {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return text == nullptr ? std::string() : std::string(text, size);
  }

 private:
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
  bool good_ = false;
};

/// Numbers in JSON read back to the same bits.
std::vector<double> Numbers(const std::string& text) {
  std::vector<double> out;
  const json list = json::parse(text, nullptr, false);
  if (!list.is_array()) return out;
  for (const json& x : list) out.push_back(x.is_number() ? x.get<double>() : 0.0);
  return out;
}

std::uint64_t Whole(const std::string& text) {
  return text.empty() ? 0 : std::strtoull(text.c_str(), nullptr, 10);
}

sqlite3* OpenFile(const std::string& path, int flags, Diagnostics& out) {
  sqlite3* db = nullptr;
  if (sqlite3_open_v2(path.c_str(), &db, flags, nullptr) == SQLITE_OK) {
    sqlite3_busy_timeout(db, 10'000);
    return db;
  }
  out.Error({path}, std::string("cannot be opened: ") +
                        (db == nullptr ? "not enough memory" : sqlite3_errmsg(db)));
  sqlite3_close(db);
  return nullptr;
}

}  // namespace

Log::~Log() { sqlite3_close(db_); }

std::unique_ptr<Log> Log::Open(const std::string& path, Diagnostics& out) {
  sqlite3* const db = OpenFile(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, out);
  if (db == nullptr) return nullptr;
  std::unique_ptr<Log> log(new Log(db, path));
  if (!log->Execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;") ||
      !log->Execute(kSchema)) {
    out.Error({path}, "cannot be used: " + log->error(),
              "a study's folder holds its own study.sqlite and nothing else of that name");
    return nullptr;
  }
  const auto version = log->Fact("log_version");
  if (version && *version != std::to_string(kLogVersion)) {
    out.Error({path}, "has version " + *version + "; this taut reads version " +
                          std::to_string(kLogVersion));
    return nullptr;
  }
  if (!version && !log->SetFact("log_version", std::to_string(kLogVersion))) {
    out.Error({path}, "cannot be written: " + log->error());
    return nullptr;
  }
  return log;
}

std::unique_ptr<Log> Log::OpenToRead(const std::string& path, Diagnostics& out) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    out.Error({path}, "there is no such file", "give the folder that `taut learn STUDY` wrote");
    return nullptr;
  }
  sqlite3* const db = OpenFile(path, SQLITE_OPEN_READWRITE, out);
  if (db == nullptr) return nullptr;
  std::unique_ptr<Log> log(new Log(db, path));
  const auto version = log->Fact("log_version");
  if (version == std::to_string(kLogVersion)) return log;
  out.Error({path}, version ? "has version " + *version + "; this taut reads version " +
                                  std::to_string(kLogVersion)
                            : "is not the log of a study");
  return nullptr;
}

bool Log::Execute(const char* sql) {
  return sqlite3_exec(db_, sql, nullptr, nullptr, nullptr) == SQLITE_OK;
}

std::string Log::error() const { return sqlite3_errmsg(db_); }

std::optional<std::string> Log::Fact(const std::string& name) {
  Statement get(db_, "SELECT value FROM fact WHERE name = ?");
  if (!get.Bind(name).Next()) return std::nullopt;
  return get.Text(0);
}

bool Log::SetFact(const std::string& name, const std::string& value) {
  return Statement(db_, "INSERT OR REPLACE INTO fact VALUES (?, ?)").Bind(name).Bind(value).Do();
}

bool Log::SetParameters(const std::vector<StudyParameter>& parameters) {
  bool good = Execute("BEGIN IMMEDIATE") && Execute("DELETE FROM parameter");
  std::int64_t position = 0;
  for (const StudyParameter& p : parameters) {
    Statement add(db_, "INSERT INTO parameter VALUES (?, ?, ?, ?, ?, ?, ?)");
    add.Bind(position++).Bind(p.name).Bind(p.unit).Bind(p.low).Bind(p.high);
    good = good && add.Bind(std::int64_t{p.log}).Bind(json(p.targets).dump()).Do();
  }
  if (good && Execute("COMMIT")) return true;
  Execute("ROLLBACK");
  return false;
}

std::vector<StudyParameter> Log::Parameters() {
  std::vector<StudyParameter> out;
  Statement get(db_, "SELECT name, unit, low, high, log, targets FROM parameter ORDER BY position");
  while (get.Next()) {
    StudyParameter p;
    p.name = get.Text(0);
    p.unit = get.Text(1);
    p.low = get.Number(2);
    p.high = get.Number(3);
    p.log = get.Integer(4) != 0;
    const json targets = json::parse(get.Text(5), nullptr, false);
    if (targets.is_array()) {
      for (const json& t : targets) p.targets.push_back(t.is_string() ? t.get<std::string>() : "");
    }
    out.push_back(std::move(p));
  }
  return out;
}

bool Log::Add(const Evaluation& e) {
  bool good = Execute("BEGIN IMMEDIATE");
  {
    Statement add(db_, "INSERT INTO evaluation VALUES (?, ?, ?, ?, ?, ?)");
    add.Bind(e.id).Bind(std::int64_t{e.search}).Bind(e.score).Bind(e.failed);
    good = good && add.Bind(json(e.values).dump()).Bind(e.elapsed_s).Do();
  }
  for (std::size_t w = 0; good && w < e.worlds.size(); ++w) {
    const RolloutResult& r = e.worlds[w];
    Statement add(db_, "INSERT INTO world VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    add.Bind(e.id).Bind(static_cast<std::int64_t>(w)).Bind(std::to_string(e.seeds[w]));
    add.Bind(r.score).Bind(r.failed).Bind(r.distance_m).Bind(r.along_m).Bind(r.energy_j);
    add.Bind(r.max_tension_n).Bind(r.tracking_n);
    add.Bind(r.fell_s.value_or(std::numeric_limits<double>::quiet_NaN()));
    good = add.Bind(std::to_string(r.state_hash)).Do();
  }
  if (good && Execute("COMMIT")) return true;
  Execute("ROLLBACK");
  return false;
}

std::vector<Evaluation> Log::Evaluations() {
  std::vector<Evaluation> out;
  Statement get(db_,
                "SELECT id, search, score, failed, parameter_values, elapsed_s FROM evaluation "
                "ORDER BY id");
  while (get.Next()) {
    Evaluation e;
    e.id = get.Integer(0);
    e.search = static_cast<int>(get.Integer(1));
    e.score = get.Number(2);
    e.failed = get.Text(3);
    e.values = Numbers(get.Text(4));
    e.elapsed_s = get.Number(5);
    out.push_back(std::move(e));
  }
  Statement worlds(db_,
                   "SELECT evaluation, seed, score, failed, distance_m, along_m, energy_j, "
                   "max_tension_n, tracking_n, fell_s, state_hash FROM world "
                   "ORDER BY evaluation, world");
  for (std::size_t i = 0; worlds.Next();) {
    const std::int64_t id = worlds.Integer(0);
    while (i < out.size() && out[i].id < id) ++i;
    if (i == out.size() || out[i].id != id) continue;
    RolloutResult r;
    r.done = true;
    r.score = worlds.Number(2);
    r.failed = worlds.Text(3);
    r.distance_m = worlds.Number(4);
    r.along_m = worlds.Number(5);
    r.energy_j = worlds.Number(6);
    r.max_tension_n = worlds.Number(7);
    r.tracking_n = worlds.Number(8);
    if (const double fell = worlds.Number(9); !std::isnan(fell)) r.fell_s = fell;
    r.state_hash = Whole(worlds.Text(10));
    out[i].seeds.push_back(Whole(worlds.Text(1)));
    out[i].worlds.push_back(std::move(r));
  }
  return out;
}

}  // namespace taut::learn
