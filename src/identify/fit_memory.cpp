#include "identify/fit_memory.h"

#include <bit>
#include <charconv>
#include <set>

#include "base/hash.h"

namespace taut::identify {
namespace {

using learn::Statement;

constexpr std::size_t kDigits = 16;

std::string Bits(const std::vector<double>& numbers) {
  std::string out;
  for (const double x : numbers) out += base::HashText(std::bit_cast<std::uint64_t>(x));
  return out;
}

bool NumbersOf(const std::string& bits, std::vector<double>& out) {
  if (bits.size() % kDigits != 0) return false;
  for (std::size_t i = 0; i < bits.size(); i += kDigits) {
    std::uint64_t x = 0;
    const char* const end = bits.data() + i + kDigits;
    const auto read = std::from_chars(bits.data() + i, end, x, 16);
    if (read.ec != std::errc() || read.ptr != end) return false;
    out.push_back(std::bit_cast<double>(x));
  }
  return true;
}

std::string SumOf(const std::string& facts, const std::string& key, const std::string& failed,
                  const std::string& bits) {
  base::Fnv1a sum;
  sum.AddText(facts), sum.AddText(key), sum.AddText(failed), sum.AddText(bits);
  return base::HashText(sum.value());
}

}  // namespace

std::string PointMemory::Key(const std::string& problem, const std::vector<double>& values) {
  return problem + ":" + Bits(values);
}

std::unique_ptr<PointMemory> PointMemory::Open(const std::string& path,
                                               const std::map<std::string, std::string>& facts,
                                               Diagnostics& out) {
  auto memory = std::make_unique<PointMemory>();
  memory->database_ = std::make_unique<learn::Database>(path, learn::Database::Open::kOrMake);
  if (!memory->Begin(path, facts, out)) return nullptr;
  return memory;
}

bool PointMemory::Begin(const std::string& path, const std::map<std::string, std::string>& facts,
                        Diagnostics& out) {
  const bool made =
      database_->good() &&
      database_->Execute(
          "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;"
          "CREATE TABLE IF NOT EXISTS fact (name TEXT PRIMARY KEY, value TEXT NOT NULL);"
          "CREATE TABLE IF NOT EXISTS point (key TEXT PRIMARY KEY, failed TEXT NOT NULL, "
          "value TEXT NOT NULL, sum TEXT NOT NULL);");
  std::map<std::string, std::string> known;
  const bool read =
      made && Statement(*database_, "SELECT name, value FROM fact").Run([&](learn::Row& r) {
        const std::string name = r.Text(0);
        known[name] = r.Text(1);
      });
  if (!read) {
    out.Error("fit.not_a_memory", {path},
              "the file does not contain the points of a fit, or cannot be written: " +
                  database_->TakeError(),
              "choose another folder with --out");
    return false;
  }
  base::Fnv1a sum;
  for (const auto& [name, value] : facts) sum.AddText(name), sum.AddText(value);
  facts_sum_ = base::HashText(sum.value());
  if (!known.empty() && known != facts) {
    std::set<std::string> names;
    for (const auto& all : {facts, known}) {
      for (const auto& [name, value] : all) names.insert(name);
    }
    std::string which;
    for (const std::string& name : names) {
      const auto here = facts.find(name);
      const auto there = known.find(name);
      const bool both = here != facts.end() && there != known.end();
      if (both && here->second == there->second) continue;
      which += (which.empty() ? "" : ", ") + name;
    }
    out.Error("fit.other_fit", {path}, "the file belongs to another fit, which differs in " + which,
              "choose another folder with --out, or remove this one");
    return false;
  }
  if (!ReadPoints()) {
    out.Error("fit.memory_not_readable", {path}, "cannot read: " + database_->TakeError());
    return false;
  }
  if (known.empty() && remembered_ + damaged_ > 0) {
    out.Error("fit.memory_damaged", {path},
              "the file is damaged: it contains points, but not the inputs of their fit",
              "choose another folder with --out, or remove this one");
    return false;
  }
  if (known.empty() && !WriteFacts(facts)) {
    out.Error("fit.memory_not_writable", {path}, "cannot write: " + database_->TakeError());
    return false;
  }
  return true;
}

/// Writes the facts in one transaction, since an incomplete set would identify another fit.
bool PointMemory::WriteFacts(const std::map<std::string, std::string>& facts) {
  bool good = database_->Execute("BEGIN IMMEDIATE");
  for (const auto& [name, value] : facts) {
    if (!good) break;
    Statement put(*database_, "INSERT INTO fact VALUES (?, ?)");
    good = put.Bind(name).Bind(value).Run();
  }
  return good && database_->Execute("COMMIT");  // closing rolls back an open transaction
}

bool PointMemory::ReadPoints() {
  Statement get(*database_, "SELECT key, failed, value, sum FROM point");
  const bool good = get.Run([&](learn::Row& row) {
    const std::string key = row.Text(0), failed = row.Text(1), bits = row.Text(2);
    Residuals point{{}, failed};
    if (row.Text(3) == SumOf(facts_sum_, key, failed, bits) && NumbersOf(bits, point.value)) {
      points_.emplace(key, std::move(point));
    } else {
      ++damaged_;
    }
  });
  remembered_ = static_cast<std::int64_t>(points_.size());
  return good;
}

const Residuals* PointMemory::Find(const std::string& key) const {
  const auto at = points_.find(key);
  return at == points_.end() ? nullptr : &at->second;
}

bool PointMemory::Add(const std::vector<std::pair<std::string, Residuals>>& points) {
  for (const auto& [key, point] : points) points_.insert_or_assign(key, point);
  if (!database_ || !error_.empty()) return error_.empty();
  bool good = database_->Execute("BEGIN IMMEDIATE");
  for (const auto& [key, point] : points) {
    if (!good) break;
    const std::string bits = Bits(point.value);
    Statement put(*database_, "INSERT OR REPLACE INTO point VALUES (?, ?, ?, ?)");
    good = put.Bind(key)
               .Bind(point.failed)
               .Bind(bits)
               .Bind(SumOf(facts_sum_, key, point.failed, bits))
               .Run();
  }
  if (good && database_->Execute("COMMIT")) return true;
  error_ = database_->TakeError();
  database_->Execute("ROLLBACK");
  database_->TakeError();
  return false;
}

}  // namespace taut::identify
