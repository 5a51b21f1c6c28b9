// Measurements as tables with foreign headers, units and clocks, read by a mapping
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include "taut/compare.h"
#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

class MeasuredTable : public TraceFolder {
 protected:
  std::optional<Trace> Read(const std::string& path, const std::string& map, Diagnostics& out) {
    const std::string map_path = WriteFile("m.json", "{\"version\": 1, " + map + "}");
    const auto mapping = LoadMapping(map_path, out);
    return mapping ? ReadMapped(path, *mapping, map_path, out) : std::nullopt;
  }
  Trace Good(const std::string& path, const std::string& map) {
    Diagnostics out;
    const auto trace = Read(path, map, out);
    EXPECT_TRUE(trace) << out.Format();
    return trace.value_or(Trace{});
  }
  Trace GoodText(const std::string& text, const std::string& map) {
    return Good(WriteFile("t.csv", text), map);
  }
  /// Returns the errors, without the folder's name.
  std::string Wrong(const std::string& text, const std::string& map) {
    Diagnostics out;
    EXPECT_FALSE(Read(WriteFile("t.csv", text), map, out));
    std::string found = out.Format();
    const std::string head = Path("");
    for (std::size_t at; (at = found.find(head)) != found.npos;) found.erase(at, head.size());
    return found;
  }
  static const std::vector<double>& Values(const Trace& trace, const std::string& name) {
    static const std::vector<double> none;
    const auto at = trace.Find(name);
    EXPECT_TRUE(at) << name;
    return at ? trace.values[*at] : none;
  }
  static std::string Best(const std::string& file) {
    return std::string(TAUT_SOURCE_DIR) + "/tests/data/best_2d_spine/" + file;
  }
};

TEST_F(MeasuredTable, PosesOfTheBestSpineAreReadUnchanged) {
  const std::string path = Best("test0_measured_pose.csv");
  const Trace pose = Good(
      path,
      R"m("table": {"skip_lines": 1, "time": {"column": "Timestamp (millisec since midnight today)",
         "unit": "ms", "zero": "first", "offset_s": 2.5}},
         "channels": [{"from": "CoM X (cm)", "to": "body/v/position_x_m", "from_unit": "cm"},
                      {"from": "CoM Y (cm)", "to": "body/v/position_z_m", "from_unit": "cm", "offset": -0.1},
                      {"from": "Rotation (deg)", "to": "body/v/angle_rad", "from_unit": "deg"}])m");
  // Reads the table independently.
  std::ifstream file(path);
  std::string line;
  std::getline(file, line), std::getline(file, line);
  std::size_t row = 0;
  double first_ms = 0;
  for (double ms, x, y, turn; file >> ms; ++row) {
    char comma;
    file >> comma >> x >> comma >> y >> comma >> turn;
    if (row == 0) first_ms = ms;
    ASSERT_LT(row, pose.time_s.size());
    ASSERT_NEAR(pose.time_s[row], 2.5 + (ms - first_ms) / 1000, 1e-9);
    ASSERT_NEAR(Values(pose, "body/v/position_x_m")[row], x / 100, 1e-15);
    ASSERT_NEAR(Values(pose, "body/v/position_z_m")[row], y / 100 - 0.1, 1e-15);
    ASSERT_NEAR(Values(pose, "body/v/angle_rad")[row], turn * std::numbers::pi / 180, 1e-15);
  }
  EXPECT_EQ(row, 871u);
  EXPECT_EQ(pose.time_s.size(), row);
  EXPECT_EQ(pose.channels[0].unit, "m");
}

TEST_F(MeasuredTable, ColumnsWithoutNamesGetThemFromTheMapping) {
  const Trace set = Good(
      Best("test0_setpoints.csv"),
      R"m("table": {"skip_lines": 2, "header": false, "columns": ["t", "", "", "", "x", "y", "turn"],
         "time": {"column": "t", "unit": "ms", "zero": 62006291}},
         "channels": [{"from": "turn", "to": "set_rad"}])m");
  ASSERT_EQ(set.time_s.size(), 119u);
  EXPECT_NEAR(set.time_s[0], 4.615, 1e-9);  // on the clock of the poses
  EXPECT_EQ(set.channels.size(), 3u);
  EXPECT_EQ(Values(set, "set_rad")[0], -0.014913);
  const Trace commands = Good(
      Best("commands.csv"),
      R"m("table": {"skip_lines": 5, "header": false, "columns": ["c1", "c2", "c3", "c4", "a", "b", "c", "x", "y", "r"],
         "ignore": ["a", "b", "c"], "time": {"row_s": 2}},
         "channels": [{"from": "c*", "to": "cable/*/wound_m", "from_unit": "cm"}])m");
  ASSERT_EQ(commands.time_s.size(), 120u);
  EXPECT_EQ(commands.time_s[3], 6);
  EXPECT_NEAR(Values(commands, "cable/3/wound_m")[0], -0.0058308, 1e-15);
}

TEST_F(MeasuredTable, StepsOfLoadAndOneValueARowAreTablesToo) {
  const Trace steps = GoodText(
      "load_kN_per_top_node,S1_kN,H3_mm,alpha3_deg,note\n-0.001,1.5,1946,30,\"so, "
      "so\"\n0.11,2.25,,45,b",
      R"m("table": {"time": {"column": "load_kN_per_top_node"}, "ignore": ["note"]},
         "channels": [{"from": "S*_kN", "to": "strut/S*/axial_n", "from_unit": "kN", "scale": -1},
                      {"from": "*_mm", "to": "node/*/position_z_m", "from_unit": "mm"}])m");
  ASSERT_EQ(steps.time_s, (std::vector<double>{-0.001, 0.11}));
  EXPECT_EQ(Values(steps, "strut/S1/axial_n"), (std::vector<double>{-1500, -2250}));
  EXPECT_NEAR(Values(steps, "node/H3/position_z_m")[0], 1.946, 1e-15);
  EXPECT_TRUE(std::isnan(Values(steps, "node/H3/position_z_m")[1]));
  EXPECT_EQ(steps.channels.size(), 3u);

  const Trace spread = GoodText(
      "actuated,by_mm,quantity,\"which(1=dark,2=mid)\",value\n"
      "CT3,0.5,CB_kN,1,3\nCT3,1.5,CB_kN,1,4\nCT3,1.5,CB_kN,2,5\n",
      R"m("table": {"time": {"column": "by_mm"}, "names": ["quantity", "which(1=dark,2=mid)"], "value": "value"},
         "channels": [{"from": "CB_kN_*", "to": "cable/CB*/tension_n", "from_unit": "kN"}])m");
  ASSERT_EQ(spread.time_s, (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(Values(spread, "cable/CB1/tension_n"), (std::vector<double>{3000, 4000}));
  EXPECT_TRUE(std::isnan(Values(spread, "cable/CB2/tension_n")[0]));
  EXPECT_EQ(Values(spread, "cable/CB2/tension_n")[1], 5000);
}

TEST_F(MeasuredTable, SeparatorsClocksAndUnits) {
  const Trace a =
      GoodText("t;F\r\n1700000000.5;10\r\n1700000001;NA\r\n",
               R"m("table": {"separator": ";", "time": {"column": "t", "zero": 1700000000}},
                              "channels": [{"from": "F", "to": "cable/a/tension_n", "from_unit": "lbf"}])m");
  EXPECT_EQ(a.time_s, (std::vector<double>{0.5, 1}));
  EXPECT_NEAR(Values(a, "cable/a/tension_n")[0], 44.482216152605, 1e-12);
  EXPECT_TRUE(std::isnan(Values(a, "cable/a/tension_n")[1]));
  const Trace b =
      GoodText("  0   1  2\n 1   +3  4", R"m("table": {"separator": " ", "header": false,
      "columns": ["t", "x", "y"], "time": {"column": "t", "unit": "min"}})m");
  EXPECT_EQ(b.time_s, (std::vector<double>{0, 60}));
  EXPECT_EQ(Values(b, "x"), (std::vector<double>{1, 3}));
}

constexpr const char* kPlain = R"m("table": {"time": {"column": "t"}})m";

TEST_F(MeasuredTable, DecimalCommasAreOneError) {
  std::string rows = "t;x\n";
  for (int i = 0; i < 30; ++i) rows += std::to_string(i) + ",25;7,75\n";
  EXPECT_EQ(Wrong(rows, R"m("table": {"separator": ";", "time": {"column": "t"}})m"),
            "t.csv:2:1: error: numbers have a decimal comma, such as \"0,25\" (add \"decimal\": "
            "\",\" to the table in the mapping)\n");
}

TEST_F(MeasuredTable, MistakesInATableAreNamedWithTheirLine) {
  EXPECT_EQ(
      Wrong("t,x\n0,1\n2,2\n1,3\n1,4\n", kPlain),
      "t.csv:4:1: error: the time 1 s is before the time 2 s in line 3 (times must increase)\n"
      "t.csv:5:1: error: the time 1 s equals the time 1 s in line 4 (times must increase)\n");
  EXPECT_EQ(Wrong("t,x\n86399.9,1\n0.1,2\n", kPlain),
            "t.csv:3:1: error: the time 0.1 s is before the time 86399.9 s in line 2 (times must "
            "increase; the clock may have passed midnight)\n");
  EXPECT_EQ(Wrong("t,x\n0,1\nnan,2\n1,a\n2\n", kPlain),
            "t.csv:3:1: error: the time is not a number (leave out rows without a time)\n"
            "t.csv:4:3: error: \"a\" is not a number (in the mapping, `skip_lines` skips lines "
            "before the rows, and `ignore` skips a column of text)\n"
            "t.csv:5: error: the row has 1 values, but the table has 2 columns\n");
  EXPECT_EQ(Wrong("time,x\n0,1\n", kPlain),
            "t.csv:1: error: the table has no column \"t\" (did you mean \"x\"?)\n");
  EXPECT_EQ(Wrong("t,x,t\n0,1,2\n", kPlain),
            "t.csv:1: error: the table has two columns \"t\" (rename them with `columns` in the "
            "mapping)\n");
  EXPECT_EQ(Wrong("t,x\n", kPlain), "t.csv:1: error: the table has no rows\n");
  EXPECT_EQ(Wrong("t,x\n", R"m("table": {"skip_lines": 3, "time": {"column": "t"}})m"),
            "t.csv:1: error: the table ends before its rows begin (the mapping skips 3 lines)\n");
  EXPECT_EQ(
      Wrong("t,x\n0,1\n",
            R"m("table": {"time": {"column": "t"}}, "channels": [{"from": "y", "to": "z"}])m"),
      "m.json: error: t.csv has no column \"y\" (did you mean \"x\"?)\n");
}

TEST_F(MeasuredTable, MistakesInItsLayoutAreNamed) {
  EXPECT_EQ(
      Wrong("", R"m("table": {"skip_lines": -1, "header": "a", "separator": "ab", "ignore": "x",
                           "names": ["a"]})m"),
      "m.json: error: table must have both \"names\" and \"value\", or neither (they select "
      "the columns of channel names and values, for tables with one value per row)\n"
      "m.json: error: table.header must be true, false or a number of lines, at most 10\n"
      "m.json: error: table.ignore must be a list of strings\n"
      "m.json: error: table.separator must be one of \",\", \";\", \"|\", \"\\t\", \" \"\n"
      "m.json: error: table.skip_lines must be a whole number of lines, at most 1000000\n"
      "m.json: error: table.time is missing (expected {\"column\": \"t\", \"unit\": \"ms\"} "
      "or {\"row_s\": 1})\n");
  EXPECT_EQ(Wrong("", R"m("table": {"header": false,
                           "time": {"column": "t", "unit": "cm", "zero": "last"}})m"),
            "m.json: error: table.columns is missing (list the names of the columns, because the "
            "table has no header)\n"
            "m.json: error: table.time.unit is cm, but the result is in s\n"
            "m.json: error: table.time.zero must be a number or \"first\"\n");
  EXPECT_EQ(Wrong("", R"m("table": {"time": {"row_s": 0, "column": "t"}, "colums": []})m"),
            "m.json: error: table.colums is not a known key (did you mean \"columns\"?)\n"
            "m.json: error: table.time has both row_s and column\n"
            "m.json: error: table.time.row_s must be above 0\n");
  EXPECT_EQ(Wrong("", R"m("channels": [{"from": "a", "to": "b_m", "from_unit": "kN"},
                                       {"from": "c", "to": "d_n", "from_unit": "kNN"}])m"),
            "m.json: error: channels[0].from_unit is kN, but the result is in m\n"
            "m.json: error: channels[1].from_unit is the unknown unit \"kNN\" (did "
            "you mean \"kN\"?)\n");
}

}  // namespace
}  // namespace taut::test
