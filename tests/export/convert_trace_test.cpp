// Conversion of traces for other programs: selection of rows and channels, and behavior on errors.
// mcap_test.py checks the files with @mcap/core.
#include "taut/convert_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

namespace taut {
namespace {

namespace fs = std::filesystem;

class ConvertTrace : public testing::Test {
 protected:
  ConvertTrace() {
    std::string pattern = (fs::temp_directory_path() / "taut_convert_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ConvertTrace() override { fs::remove_all(folder_); }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t Files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  static Trace Rows(std::size_t count, double from_s, double period_s) {
    Trace trace;
    trace.channels = {{"cable/a/tension_n", "N"}, {"cable/b/tension_n", "N"}, {"x_m", "m"}};
    trace.values.resize(3);
    for (std::size_t i = 0; i < count; ++i) {
      trace.time_s.push_back(from_s + static_cast<double>(i) * period_s);
      for (std::size_t c = 0; c < 3; ++c) {
        trace.values[c].push_back(static_cast<double>(10 * i + c));
      }
    }
    return trace;
  }

  fs::path folder_;
  Diagnostics found_;
};

TEST_F(ConvertTrace, RowsOnAGridAreTaken) {
  // Rows every 0.1 s, whose multiples are inexact in binary; every third is selected.
  const auto kept = SelectFrom(Rows(100, 0, 0.1), {}, 0.3, "t", found_);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->time_s.size(), 34u);
  for (std::size_t i = 0; i < kept->time_s.size(); ++i) {
    EXPECT_DOUBLE_EQ(kept->time_s[i], 0.3 * static_cast<double>(i));
    EXPECT_EQ(kept->values[1][i], static_cast<double>(30 * i + 1));
  }
  // A row that rounding has placed slightly before its grid point is selected.
  Trace early = Rows(4, 0, 0.3);
  early.time_s[2] = 0.6 - 1e-9;
  const auto all = SelectFrom(early, {}, 0.3, "t", found_);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->time_s, early.time_s);
  // After a gap the next rows are selected, and the grid keeps its offset.
  Trace gap = Rows(10, 5, 0.1);
  gap.time_s = {5, 5.1, 5.2, 5.3, 7.05, 7.1, 7.25, 7.3, 7.6, 7.9};
  const auto after = SelectFrom(gap, {"x_m"}, 0.3, "t", found_);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->time_s, (std::vector<double>{5, 5.3, 7.05, 7.1, 7.6, 7.9}));
  ASSERT_EQ(after->channels.size(), 1u);
  EXPECT_EQ(after->values[0], (std::vector<double>{2, 32, 42, 52, 82, 92}));
}

TEST_F(ConvertTrace, AllOfItIsTakenWhereNothingElseIsAsked) {
  Trace trace = Rows(7, -1, 0.25);
  trace.metadata = {{"run", "abc"}};
  trace.unfinished = true;
  const auto kept = SelectFrom(trace, {}, 0, "t", found_);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->time_s, trace.time_s);
  EXPECT_EQ(kept->values, trace.values);
  EXPECT_EQ(kept->metadata, trace.metadata);
  EXPECT_TRUE(kept->unfinished);
}

TEST_F(ConvertTrace, APatternThatFitsNothingIsAnError) {
  EXPECT_FALSE(SelectFrom(Rows(3, 0, 1), {"cable/c/*"}, 0, "some.h5", found_));
  ASSERT_EQ(found_.items().size(), 1u);
  EXPECT_EQ(found_.items()[0].at.file, "some.h5");
}

TEST_F(ConvertTrace, WhatIsStoppedLeavesWhatWasThere) {
  const Trace trace = Rows(5000, 0, 0.01);
  for (const char* name : {"out.csv", "out.mcap"}) {
    std::ofstream(Path(name)) << "before";
    const bool csv = std::string(name) == "out.csv";
    double share = 0;
    const GoOn stop = [&](double s) {
      share = s;
      return s < 0.5;
    };
    const Conversion end = csv ? WriteTraceCsv(trace, Path(name), stop, found_)
                               : WriteTraceMcap(trace, nullptr, Path(name), stop, found_);
    EXPECT_EQ(end, Conversion::kStopped);
    EXPECT_GE(share, 0.5);
    EXPECT_TRUE(found_.ok());
    std::ifstream file(Path(name));
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "before");
  }
  EXPECT_EQ(Files(), 2u);
}

TEST_F(ConvertTrace, CsvReadsBackToTheBit) {
  Trace trace = Rows(500, 0, 0.001);
  trace.values[0][3] = std::nan("");
  trace.values[1][4] = -std::numeric_limits<double>::infinity();
  trace.values[2][5] = 0.1 + 0.2;
  ASSERT_EQ(WriteTraceCsv(trace, Path("out.csv"), {}, found_), Conversion::kDone);
  const auto read = ReadTrace(Path("out.csv"), found_);
  ASSERT_TRUE(read) << found_.Format();
  EXPECT_EQ(read->time_s, trace.time_s);
  EXPECT_TRUE(std::isnan(read->values[0][3]));
  EXPECT_EQ(read->values[1], trace.values[1]);
  EXPECT_EQ(read->values[2], trace.values[2]);
  EXPECT_EQ(Files(), 1u);
}

TEST_F(ConvertTrace, McapReadsBackToTheBitButForTimesInNanoseconds) {
  Trace trace = Rows(500, 0, 0.001);
  trace.values[0][3] = std::nan("");
  trace.values[2][5] = 0.1 + 0.2;
  trace.metadata = {{"experiment", "drop"}};
  ASSERT_EQ(WriteTraceMcap(trace, nullptr, Path("out.mcap"), {}, found_), Conversion::kDone);
  const auto read = ReadTrace(Path("out.mcap"), found_);
  ASSERT_TRUE(read) << found_.Format();
  ASSERT_EQ(read->channels.size(), trace.channels.size());
  for (std::size_t c = 0; c < trace.channels.size(); ++c) {
    const auto at = read->Find(trace.channels[c].name);
    ASSERT_TRUE(at) << trace.channels[c].name;
    EXPECT_EQ(read->channels[*at].unit, UnitOfName(trace.channels[c].name));
    for (std::size_t row = 0; row < trace.time_s.size(); ++row) {
      const double value = read->values[*at][row], wanted = trace.values[c][row];
      EXPECT_TRUE(value == wanted || (std::isnan(value) && std::isnan(wanted))) << row;
    }
  }
  for (std::size_t row = 0; row < trace.time_s.size(); ++row) {
    EXPECT_NEAR(read->time_s[row], trace.time_s[row], 0.5e-9);
  }
  EXPECT_EQ(read->metadata, trace.metadata);
  EXPECT_FALSE(read->unfinished);
}

TEST_F(ConvertTrace, TimesThatNanosecondsCannotSayAreAnError) {
  Trace trace = Rows(2, 0, 1);
  trace.time_s[1] = 2e10;
  EXPECT_EQ(WriteTraceMcap(trace, nullptr, Path("out.mcap"), {}, found_), Conversion::kFailed);
  EXPECT_EQ(found_.items().size(), 1u);
  EXPECT_EQ(Files(), 0u);
}

TEST_F(ConvertTrace, NoRowsAreNoMessages) {
  EXPECT_EQ(WriteTraceMcap(Rows(0, 0, 1), nullptr, Path("out.mcap"), {}, found_),
            Conversion::kDone);
  EXPECT_EQ(WriteTraceCsv(Rows(0, 0, 1), Path("out.csv"), {}, found_), Conversion::kDone);
  EXPECT_EQ(Files(), 2u);
}

}  // namespace
}  // namespace taut
