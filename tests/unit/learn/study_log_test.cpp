// A study's log, complete and damaged: no loss and no change without a message
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <random>

#include "tests/unit/learn/study_log_files.h"

namespace taut::test {
namespace {

namespace fs = std::filesystem;
using learn::Database;
using learn::Log;
using learn::LogContents;

/// Flips bits after the first `from` bytes.
void FlipBits(std::string& bytes, int count, std::size_t from, std::mt19937& random) {
  for (; count > 0; --count) {
    char& byte = bytes[from + random() % (bytes.size() - from)];
    byte = static_cast<char>(byte ^ 1 << random() % 8);
  }
}

class StudyLog : public testing::Test {
 protected:
  StudyLog() {
    std::string pattern = (fs::temp_directory_path() / "taut_log_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    path_ = (folder_ / "study.sqlite").string();
  }
  ~StudyLog() override { fs::remove_all(folder_); }

  std::string Whole() {
    static std::string bytes;
    if (bytes.empty()) {
      EXPECT_EQ(WriteLog((folder_ / "whole").string()), "");
      bytes = FileBytes((folder_ / "whole").string());
    }
    return bytes;
  }
  std::string Old() {
    EXPECT_EQ(WriteOldLog((folder_ / "old").string()), "");
    return FileBytes((folder_ / "old").string());
  }
  /// Returns the log after a change by SQL.
  std::optional<LogContents> After(const std::string& sql, Diagnostics& out) {
    std::ofstream(path_, std::ios::binary) << Whole();
    {
      Database log(path_, Database::Open::kThatIsThere);
      EXPECT_TRUE(log.Execute(sql)) << sql << log.TakeError();
    }
    return ReadLog(path_, FileBytes(path_), out);
  }
  std::string WithoutFolder(std::string text) const {
    const std::string folder = folder_.string() + "/";
    for (std::size_t at; (at = text.find(folder)) != text.npos;) text.erase(at, folder.size());
    return text;
  }

  fs::path folder_;
  std::string path_;
};

TEST(Sqlite, AnErrorIsNotTheEndOfTheRows) {
  Database database;
  ASSERT_TRUE(
      database.Execute("CREATE TABLE t (x); INSERT INTO t VALUES (1), (2), (-1 << 63), (3)"));
  int rows = 0;
  EXPECT_FALSE(
      learn::Statement(database, "SELECT abs(x) FROM t").Run([&](learn::Row&) { ++rows; }));
  EXPECT_EQ(rows, 2);
  EXPECT_FALSE(database.good());
  EXPECT_EQ(database.TakeError(), "integer overflow");
  EXPECT_TRUE(database.good());
  EXPECT_FALSE(learn::Statement(database, "SELECT y FROM t").Run());
  EXPECT_EQ(database.TakeError(), "no such column: y");
}

TEST_F(StudyLog, GivesBackEveryBit) {
  Diagnostics out;
  const auto log = ReadLog(path_, Whole(), out);
  ASSERT_TRUE(log) << out.Format();
  EXPECT_EQ(log->damage, std::vector<std::string>{});
  ASSERT_EQ(log->evaluations.size(), static_cast<std::size_t>(kLogged));
  EXPECT_TRUE(IsTrue(*log));
  EXPECT_EQ(log->evaluations[7].values, LoggedEvaluation(7).values);
  EXPECT_EQ(log->evaluations[7].worlds[1].state_hash, LoggedEvaluation(7).worlds[1].state_hash);
  EXPECT_EQ(log->parameters[1].targets, (std::vector<std::string>{"hold.b", "hold.c"}));
}

// As on a read-only medium. Root may write everywhere, so that a child process drops its rights.
TEST_F(StudyLog, OpensWhereItsFolderCannotBeWritten) {
  const std::string odd = (folder_ / "50% #1? study.sqlite").string();
  std::ofstream(odd, std::ios::binary) << Whole();
  fs::permissions(odd, fs::perms{0444});
  fs::permissions(folder_, fs::perms{0555});
  const auto read = [&] {
    if (geteuid() == 0 && setuid(65534) != 0) std::_Exit(3);
    Diagnostics out;
    const auto log = Log::OpenToRead(odd, out);
    const auto contents = log ? log->Read(out) : std::nullopt;
    std::cerr << out.Format();
    if (!contents || !contents->damage.empty()) std::_Exit(1);
    std::_Exit(contents->evaluations.size() == kLogged ? 0 : 2);
  };
  EXPECT_EXIT(read(), testing::ExitedWithCode(0), "");
  fs::permissions(folder_, fs::perms{0755});
  std::ofstream(odd + "-wal", std::ios::binary) << "rows that only the log has";
  fs::permissions(folder_, fs::perms{0555});
  EXPECT_EXIT(read(), testing::ExitedWithCode(1),
              "some rows are in .*-wal, and the folder cannot be");
  fs::permissions(folder_, fs::perms{0755});
}

TEST_F(StudyLog, OfVersionOneIsReadAndBecomesOneOfThisVersion) {
  Diagnostics out;
  std::ofstream(path_, std::ios::binary) << Old();
  {
    const auto log = Log::Open(path_, out);
    const auto contents = log->Read(out);
    ASSERT_TRUE(contents) << out.Format();
    EXPECT_EQ(contents->version, 1);
    EXPECT_TRUE(IsTrue(*contents));
    ASSERT_TRUE(log->Begin(*contents, out)) << out.Format();
    ASSERT_TRUE(log->Add(LoggedEvaluation(kLogged), out)) << out.Format();
  }
  const auto again = ReadLog(path_, FileBytes(path_), out);
  ASSERT_TRUE(again) << out.Format();
  EXPECT_EQ(again->version, 2);
  EXPECT_EQ(again->damage, std::vector<std::string>{});
  EXPECT_EQ(again->evaluations.size(), static_cast<std::size_t>(kLogged) + 1);
}

TEST_F(StudyLog, EveryChangeIsNamed) {
  const std::string changed = "evaluation 3: its checksum does not match its content";
  for (const auto& [sql, damage] : std::vector<std::pair<std::string, std::string>>{
           {"UPDATE evaluation SET parameter_values = '[]' WHERE id = 3",
            "evaluation 3: it has 0 values, but the study has 2 parameters"},
           {"UPDATE evaluation SET parameter_values = '[1, null]' WHERE id = 3",
            "evaluation 3: parameter_values is not a list of numbers"},
           {"UPDATE evaluation SET parameter_values = '[1, 1e999]' WHERE id = 3",
            "evaluation 3: parameter_values is not a list of numbers"},
           {"UPDATE evaluation SET parameter_values = '[2, 0]' WHERE id = 3",
            "evaluation 3: the value of a is beyond its bounds"},
           {"UPDATE evaluation SET score = score + 1e-12 WHERE id = 3", changed},
           {"UPDATE evaluation SET score = NULL WHERE id = 3",
            "evaluation 3: its score and failure are inconsistent"},
           {"UPDATE evaluation SET score = 9e999 WHERE id = 3",
            "evaluation 3: its score and failure are inconsistent"},
           {"UPDATE evaluation SET score = x'00' WHERE id = 3",
            "evaluation 3: score is not a number"},
           {"UPDATE evaluation SET failed = x'00' WHERE id = 3",
            "evaluation 3: failed is not text"},
           {"UPDATE evaluation SET search = 1 << 40 WHERE id = 3",
            "evaluation 3: search is too large"},
           {"UPDATE evaluation SET search = -1 WHERE id = 3",
            "evaluation 3: its id or search is negative"},
           {"UPDATE evaluation SET elapsed_s = 9e999 WHERE id = 3",
            "evaluation 3: elapsed_s is not a time"},
           {"UPDATE world SET seed = '12x' WHERE evaluation = 3 AND world = 1",
            "evaluation 3: world 1: seed is not a whole number"},
           {"UPDATE world SET energy_j = 9e999 WHERE evaluation = 3 AND world = 0",
            "evaluation 3: a number of world 0 is not finite"},
           {"UPDATE world SET fell_s = NULL WHERE evaluation = 3 AND world = 0", changed},
           {"UPDATE world SET state_hash = '1' WHERE evaluation = 3 AND world = 0", changed},
           {"UPDATE world SET world = 5 WHERE evaluation = 3 AND world = 0",
            "evaluation 3: world 0 is missing"},
           {"DELETE FROM world WHERE evaluation = 3 AND world = 1", changed},
           {"DELETE FROM world WHERE evaluation = 3", "evaluation 3: its worlds are missing"}}) {
    Diagnostics out;
    const auto log = After(sql, out);
    ASSERT_TRUE(log) << out.Format();
    ASSERT_EQ(log->damage.size(), 2u) << sql;
    EXPECT_EQ(log->damage[0], damage) << sql;
    EXPECT_EQ(log->damage[1], "60 evaluations were written, 59 of them are intact");
    EXPECT_EQ(log->evaluations.size(), 59u);
    EXPECT_TRUE(IsTrue(*log)) << sql;
  }
  Diagnostics out;
  const auto log = After("DELETE FROM evaluation WHERE id = 59", out);
  ASSERT_TRUE(log) << out.Format();
  EXPECT_EQ(log->damage,
            std::vector<std::string>{"60 evaluations were written, 59 of them are intact"});
}

TEST_F(StudyLog, WithOtherFactsParametersOrTablesIsRefused) {
  const std::string useless =
      " (its evaluations are unusable; choose another folder with `--out`)\n";
  const std::string changed =
      "the log is damaged: its metadata or parameters were changed" + useless;
  for (const auto& [sql, complaint] : std::vector<std::pair<std::string, std::string>>{
           {"UPDATE fact SET value = 'x' WHERE name = 'study'", changed},
           {"DELETE FROM fact WHERE name = 'study'", changed},
           {"INSERT INTO fact VALUES ('more', '1')", changed},
           {"UPDATE fact SET value = '3' WHERE name = 'log_version'", changed},
           {"UPDATE parameter SET unit = 'm' WHERE position = 0", changed},
           {"DELETE FROM parameter", changed},
           {"PRAGMA application_id = 1", changed},
           {"UPDATE fact SET value = x'00' WHERE name = 'study'",
            "the log is damaged: a fact's value is not text" + useless},
           {"UPDATE parameter SET high = 9e999 WHERE position = 1",
            "the log is damaged: parameter 1: low and high are not valid bounds" + useless},
           {"UPDATE parameter SET targets = '[1]' WHERE position = 1",
            "the log is damaged: parameter 1: targets is not a list of strings" + useless},
           {"UPDATE parameter SET position = 9 WHERE position = 0",
            "the log is damaged: parameter 1: position has a gap" + useless},
           {"CREATE TABLE other (x)",
            "the file is not the log of a study: it contains other tables\n"},
           {"CREATE TRIGGER t AFTER INSERT ON fact BEGIN DELETE FROM world; END",
            "the file is not the log of a study: it contains other tables\n"},
           {"DROP TABLE world; CREATE VIEW world AS SELECT * FROM evaluation",
            "the file is not the log of a study: it contains other tables\n"},
           {"ALTER TABLE world ADD COLUMN x; UPDATE fact SET value = '7' WHERE name = "
            "'log_version'",
            "the log has version 7; this taut reads versions 1 to 2\n"}}) {
    Diagnostics out;
    EXPECT_FALSE(After(sql, out)) << sql;
    EXPECT_EQ(WithoutFolder(out.Format()), "study.sqlite: error: " + complaint) << sql;
  }
}

TEST_F(StudyLog, DamageIsNeverSilent) {
  const std::string whole = Whole(), old = Old();
  constexpr std::size_t kPage = 4096;
  std::mt19937 random(3);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  int refused = 0, damaged = 0, good = 0;
  std::size_t saved = 0;
  for (int i = 0; i < 600; ++i) {
    std::string bytes = i % 6 == 5 ? old : whole;
    switch (i % 3) {
      case 0:
        FlipBits(bytes, 8, 100, random);
        break;
      case 1:
        std::fill_n(bytes.begin() + static_cast<long>(below(bytes.size() / kPage) * kPage), kPage,
                    0);
        break;
      default:
        if (i % 2 == 0) {
          bytes.resize(kPage * (1 + below(bytes.size() / kPage - 1)));
        } else {
          FlipBits(bytes, 2, 0, random);
        }
    }
    Diagnostics out;
    const auto log = ReadLog(path_, bytes, out);
    ASSERT_EQ(log.has_value(), out.ok()) << i;
    if (!log) {
      ++refused;
      continue;
    }
    ++(log->damage.empty() ? good : damaged);
    if (i % 6 == 5) continue;  // version 1 cannot detect a changed number
    EXPECT_TRUE(IsTrue(*log)) << i;
    if (!log->damage.empty()) saved += log->evaluations.size();
  }
  std::cout << refused << " refused, " << damaged << " damaged with " << saved
            << " evaluations saved, " << good << " not noticeably\n";
  EXPECT_GT(refused, 20);
  EXPECT_GT(damaged, 200);
  EXPECT_GT(saved, 3000u);
}

TEST_F(StudyLog, IsWholeAgainOnceASearchHasBegunAndTheDamagedFileIsKept) {
  const std::string whole = Whole();
  std::mt19937 random(4);
  int rewritten = 0;
  for (int i = 0; i < 60; ++i) {
    std::string bytes = whole;
    FlipBits(bytes, 8, 4096, random);
    Diagnostics out;
    if (!ReadLog(path_, bytes, out)) continue;
    std::vector<Evaluation> kept;
    {
      const auto log = Log::Open(path_, out);
      const auto contents = log->Read(out);
      ASSERT_TRUE(contents) << out.Format();
      ASSERT_TRUE(log->Begin(*contents, out)) << i << out.Format();
      kept = contents->evaluations;
      ASSERT_TRUE(log->Add(LoggedEvaluation(1000), out)) << i << out.Format();
      if (contents->damage.empty()) continue;
    }
    EXPECT_EQ(FileBytes(path_ + ".damaged").size(), bytes.size());
    const auto again = ReadLog(path_, FileBytes(path_), out);
    ASSERT_TRUE(again) << i << out.Format();
    EXPECT_EQ(again->damage, std::vector<std::string>{}) << i;
    EXPECT_EQ(again->evaluations.size(), kept.size() + 1);
    ++rewritten;
  }
  EXPECT_GT(rewritten, 20);
}

TEST_F(StudyLog, SaysWhenItIsGone) {
  Diagnostics out;
  const auto log = Log::Open(path_, out);
  ASSERT_TRUE(log && log->Read(out) && log->Begin(NewLog(), out)) << out.Format();
  ASSERT_TRUE(log->Add(LoggedEvaluation(0), out));
  EXPECT_TRUE(log->IsThere(out));
  const std::string moved = folder_.string() + "_moved";
  fs::rename(folder_, moved);
  EXPECT_FALSE(log->Add(LoggedEvaluation(1), out));
  EXPECT_EQ(
      WithoutFolder(out.Format()),
      "study.sqlite: error: the log or its folder was deleted or moved during the search (if it "
      "was moved, resume with `--out` and its new path)\n");
  EXPECT_FALSE(log->IsThere(out));
  fs::rename(moved, folder_);
  EXPECT_TRUE(log->IsThere(out)) << "back again";
}

}  // namespace
}  // namespace taut::test
