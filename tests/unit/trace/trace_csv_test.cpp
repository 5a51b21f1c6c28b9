// CSV traces, compressed or not: cut off, damaged and wrong files
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

class CsvTrace : public TraceFolder {
 protected:
  std::string CsvComplaint(const std::string& content) const {
    return Complaint(WriteFile("t.csv", content));
  }
  /// Returns the gzip bytes of a text, by way of a file.
  static std::string Packed(const std::string& text, const std::string& path) {
    gzFile file = gzopen(path.c_str(), "wb1");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
    return ReadFile(path);
  }
};

TEST_F(CsvTrace, AGzippedCsvIsReadAsWellAsOneWithWindowsLineEnds) {
  const std::string text = "\xEF\xBB\xBFtime_s, a_n ,b\r\n0, 1 ,2\r\n1,3,4\r\n\r\n";
  gzFile file = gzopen(Path("t.csv.gz").c_str(), "wb");
  ASSERT_EQ(gzwrite(file, text.data(), static_cast<unsigned>(text.size())),
            static_cast<int>(text.size()));
  gzclose(file);
  WriteFile("t.csv", text);
  for (const std::string name : {"t.csv", "t.csv.gz"}) {
    Diagnostics out;
    const auto trace = ReadTrace(Path(name), out);
    ASSERT_TRUE(trace) << out.Format();
    ASSERT_EQ(trace->channels.size(), 2u);
    EXPECT_EQ(trace->channels[0].name, "a_n");
    EXPECT_EQ(trace->channels[0].unit, "N");
    EXPECT_EQ(trace->channels[1].unit, "1");
    EXPECT_EQ(trace->time_s, (std::vector<double>{0, 1}));
    EXPECT_EQ(trace->values[1], (std::vector<double>{2, 4}));
  }
}

TEST_F(CsvTrace, ACutOffCsvLosesOnlyTheRowThatIsNotWhole) {
  Diagnostics out;
  // the last number might have been 4 or 42
  const auto trace = ReadTrace(WriteFile("t.csv", "time_s,a\n0,1\n1,2\n2,4"), out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(trace->time_s, (std::vector<double>{0, 1}));
}

TEST_F(CsvTrace, ACutOffGzippedCsvIsAnErrorThatSaysWhere) {
  std::string text = "time_s,a\n";
  for (int i = 0; i < 20000; ++i) text += std::to_string(i) + "," + std::to_string(i * i) + "\n";
  const std::string path = Path("t.csv.gz"), whole = Packed(text, path);
  int last_line = 0;
  for (const std::size_t bytes : {whole.size() / 4, whole.size() / 2, whole.size() - 1}) {
    WriteFile("t.csv.gz", whole.substr(0, bytes));
    const std::string complaint = Complaint(path);
    const int line = std::atoi(complaint.c_str() + std::strlen("t.csv.gz:"));
    EXPECT_EQ(complaint, "t.csv.gz:" + std::to_string(line) +
                             ": error: the file is truncated after this line: its compressed data "
                             "is incomplete (save the readable part with `zcat` into a .csv)\n");
    EXPECT_GT(line, last_line);
    last_line = line;
  }
  EXPECT_EQ(last_line, 20001) << "all is there but gzip's own end, and so its checksum";
  for (std::size_t bytes = 0; bytes < 40; ++bytes) {
    Diagnostics out;
    EXPECT_FALSE(ReadTrace(WriteFile("t.csv.gz", whole.substr(0, bytes)), out)) << bytes;
  }
  std::string damaged = whole;
  damaged[damaged.size() - 6] ^= 0x55;  // in its checksum
  WriteFile("t.csv.gz", damaged);
  EXPECT_NE(
      Complaint(path).find(": error: the file is damaged after this line: incorrect data check ("),
      std::string::npos);
}

TEST_F(CsvTrace, AFewGzippedBytesDoNotBecomeGigabytes) {
  // Rows of 1 MiB of blanks; gzip files may be concatenated.
  const std::string path = Path("t.csv.gz");
  const std::string blanks = Packed(std::string(1 << 20, ' '), path), end = Packed("1\n", path);
  std::string file = Packed("time_s,a\n", path);
  for (int row = 0; row < 260; ++row) {
    file += Packed(std::to_string(row) + ",", path) + blanks + end;
    if (row != 250) continue;
    Diagnostics out;
    const auto trace = ReadTrace(WriteFile("t.csv.gz", file), out);
    ASSERT_TRUE(trace) << out.Format();
    EXPECT_EQ(trace->time_s.size(), 251u) << "still within the limit";
  }
  EXPECT_EQ(
      Complaint(WriteFile("t.csv.gz", file)),
      "t.csv.gz: error: the file unpacks to more than 256 MiB and more than 100 times its size (if "
      "this size is intended, unpack it with `gunzip` first)\n");
}

TEST_F(CsvTrace, DecimalCommasAreOneError) {
  EXPECT_EQ(CsvComplaint("time_s,a\n0,5,1,5\n0,75,2,5\n1,5,3,5\n"),
            "t.csv:2: error: the row has two values per column (2 columns): numbers have a decimal "
            "comma (write the table with decimal points)\n");
}

TEST_F(CsvTrace, CsvComplaintsNameTheLineAndComeAllAtOnce) {
  EXPECT_EQ(CsvComplaint("time_s,a,b\n0,1,2\n1,x,\n2,3\n1,5,6\nnan,5,6\n3,1e999,2\n4,1,2 3\n"),
            "t.csv:3:3: error: \"x\" is not a number\n"
            "t.csv:3:5: error: \"\" is not a number (write nan for a missing value)\n"
            "t.csv:4: error: the row has 2 values, but the header has 3 columns\n"
            "t.csv:6:1: error: the time nan is not after the time of the previous row (times must "
            "increase)\n"
            "t.csv:7:3: error: number \"1e999\" is out of range\n"
            "t.csv:8:5: error: \"2 3\" is not a number\n");
  EXPECT_EQ(CsvComplaint("time_s,a\n1,2\n1,3\n"),
            "t.csv:3:1: error: the time 1 is not after the time of the previous row (times must "
            "increase)\n");
  EXPECT_EQ(CsvComplaint("time_s,a\n0,1\n\n1,2\n"),
            "t.csv:3: error: there is an empty line between rows\n");
  EXPECT_EQ(CsvComplaint(""), "t.csv:1: error: the trace has no header line\n");
  EXPECT_EQ(CsvComplaint("t,a\n0,1\n"),
            "t.csv:1:1: error: the first column is \"t\" (expected time_s; for a log of another "
            "program, write a mapping with `taut new mapping` and pass it to `--map`)\n");
  EXPECT_EQ(CsvComplaint("time_s,a,a\n0,1,2\n"), "t.csv: error: channel name \"a\" occurs twice\n");
  EXPECT_EQ(CsvComplaint(std::string(9 << 20, '1')),
            "t.csv: error: the file is not CSV: it has no line end within 8 MB\n");
  std::string bad = "time_s,a\n";
  for (int i = 0; i < 100; ++i) bad += "0,x\n";
  const std::string complaint = CsvComplaint(bad);
  EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 20);
}

// A comparison divides the span of the times.
TEST_F(CsvTrace, TimesWhoseSpanIsInfiniteAreRefused) {
  EXPECT_EQ(CsvComplaint("time_s,a\n-1e308,1\n1e308,2\n"),
            "t.csv: error: the time -1e+308 s is out of range (expected at most 1e100 s)\n");
  EXPECT_EQ(CsvComplaint("time_s,a\n0,1\n1e101,2\n"),
            "t.csv: error: the time 1e+101 s is out of range (expected at most 1e100 s)\n");
  Diagnostics out;
  EXPECT_TRUE(ReadTrace(WriteFile("t.csv", "time_s,a\n-1e100,1\n1e100,2\n"), out));
}

}  // namespace
}  // namespace taut::test
