// Tables in the forms that measurement programs write: decimal commas, encodings, headers of
// several lines, clocks with dates, rows of different lengths.
#include "taut/compare.h"
#include "tests/unit/trace/trace_fixture.h"
#include "trace/clock_text.h"
#include "trace/text_encoding.h"

namespace taut::test {
namespace {

using trace::ParseClock;

class LogTable : public TraceFolder {
 protected:
  std::optional<Trace> Read(const std::string& text, const std::string& map, Diagnostics& out) {
    const std::string map_path = WriteFile("m.json", "{\"version\": 1, " + map + "}");
    const auto mapping = LoadMapping(map_path, out);
    return mapping ? ReadMapped(WriteFile("t.csv", text), *mapping, map_path, out) : std::nullopt;
  }
  Trace Good(const std::string& text, const std::string& map) {
    Diagnostics out;
    const auto trace = Read(text, map, out);
    EXPECT_TRUE(trace) << out.Format();
    return trace.value_or(Trace{});
  }
  std::string Wrong(const std::string& text, const std::string& map) {
    Diagnostics out;
    EXPECT_FALSE(Read(text, map, out));
    std::string found = out.Format();
    const std::string head = Path("");
    for (std::size_t at; (at = found.find(head)) != found.npos;) found.erase(at, head.size());
    return found;
  }
};

TEST_F(LogTable, DecimalCommas) {
  const Trace trace =
      Good("t;x\n0,5;-1,25e1\n1,5;3\n",
           R"m("table": {"separator": ";", "decimal": ",", "time": {"column": "t"}})m");
  EXPECT_EQ(trace.time_s, (std::vector{0.5, 1.5}));
  EXPECT_EQ(trace.values[0], (std::vector{-12.5, 3.0}));
  EXPECT_EQ(Wrong("t;x\n0,5;1,2,3\n",
                  R"m("table": {"separator": ";", "decimal": ",", "time": {"column": "t"}})m"),
            "t.csv:2:5: error: \"1,2,3\" is not a number (in the mapping, `skip_lines` skips "
            "lines before the rows, and `ignore` skips a column of text)\n");
  EXPECT_EQ(Wrong("t,x\n", R"m("table": {"decimal": ",", "time": {"column": "t"}})m"),
            "m.json: error: table.decimal is a comma, as is the separator (add \"separator\": "
            "\";\" or \"\\t\")\n");
}

TEST_F(LogTable, ColumnsWithTautsNamesKeepTheirUnits) {
  const Trace wide = Good("t,cable/a/tension_n,body/b/position_x_m,x_m,cable/a/other\n0,1,2,3,4\n",
                          R"m("table": {"time": {"column": "t"}})m");
  std::vector<std::string> units;
  for (const ChannelInfo& channel : wide.channels) units.push_back(channel.unit);
  EXPECT_EQ(units, (std::vector<std::string>{"N", "m", "1", "1"}));
  const Trace narrow =
      Good("t,what,x\n0,cable/a/tension_n,1\n1,other,2\n",
           R"m("table": {"names": ["what"], "value": "x", "time": {"column": "t"}})m");
  EXPECT_EQ(narrow.channels[0].unit, "N");
  EXPECT_EQ(narrow.channels[1].unit, "1");
}

TEST_F(LogTable, EncodingsOfWindows) {
  constexpr const char* kMap =
      R"m("table": {"encoding": "windows-1252", "time": {"column": "t"}},
          "channels": [{"from": "Länge €", "to": "x_m"}])m";
  const std::string text = "t,L\xE4nge \x80\n0,1\n";
  EXPECT_EQ(Good(text, kMap).channels[0].name, "x_m");
  EXPECT_EQ(Wrong(text, R"m("table": {"time": {"column": "t"}})m"),
            "t.csv:1: error: the header is not UTF-8 (add \"encoding\": \"windows-1252\" to the "
            "table in the mapping)\n");
  for (const bool little : {true, false}) {
    std::string utf16 = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const char16_t unit : std::u16string(u"t,\u00E4\U0001F600\n0,1\n")) {
      const char low = static_cast<char>(unit & 0xFF), high = static_cast<char>(unit >> 8);
      utf16 += little ? low : high;
      utf16 += little ? high : low;
    }
    EXPECT_EQ(Good(utf16, R"m("table": {"time": {"column": "t"}})m").channels[0].name,
              "\u00E4\U0001F600");
  }
}

TEST_F(LogTable, BlocksMayEndWithinACharacter) {
  const std::string utf16(
      "\xFF\xFE"
      "a\0\x3D\xD8\x00\xDE"
      "b\0",
      10);
  for (std::size_t size = 1; size <= utf16.size(); ++size) {
    trace::ToUtf8 convert(TextEncoding::kUtf8);
    std::string text;
    for (std::size_t at = 0; at < utf16.size(); at += size) {
      convert.Append(std::string_view(utf16).substr(at, size), text);
    }
    convert.Append({}, text);
    EXPECT_EQ(text, "a\U0001F600b") << size;
  }
  EXPECT_TRUE(trace::IsUtf8("\u00E4\u20AC\U0001F600"));
  for (const char* wrong : {"\xE4", "\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "a\x80"}) {
    EXPECT_FALSE(trace::IsUtf8(wrong));
  }
}

TEST_F(LogTable, HeadersOfSeveralLines) {
  const Trace units =
      Good("t,force\ns,N\n0,1\n", R"m("table": {"header": 2, "time": {"column": "t s"}})m");
  EXPECT_EQ(units.channels[0].name, "force N");
  const Trace merged =
      Good(",a0,,b0,\nt,x,y,x,y\n0,1,2,3,4\n",
           R"m("table": {"header": 2, "merged_header": true, "time": {"column": "t"}})m");
  ASSERT_EQ(merged.channels.size(), 4u);
  EXPECT_EQ(merged.channels[1].name, "a0 y");
  EXPECT_EQ(merged.channels[3].name, "b0 y");
  EXPECT_EQ(Wrong("t,x\n", R"m("table": {"header": 11, "time": {"column": "t"}})m"),
            "m.json: error: table.header must be true, false or a number of lines, at most 10\n");
}

TEST_F(LogTable, RowsMayLeaveOutEmptyCellsAtTheirEnd) {
  const std::string map = R"m("table": {"ignore": ["remark"], "time": {"column": "t"}})m";
  EXPECT_EQ(Good("t,x,remark\n0,1\n1,2,start\n2,3,,\n", map).time_s.size(), 3u);
  EXPECT_EQ(Wrong("t,x,remark\n0,1\n1\n", map),
            "t.csv:3: error: the row has 1 values, but the table has 3 columns\n");
  EXPECT_EQ(Wrong("t,x,remark\n0,1,,4\n", map),
            "t.csv:2: error: the row has 4 values, but the table has 3 columns\n");
}

TEST_F(LogTable, ClocksWithDates) {
  const std::string map = R"m("table": {"time": {"column": "t", "format": "iso8601"}})m";
  const Trace trace = Good("t,x\n2026-02-28T23:59:59.5Z,1\n2026-03-01T01:00:00+01:00,2\n", map);
  EXPECT_EQ(trace.time_s, (std::vector{0.0, 0.5}));
  EXPECT_EQ(Wrong("t,x\n2026-02-29 00:00:00,1\n", map),
            "t.csv:2:1: error: \"2026-02-29 00:00:00\" is not a time of the form iso8601 (correct "
            "`time.format` in the mapping)\n");
  EXPECT_EQ(
      Wrong("t,x\n", R"m("table": {"time": {"column": "t", "format": "hh:mm:ss", "unit": "s"}})m"),
      "m.json: error: table.time.unit has no effect with this format (remove it)\n");
}

// Expected values: `date -u -d TEXT +%s.%N`.
TEST_F(LogTable, FormsOfClocks) {
  using enum ClockFormat;
  EXPECT_EQ(ParseClock("2026-05-02T14:03:20.25Z", kIso8601), 1777730600.25);
  EXPECT_EQ(ParseClock("20260502T140320", kIso8601), std::nullopt);  // colons are needed
  EXPECT_EQ(ParseClock("2026-05-02 16:03:20,25+0200", kIso8601), 1777730600.25);
  EXPECT_EQ(ParseClock("2026-05-02T14:03", kIso8601), 1777730580.0);
  EXPECT_EQ(ParseClock("1969-12-31T23:59:59", kIso8601), -1.0);
  EXPECT_EQ(ParseClock("2.5.2026 14:03:20", kDayMonthYear), 1777730600.0);
  EXPECT_EQ(ParseClock("05/02/2026, 14:03:20", kMonthDayYear), 1777730600.0);
  EXPECT_EQ(ParseClock("13/02/2026 14:03:20", kMonthDayYear), std::nullopt);
  EXPECT_EQ(ParseClock("14:03:20.5", kTimeOfDay), 50600.5);
  EXPECT_EQ(ParseClock("9:03:20", kTimeOfDay), 32600.0);
  for (const char* wrong :
       {"", "14:03", "14:3:20", "25:00:00", "14:60:00", "14:03:61", "14:03:20.", "14:03:20x"}) {
    EXPECT_EQ(ParseClock(wrong, kTimeOfDay), std::nullopt) << wrong;
  }
}

TEST_F(LogTable, MappingsMayHaveComments) {
  const Trace trace = Good("t,X pos\n0,1\n",
                           R"m("table": {"time": {"column": "t"}}, // the clock
                               /* all else */ "channels": [{"from": "X pos", "to": "x_m"}])m");
  EXPECT_EQ(trace.channels[0].name, "x_m");
}

TEST_F(LogTable, CapitalAxes) {
  const Trace trace =
      Good("t,p X,p Y,p Z\n0,1,2,3\n",
           R"m("table": {"time": {"column": "t"}}, "axes": {"x": "z", "y": "x", "z": "y"},
                               "vectors": [{"from": "p {AXIS}", "to": "node/p/position_{axis}_m"}])m");
  ASSERT_TRUE(trace.Find("node/p/position_z_m"));
  EXPECT_EQ(trace.values[*trace.Find("node/p/position_z_m")][0], 2.0);
  EXPECT_EQ(trace.values[*trace.Find("node/p/position_x_m")][0], 3.0);
}

}  // namespace
}  // namespace taut::test
