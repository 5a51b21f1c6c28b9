// Logs of MATLAB 7.3: tests/data/logs/matlab.mat contains vectors in rows and columns, matrices, a
// struct, a text, an empty and a complex variable.
#include <filesystem>
#include <fstream>

#include "taut/compare.h"
#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

class MatLog : public TraceFolder {
 protected:
  std::optional<Trace> Read(const std::string& path, const std::string& table, Diagnostics& out) {
    const std::string map = WriteFile("m.json", "{\"version\": 1, \"table\": " + table + "}");
    const auto mapping = LoadMapping(map, out);
    return mapping ? ReadMapped(path, *mapping, map, out) : std::nullopt;
  }
  std::string Wrong(const std::string& path, const std::string& table) {
    Diagnostics out;
    EXPECT_FALSE(Read(path, table, out));
    return out.Format();
  }
  const std::string log_ = std::string(TAUT_SOURCE_DIR) + "/tests/data/logs/matlab.mat";
};

TEST_F(MatLog, AllRealVariablesOfTheClocksLengthAreColumns) {
  Diagnostics out;
  const auto trace =
      Read(log_, R"({"ignore": ["a1*"], "time": {"column": "Time_ms", "unit": "ms"}})", out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(trace->time_s.size(), 11u);
  EXPECT_DOUBLE_EQ(trace->time_s[10], 0.2);
  std::vector<std::string> names;
  for (const ChannelInfo& channel : trace->channels) names.push_back(channel.name);
  EXPECT_EQ(names, (std::vector<std::string>{"a0_c0_N", "log.roll_deg", "marker_1", "marker_2",
                                             "marker_3", "transposed_1", "transposed_2"}));
  for (std::size_t i = 0; i < 11; ++i) {
    const double x = static_cast<double>(i);
    EXPECT_DOUBLE_EQ(trace->values[0][i], 7.75 + 0.05 * x);
    EXPECT_DOUBLE_EQ(trace->values[1][i], x);
    EXPECT_DOUBLE_EQ(trace->values[2][i], 0.1);
    EXPECT_DOUBLE_EQ(trace->values[4][i], 0.001 * x);
    EXPECT_DOUBLE_EQ(trace->values[6][i], 2 * x);  // 2 x 11: its rows are columns
  }
}

TEST_F(MatLog, WithoutAClockRowsHaveAFixedPeriod) {
  Diagnostics out;
  const auto trace = Read(log_, R"({"time": {"row_s": 0.5}})", out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(trace->channels.size(), 9u);
  EXPECT_EQ(trace->time_s[10], 5);
}

TEST_F(MatLog, OtherFilesAreRefused) {
  EXPECT_NE(Wrong(log_, R"({"time": {"column": "time_ms"}})")
                .find("the file has no vector \"time_ms\" (did you mean \"Time_ms\"?)"),
            std::string::npos);
  EXPECT_NE(Wrong(log_, R"({"time": {"column": "marker"}})").find("no vector \"marker\""),
            std::string::npos);
  const std::string version_5 = WriteFile("old.mat", "MATLAB 5.0 MAT-file, Platform: GLNXA64");
  EXPECT_NE(
      Wrong(version_5, R"({"time": {"row_s": 1}})")
          .find("not a MATLAB file of version 7.3 (save it with save(\"log.mat\", \"-v7.3\"))"),
      std::string::npos);
  // Cut after half of its bytes.
  std::ifstream file(log_, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const std::string half = WriteFile("half.mat", bytes.substr(0, bytes.size() / 2));
  EXPECT_NE(Wrong(half, R"({"time": {"row_s": 1}})").find("the file is damaged"),
            std::string::npos);
}

TEST_F(MatLog, AClockMustIncrease) {
  EXPECT_NE(Wrong(log_, R"({"time": {"column": "nothing"}})").find("no vector"), std::string::npos);
  Diagnostics out;
  const auto first =
      Read(log_, R"({"time": {"column": "log.roll_deg", "zero": "first", "offset_s": 2}})", out);
  ASSERT_TRUE(first) << out.Format();
  EXPECT_EQ(first->time_s[0], 2);
}

}  // namespace
}  // namespace taut::test
