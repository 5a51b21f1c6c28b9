#include "learn/log_rows.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/hash.h"

namespace taut::learn {
namespace {

using nlohmann::json;

/// Parses a JSON list of numbers, bit for bit.
std::vector<double> Numbers(Row& row, int column) {
  std::vector<double> out;
  const json list = json::parse(row.Text(column), nullptr, false);
  bool good = list.is_array();
  for (std::size_t i = 0; good && i < list.size(); ++i) {
    good = list[i].is_number();
    if (good) out.push_back(list[i].get<double>());
  }
  if (!good) row.Wrong(column, "is not a list of numbers");
  return out;
}

std::vector<std::string> Texts(Row& row, int column) {
  std::vector<std::string> out;
  const json list = json::parse(row.Text(column), nullptr, false);
  bool good = list.is_array();
  for (std::size_t i = 0; good && i < list.size(); ++i) {
    good = list[i].is_string();
    if (good) out.push_back(list[i].get<std::string>());
  }
  if (!good || out.empty()) row.Wrong(column, "is not a list of strings");
  return out;
}

/// Returns a description of invalid data in an evaluation; empty if all are valid. Comparisons are
/// written so that NaN is invalid.
std::string WhatIsWrong(const Evaluation& e, const std::vector<StudyParameter>& parameters) {
  if (e.id < 0 || e.search < 0) return "its id or search is negative";
  if (e.values.size() != parameters.size()) {
    return "it has " + std::to_string(e.values.size()) + " values, but the study has " +
           std::to_string(parameters.size()) + " parameters";
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (e.values[i] >= parameters[i].low && e.values[i] <= parameters[i].high) continue;
    return "the value of " + parameters[i].name + " is beyond its bounds";
  }
  if (std::isfinite(e.score) != e.failed.empty()) return "its score and failure are inconsistent";
  if (!(e.elapsed_s >= 0) || !std::isfinite(e.elapsed_s)) return "elapsed_s is not a time";
  if (e.worlds.empty()) return "its worlds are missing";
  for (std::size_t w = 0; w < e.worlds.size(); ++w) {
    const RolloutResult& r = e.worlds[w];
    if (!r.failed.empty()) continue;  // the numbers of a failed world are undefined
    for (const double x : {r.score, r.distance_m, r.along_m, r.energy_j, r.max_tension_n,
                           r.tracking_n, r.fell_s.value_or(0)}) {
      if (!std::isfinite(x)) return "a number of world " + std::to_string(w) + " is not finite";
    }
  }
  return {};
}

/// Reads the worlds of an evaluation. Returns a description of invalid data; empty if all are
/// valid.
std::string ReadWorlds(Database& database, Statement& get, Evaluation& e) {
  std::string wrong;
  const bool good = get.Bind(e.id).Run([&](Row& row) {
    RolloutResult r;
    r.done = true;
    const std::int64_t place = row.Integer(0);
    e.seeds.push_back(row.Whole(1));
    r.score = row.Number(2);
    r.failed = row.Text(3);
    double* const measures[] = {&r.distance_m, &r.along_m, &r.energy_j, &r.max_tension_n,
                                &r.tracking_n};
    for (int i = 0; i < 5; ++i) *measures[i] = row.Number(4 + i);
    if (const double fell = row.Number(9); !std::isnan(fell)) r.fell_s = fell;
    r.state_hash = row.Whole(10);
    if (wrong.empty() && place != static_cast<std::int64_t>(e.worlds.size())) {
      wrong = "world " + std::to_string(e.worlds.size()) + " is missing";
    }
    if (wrong.empty() && !row.wrong().empty()) {
      wrong = "world " + std::to_string(place) + ": " + row.wrong();
    }
    e.worlds.push_back(std::move(r));
  });
  if (!good) wrong = "its worlds cannot be read: " + database.TakeError();
  return wrong;
}

/// Row of the table `evaluation`, and a description of its invalid data.
struct Found {
  Evaluation evaluation;
  std::string checksum, wrong;
};
std::map<std::int64_t, Found> ReadEvaluations(Database& database, int version,
                                              std::vector<std::string>& damage) {
  std::map<std::int64_t, Found> found;
  const std::string select =
      std::string("SELECT id, search, score, failed, parameter_values, elapsed_s") +
      (version > 1 ? ", checksum" : "") + " FROM evaluation ORDER BY id";
  // After an unreadable page, read the rows behind it in descending order.
  for (const char* order : {" ASC", " DESC"}) {
    const bool whole = Statement(database, select + order).Run([&](Row& row) {
      Found f;
      f.evaluation.id = row.Integer(0);
      const std::int64_t search = row.Integer(1);
      if (search > std::numeric_limits<int>::max()) row.Wrong(1, "is too large");
      f.evaluation.search = static_cast<int>(search);
      f.evaluation.score = row.Number(2);
      f.evaluation.failed = row.Text(3);
      f.evaluation.values = Numbers(row, 4);
      f.evaluation.elapsed_s = row.Number(5);
      if (version > 1) f.checksum = row.Text(6);
      f.wrong = row.wrong();
      found[f.evaluation.id] = std::move(f);
    });
    if (whole) break;
    damage.push_back("table evaluation: " + database.TakeError());
  }
  return found;
}

/// Version 1 has no checksums, so only missing worlds can be detected.
void CheckCountsOfWorlds(std::map<std::int64_t, Found>& found) {
  std::size_t most = 0;
  for (const auto& item : found) most = std::max(most, item.second.evaluation.worlds.size());
  for (auto& [id, f] : found) {
    if (f.wrong.empty() && f.evaluation.worlds.size() < most) f.wrong = "worlds are missing";
  }
}

void ReadFacts(Database& database, LogContents& contents, std::string& error) {
  const bool good = Statement(database, "SELECT name, value FROM fact").Run([&](Row& row) {
    contents.facts[row.Text(0)] = row.Text(1);
    if (!row.wrong().empty()) error = "a fact's " + row.wrong();
  });
  if (!good) error = "facts: " + database.TakeError();
}

void ReadParameters(Database& database, LogContents& contents, std::string& error) {
  Statement get(database,
                "SELECT position, name, unit, low, high, log, targets FROM parameter "
                "ORDER BY position");
  const bool good = get.Run([&](Row& row) {
    StudyParameter p;
    const auto expected = static_cast<std::int64_t>(contents.parameters.size());
    if (row.Integer(0) != expected) row.Wrong(0, "has a gap");
    p.name = row.Text(1);
    p.unit = row.Text(2);
    p.low = row.Number(3);
    p.high = row.Number(4);
    p.log = row.Integer(5) != 0;
    p.targets = Texts(row, 6);
    if (!std::isfinite(p.low) || !std::isfinite(p.high) || !(p.low <= p.high)) {
      row.Wrong(3, "and high are not valid bounds");
    }
    if (!row.wrong().empty()) error = "parameter " + std::to_string(expected) + ": " + row.wrong();
    contents.parameters.push_back(std::move(p));
  });
  if (!good) error = "parameters: " + database.TakeError();
}

/// Removes a fact from the map and returns it. Returns an empty text if it is missing.
std::string Take(std::map<std::string, std::string>& facts, const char* name) {
  const auto node = facts.extract(name);
  return node.empty() ? std::string() : node.mapped();
}

}  // namespace

std::string Schema(int version) {
  if (version == 0) return {};
  return R"(
CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE parameter (
  position INTEGER PRIMARY KEY, name TEXT NOT NULL, unit TEXT NOT NULL,
  low REAL NOT NULL, high REAL NOT NULL, log INTEGER NOT NULL, targets TEXT NOT NULL);
CREATE TABLE evaluation (
  id INTEGER PRIMARY KEY, search INTEGER NOT NULL, score REAL, failed TEXT NOT NULL,
  parameter_values TEXT NOT NULL, elapsed_s REAL NOT NULL)" +
         std::string(version > 1 ? ", checksum TEXT NOT NULL" : "") + R"();
CREATE TABLE world (
  evaluation INTEGER NOT NULL, world INTEGER NOT NULL, seed TEXT NOT NULL, score REAL,
  failed TEXT NOT NULL, distance_m REAL, along_m REAL, energy_j REAL, max_tension_n REAL,
  tracking_n REAL, fell_s REAL, state_hash TEXT NOT NULL,
  PRIMARY KEY (evaluation, world)) WITHOUT ROWID;
)";
}

std::uint64_t Checksum(const Evaluation& e) {
  base::Fnv1a hash;
  const auto whole = [&](auto x) { hash.AddText(std::to_string(x)); };
  whole(e.id);
  whole(e.search);
  whole(e.values.size());
  for (const double x : e.values) hash.AddNumber(x);
  hash.AddNumber(e.score);
  hash.AddText(e.failed);
  hash.AddNumber(e.elapsed_s);
  whole(e.worlds.size());
  for (std::size_t w = 0; w < e.worlds.size(); ++w) {
    const RolloutResult& r = e.worlds[w];
    whole(e.seeds[w]);
    hash.AddNumber(r.score);
    hash.AddText(r.failed);
    for (const double x : {r.distance_m, r.along_m, r.energy_j, r.max_tension_n, r.tracking_n,
                           r.fell_s.value_or(std::numeric_limits<double>::quiet_NaN())}) {
      hash.AddNumber(x);
    }
    whole(r.state_hash);
  }
  return hash.value();
}

std::uint64_t Checksum(const LogContents& contents) {
  base::Fnv1a hash;
  for (const auto& [name, value] : contents.facts) {
    hash.AddText(name);
    hash.AddText(value);
  }
  for (const StudyParameter& p : contents.parameters) {
    hash.AddText(p.name);
    hash.AddText(p.unit);
    hash.AddNumber(p.low);
    hash.AddNumber(p.high);
    hash.AddText(p.log ? "log" : "linear");
    hash.AddText(json(p.targets).dump());
  }
  return hash.value();
}

std::string Tally(std::uint64_t count, std::uint64_t sum) {
  return std::to_string(count) + " " + base::HashText(sum);
}

bool Insert(Database& database, const LogContents& contents) {
  std::map<std::string, std::string> facts = contents.facts;
  facts["log_version"] = std::to_string(kLogVersion);
  facts["checksum"] = base::HashText(Checksum(contents));
  facts["evaluations"] = Tally(0, 0);
  bool good = database.Execute("PRAGMA application_id = " + std::to_string(kApplicationId)) &&
              database.Execute(Schema(kLogVersion)) && database.Execute("BEGIN");
  for (const auto& [name, value] : facts) {
    Statement add(database, "INSERT INTO fact VALUES (?, ?)");
    good = good && add.Bind(name).Bind(value).Run();
  }
  std::int64_t position = 0;
  for (const StudyParameter& p : contents.parameters) {
    Statement add(database, "INSERT INTO parameter VALUES (?, ?, ?, ?, ?, ?, ?)");
    add.Bind(position++).Bind(p.name).Bind(p.unit).Bind(p.low).Bind(p.high);
    good = good && add.Bind(std::int64_t{p.log}).Bind(json(p.targets).dump()).Run();
  }
  std::uint64_t count = 0, sum = 0;
  for (const Evaluation& evaluation : contents.evaluations) {
    sum += Checksum(evaluation);
    good = good && Insert(database, evaluation, Tally(++count, sum));
  }
  return good && database.Execute("COMMIT");
}

bool Insert(Database& database, const Evaluation& e, const std::string& tally) {
  Statement add(database, "INSERT INTO evaluation VALUES (?, ?, ?, ?, ?, ?, ?)");
  add.Bind(e.id).Bind(std::int64_t{e.search}).Bind(e.score).Bind(e.failed);
  add.Bind(json(e.values).dump()).Bind(e.elapsed_s).Bind(base::HashText(Checksum(e)));
  bool good = add.Run();
  Statement add_world(database, "INSERT INTO world VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t w = 0; w < e.worlds.size(); ++w) {
    const RolloutResult& r = e.worlds[w];
    add_world.Bind(e.id).Bind(static_cast<std::int64_t>(w)).Bind(std::to_string(e.seeds[w]));
    add_world.Bind(r.score).Bind(r.failed).Bind(r.distance_m).Bind(r.along_m).Bind(r.energy_j);
    add_world.Bind(r.max_tension_n).Bind(r.tracking_n);
    add_world.Bind(r.fell_s.value_or(std::numeric_limits<double>::quiet_NaN()));
    good = good && add_world.Bind(std::to_string(r.state_hash)).Run();
  }
  Statement count(database, "UPDATE fact SET value = ? WHERE name = 'evaluations'");
  return good && count.Bind(tally).Run();
}

LogContents ReadRows(Database& database, int version, std::string& error) {
  LogContents contents;
  contents.version = version;
  std::int64_t application = 0;
  if (!Statement(database, "PRAGMA application_id").Run([&](Row& row) {
        application = row.Integer(0);
      })) {
    error = database.TakeError();
  }
  ReadFacts(database, contents, error);
  ReadParameters(database, contents, error);
  if (!error.empty()) return contents;
  const std::string own_version = Take(contents.facts, "log_version");
  const std::string checksum = Take(contents.facts, "checksum");
  const std::string tally = Take(contents.facts, "evaluations");
  Take(contents.facts, "complete");  // fact of version 1, which wrote facts one by one
  if (own_version != std::to_string(version) ||
      (version > 1 &&
       (application != kApplicationId || checksum != base::HashText(Checksum(contents))))) {
    error = "its metadata or parameters were changed";
    return contents;
  }

  auto found = ReadEvaluations(database, version, contents.damage);
  Statement worlds(database,
                   "SELECT world, seed, score, failed, distance_m, along_m, energy_j, "
                   "max_tension_n, tracking_n, fell_s, state_hash FROM world "
                   "WHERE evaluation = ? ORDER BY world");
  for (auto& [id, f] : found) {
    const std::string wrong = ReadWorlds(database, worlds, f.evaluation);
    if (f.wrong.empty()) f.wrong = wrong;
    if (f.wrong.empty()) f.wrong = WhatIsWrong(f.evaluation, contents.parameters);
    if (f.wrong.empty() && version > 1 && f.checksum != base::HashText(Checksum(f.evaluation))) {
      f.wrong = "its checksum does not match its content";
    }
  }
  if (version == 1) CheckCountsOfWorlds(found);
  std::uint64_t sum = 0;
  for (auto& [id, f] : found) {
    if (f.wrong.empty()) {
      sum += Checksum(f.evaluation);
      contents.evaluations.push_back(std::move(f.evaluation));
    } else {
      contents.damage.push_back("evaluation " + std::to_string(id) + ": " + f.wrong);
    }
  }
  if (version > 1 && tally != Tally(contents.evaluations.size(), sum)) {
    std::uint64_t written = 0;
    std::from_chars(tally.data(), tally.data() + tally.size(), written);
    contents.damage.push_back(std::to_string(written) + " evaluations were written, " +
                              std::to_string(contents.evaluations.size()) + " of them are intact");
  }
  return contents;
}

}  // namespace taut::learn
