/// Logs of studies for tests: complete logs of this version and of the previous one, as bytes of a
/// file
#pragma once

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "learn/log_rows.h"
#include "learn/study_log.h"

namespace taut::test {

inline constexpr std::int64_t kLogged = 60;

/// Returns an evaluation with difficult numbers: every tenth failed, zeros with a sign.
inline Evaluation LoggedEvaluation(std::int64_t id) {
  Evaluation e;
  const auto x = static_cast<double>(id);
  e.id = id;
  e.search = static_cast<int>(id / 40);
  e.values = {1.0 / (x + 1), -0.0};
  e.score = std::sin(x);
  e.elapsed_s = 0.1 * x;
  for (int w = 0; w < 2; ++w) {
    RolloutResult r;
    r.done = true;
    r.score = e.score + w;
    r.distance_m = x / 3;
    r.along_m = -0.0;
    r.energy_j = 1e-300 * x;
    if (id % 3 == 0) r.fell_s = x / 7;
    r.state_hash = std::numeric_limits<std::uint64_t>::max() - static_cast<std::uint64_t>(id);
    e.worlds.push_back(r);
    e.seeds.push_back(static_cast<std::uint64_t>(id) << 40);
  }
  if (id % 10 == 9) {
    e.failed = "world 1: it blew up";
    e.score = std::numeric_limits<double>::quiet_NaN();
    e.worlds[1].failed = "it blew up";
    e.worlds[1].score = e.score;
  }
  return e;
}

inline learn::LogContents NewLog() {
  learn::LogContents log;
  log.facts = {{"name", "small"},
               {"study", "a study\nin two lines"},
               {"experiment", std::string(300, 'x')},
               {"taut_version", "1"}};
  log.parameters = {{"a", "N", {"hold.a"}, 0, 1, false},
                    {"b", "1", {"hold.b", "hold.c"}, -1, 1, false}};
  return log;
}

/// Writes a log as a search does, one evaluation after the other. Returns the errors.
inline std::string WriteLog(const std::string& path) {
  Diagnostics out;
  const auto log = learn::Log::Open(path, out);
  bool good = log && log->Read(out) && log->Begin(NewLog(), out);
  for (std::int64_t id = 0; good && id < kLogged; ++id) good = log->Add(LoggedEvaluation(id), out);
  return out.Format();
}

/// Writes the same log in the format of version 1.
inline std::string WriteOldLog(const std::string& path) {
  const std::string now = path + ".now";
  if (std::string wrong = WriteLog(now); !wrong.empty()) return wrong;
  learn::Database old(path, learn::Database::Open::kOrMake);
  old.Execute(learn::Schema(1) + "ATTACH '" + now + "' AS now;" + R"(
INSERT INTO fact SELECT * FROM now.fact WHERE name NOT IN ('checksum', 'evaluations');
UPDATE fact SET value = '1' WHERE name = 'log_version';
INSERT INTO fact VALUES ('complete', '1');
INSERT INTO parameter SELECT * FROM now.parameter;
INSERT INTO evaluation SELECT id, search, score, failed, parameter_values, elapsed_s
  FROM now.evaluation;
INSERT INTO world SELECT * FROM now.world;)");
  return old.TakeError();
}

inline std::string FileBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Reads a log's file from its bytes. Returns nothing if it is rejected.
inline std::optional<learn::LogContents> ReadLog(const std::string& path, const std::string& bytes,
                                                 Diagnostics& out) {
  for (const char* beside : {"-wal", "-shm", "-journal"}) {
    std::remove((path + beside).c_str());
  }
  std::ofstream(path, std::ios::binary) << bytes;
  const auto log = learn::Log::OpenToRead(path, out);
  return log ? log->Read(out) : std::nullopt;
}

/// Returns whether the contents are correct: each evaluation equals a written one, and if no damage
/// is reported, all of them are present.
inline bool IsTrue(const learn::LogContents& read) {
  if (read.damage.empty() && read.evaluations.size() != kLogged) return false;
  const learn::LogContents written = NewLog();
  if (learn::Checksum(read) != learn::Checksum(written)) return false;
  for (const Evaluation& e : read.evaluations) {
    if (learn::Checksum(e) != learn::Checksum(LoggedEvaluation(e.id))) return false;
  }
  return true;
}

}  // namespace taut::test
