// Traces written to a file and read back, and the errors of invalid ones
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/constants.h"
#include "tests/unit/trace/trace_fixture.h"
#include "trace/channel_names.h"

namespace taut::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Bitwise, so that NaN equals NaN and 0 differs from -0
bool SameBits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

using TraceTest = TraceFolder;

// Names deliberately neither in alphabetic order nor grouped: the order of columns is kept.
const std::vector<ChannelInfo> kChannels = {{"cable/b/tension_n", "N"},
                                            {"body/s/position_x_m", "m"},
                                            {"cable/a/rate_m_per_s", "m/s"},
                                            {"system/contact_count", "1"}};
const std::vector<double> kTimes = {0.0, 0.1, 0.30000000000000004, 1e9};
const std::vector<std::vector<double>> kRows = {{1.0 / 3.0, -0.0, 5e-324, 1.7976931348623157e308},
                                                {kNan, kInfinity, -kInfinity, 3.0},
                                                {0.1, 0.2, 1e-300, 123456789.125},
                                                {1e22, 1e23, 9007199254740993.0, -1.5}};

void ExpectAll(const Trace& trace) {
  ASSERT_EQ(trace.channels.size(), kChannels.size());
  EXPECT_TRUE(SameBits(trace.time_s, kTimes));
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    EXPECT_EQ(trace.channels[i].name, kChannels[i].name);
    EXPECT_EQ(trace.channels[i].unit, kChannels[i].unit);
    std::vector<double> column;
    for (const auto& row : kRows) column.push_back(row[i]);
    EXPECT_TRUE(SameBits(trace.values[i], column)) << kChannels[i].name;
    EXPECT_EQ(trace.Find(kChannels[i].name), i);
  }
  EXPECT_EQ(trace.Find("cable/none/tension_n"), std::nullopt);
}

TEST_F(TraceTest, Hdf5KeepsEveryBitTheOrderTheUnitsAndTheMetadata) {
  const TraceMetadata metadata = {{"taut_version", "0.1.0"},
                                  {"seed", "0"},
                                  {"empty", ""},
                                  {"big", std::string(200000, 'x')},
                                  {"a b/ü", "text\nof two"}};
  Diagnostics out;
  auto writer = CreateHdf5Trace(Path("t.h5"), kChannels, metadata, out);
  ASSERT_TRUE(writer) << out.Format();
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    ASSERT_TRUE(writer->Append(kTimes[i], kRows[i].data()));
  }
  ASSERT_TRUE(writer->Finish()) << writer->error();
  EXPECT_TRUE(writer->Finish()) << "twice is allowed";
  const auto trace = ReadTrace(Path("t.h5"), out);
  ASSERT_TRUE(trace) << out.Format();
  ExpectAll(*trace);
  EXPECT_EQ(trace->metadata, metadata);
  EXPECT_FALSE(trace->unfinished);
  EXPECT_EQ(Names(), std::vector<std::string>{"t.h5"});
}

TEST_F(TraceTest, CsvKeepsEveryBitOfFiniteNumbers) {
  Diagnostics out;
  auto writer = CreateCsvTrace(Path("t.csv"), kChannels, out);
  ASSERT_TRUE(writer) << out.Format();
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    ASSERT_TRUE(writer->Append(kTimes[i], kRows[i].data()));
  }
  ASSERT_TRUE(writer->Finish()) << writer->error();
  const auto trace = ReadTrace(Path("t.csv"), out);
  ASSERT_TRUE(trace) << out.Format();
  ExpectAll(*trace);
  EXPECT_TRUE(trace->metadata.empty());
  EXPECT_EQ(ReadFile(Path("t.csv")).substr(0, 142),
            "time_s,cable/b/tension_n,body/s/position_x_m,cable/a/rate_m_per_s,system/contact_count"
            "\n0,0.3333333333333333,-0,5e-324,1.7976931348623157e+308\n")
      << "shortest digits";
}

TEST_F(TraceTest, ManyRowsAcrossChunksAndAFileWithoutRowsAreKept) {
  for (const std::string name : {"t.h5", "t.csv"}) {
    for (const std::size_t rows : {0, 1, 1023, 1024, 1025, 5000}) {
      Diagnostics out;
      auto writer = name == "t.h5" ? CreateHdf5Trace(Path(name), Channels(3), {}, out)
                                   : CreateCsvTrace(Path(name), Channels(3), out);
      ASSERT_TRUE(writer) << out.Format();
      for (std::size_t row = 0; row < rows; ++row) {
        ASSERT_TRUE(AppendRow(*writer, row, 3, 0.001 * static_cast<double>(row)));
      }
      if (rows == 0) {
        ASSERT_TRUE(writer->Finish());
      }
      writer.reset();  // also finishes traces with rows
      const auto trace = ReadTrace(Path(name), out);
      ASSERT_TRUE(trace) << out.Format();
      EXPECT_EQ(trace->time_s.size(), rows);
      ExpectPattern(*trace, 3);
    }
  }
}

TEST_F(TraceTest, AFileThatCannotBeOpenedSaysWhy) {
  EXPECT_EQ(Complaint(Path("none.h5")), "none.h5: error: cannot open: No such file or directory\n");
  EXPECT_EQ(
      Complaint(WriteFile("t.txt", "time_s\n")),
      "t.txt: error: unknown trace format (expected .h5, .csv, .csv.gz or .mcap; for a log "
      "of another program, write a mapping with `taut new mapping` and pass it to `--map`)\n");
  std::filesystem::create_directory(Path("folder.h5"));
  EXPECT_EQ(Complaint(Path("folder.h5")), "folder.h5: error: the trace is not a regular file\n");
  EXPECT_EQ(Complaint(WriteFile("t.h5", "time_s,a\n")),
            "t.h5: error: the file is not HDF5 or is damaged: file signature not found\n");
}

TEST_F(TraceTest, NamesThatAFileCannotHoldAreErrors) {
  const std::vector<ChannelInfo> bad = {{"a", "1"},      {"a", "1"},    {"", "1"},
                                        {"time_s", "s"}, {"b//c", "1"}, {"d,e", "1"},
                                        {"a/b", "1"},    {"./x", "1"},  {"time_s/x", "1"}};
  const std::string expected =
      "channel name \"\" has an empty part or a single dot between slashes\n"
      "channel name \"./x\" has an empty part or a single dot between slashes\n"
      "channel name \"a\" occurs twice\n"
      "channel name \"a/b\" continues the name of another channel after a slash\n"
      "channel name \"b//c\" has an empty part or a single dot between slashes\n"
      "channel name \"d,e\" contains a comma, a quote or a control character\n"
      "channel name \"time_s\" is reserved for the clock of the trace\n"
      "channel name \"time_s/x\" continues the name of another channel after a slash\n";
  const auto message = [&](Diagnostics& out) {
    std::string text = WithoutFolder(out.Format());
    for (const std::string head : {"t.h5: error: ", "t.csv: error: "}) {
      for (std::size_t at; (at = text.find(head)) != text.npos;) text.erase(at, head.size());
    }
    return text;
  };
  Diagnostics h5, csv;
  EXPECT_FALSE(CreateHdf5Trace(Path("t.h5"), bad, {}, h5));
  EXPECT_EQ(message(h5), expected);
  EXPECT_FALSE(CreateCsvTrace(Path("t.csv"), bad, csv));
  EXPECT_EQ(message(csv), expected);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(TraceTest, MetadataKeysAreDistinctAndNotReserved) {
  for (const TraceMetadata& metadata :
       {TraceMetadata{{"format", "x"}}, TraceMetadata{{"format_version", "x"}},
        TraceMetadata{{"", "x"}}, TraceMetadata{{"a", "x"}, {"a", "x"}}}) {
    Diagnostics out;
    EXPECT_FALSE(CreateHdf5Trace(Path("t.h5"), {}, metadata, out));
    EXPECT_EQ(WithoutFolder(out.Format()), "t.h5: error: metadata key \"" + metadata.back().first +
                                               "\" is empty, reserved or occurs twice\n");
  }
}

TEST_F(TraceTest, ANewTraceReplacesTheOldOneOnlyWhenItIsOne) {
  Diagnostics out;
  auto writer = CreateHdf5Trace(Path("t.h5"), Channels(1), {}, out);
  ASSERT_TRUE(writer && AppendRow(*writer, 0, 1, 0.0) && writer->Finish());
  EXPECT_FALSE(CreateHdf5Trace(Path("t.h5"), {{"a", "1"}, {"a", "1"}}, {}, out));
  Diagnostics reading;
  ASSERT_TRUE(ReadTrace(Path("t.h5"), reading));
  writer = CreateHdf5Trace(Path("t.h5"), Channels(2), {}, out);
  ASSERT_TRUE(writer && writer->Finish());
  EXPECT_EQ(ReadTrace(Path("t.h5"), reading)->channels.size(), 2u);
}

TEST_F(TraceTest, TheOldOneStaysUntilTheFirstRowWhichIsThereAtOnce) {
  for (const std::string name : {"t.h5", "t.csv"}) {
    const auto create = [&](int channel_count, Diagnostics& out) {
      return name == "t.h5" ? CreateHdf5Trace(Path(name), Channels(channel_count), {}, out)
                            : CreateCsvTrace(Path(name), Channels(channel_count), out);
    };
    Diagnostics out;
    auto writer = create(1, out);
    ASSERT_TRUE(writer && AppendRow(*writer, 0, 1, 0.0) && writer->Finish());
    create(2, out).reset();  // never had a row
    writer = create(3, out);
    ASSERT_TRUE(writer) << out.Format();
    auto trace = ReadTrace(Path(name), out);
    ASSERT_TRUE(trace) << out.Format();
    EXPECT_EQ(trace->channels.size(), 1u);
    ASSERT_TRUE(AppendRow(*writer, 0, 3, 0.0));
    trace = ReadTrace(Path(name), out);
    ASSERT_TRUE(trace) << out.Format();
    EXPECT_EQ(trace->channels.size(), 3u);
    EXPECT_EQ(trace->time_s.size(), 1u);
    EXPECT_EQ(Names(), std::vector<std::string>{name});
    writer.reset();
    std::filesystem::remove(Path(name));
  }
}

TEST_F(TraceTest, ALinkInItsPlaceIsReplacedAndNotFollowed) {
  for (const std::string name : {"t.h5", "t.csv"}) {
    WriteFile("victim", "untouched");
    std::filesystem::create_symlink("victim", Path(name));
    Diagnostics out;
    const auto writer = name == "t.h5" ? CreateHdf5Trace(Path(name), Channels(1), {}, out)
                                       : CreateCsvTrace(Path(name), Channels(1), out);
    ASSERT_TRUE(writer && AppendRow(*writer, 0, 1, 0.0) && writer->Finish()) << out.Format();
    EXPECT_EQ(ReadFile(Path("victim")), "untouched");
    EXPECT_FALSE(std::filesystem::is_symlink(Path(name)));
  }
}

TEST_F(TraceTest, AProcessMayReadWhatItIsStillWriting) {
  for (const std::string name : {"t.h5", "t.csv"}) {
    Diagnostics out;
    auto writer = name == "t.h5" ? CreateHdf5Trace(Path(name), Channels(2), {}, out)
                                 : CreateCsvTrace(Path(name), Channels(2), out);
    ASSERT_TRUE(writer) << out.Format();
    std::size_t row = 0;
    for (; row < 30000; ++row) {
      ASSERT_TRUE(AppendRow(*writer, row, 2, static_cast<double>(row)));
      if (row % 10000 != 0) continue;
      const auto trace = ReadTrace(Path(name), out);
      ASSERT_TRUE(trace) << out.Format();
      EXPECT_LE(trace->time_s.size(), row + 1);
      EXPECT_GE(trace->time_s.size() + 9000, row) << "whole blocks are there";
      ExpectPattern(*trace, 2);
    }
    ASSERT_TRUE(writer->Finish()) << writer->error();
    const auto trace = ReadTrace(Path(name), out);
    ASSERT_TRUE(trace) << out.Format();
    EXPECT_EQ(trace->time_s.size(), row);
    ExpectPattern(*trace, 2);
  }
}

TEST_F(TraceTest, WritingAfterTheEndIsAnError) {
  Diagnostics out;
  auto h5 = CreateHdf5Trace(Path("t.h5"), Channels(1), {}, out);
  auto csv = CreateCsvTrace(Path("t.csv"), Channels(1), out);
  for (TraceWriter* writer : {h5.get(), csv.get()}) {
    ASSERT_TRUE(writer->Finish());
    EXPECT_FALSE(AppendRow(*writer, 0, 1, 0.0));
    EXPECT_NE(writer->error().find("cannot write: the trace was already finished"),
              std::string::npos);
  }
}

TEST(ChannelNames, EndWithTheUnit) {
  for (const auto& [name, unit] : std::vector<std::pair<std::string, std::string>>{
           {"cable/a/tension_n", "N"},
           {"cable/a/length_m", "m"},
           {"cable/a/rate_m_per_s", "m/s"},
           {"body/a/angular_velocity_x_rad_per_s", "rad/s"},
           {"system/kinetic_j", "J"},
           {"body/a/orientation_w", "1"},
           {"system/contact_count", "1"},
           {"a_m_per_s2", "m/s^2"},
           {"k_n_per_m", "N/m"},
           {"b_n_s_per_m", "N s/m"},
           {"torque_n_m", "N m"},
           {"angle_rad", "rad"},
           {"rate_hz", "Hz"},
           {"mass_kg", "kg"},
           {"age_s", "s"},
           {"mass_kg_per_m", "kg/m"},
           {"density_kg_per_m3", "kg/m^3"},
           {"inertia_kg_m2", "kg m^2"},
           {"gain_rad_per_n_s", "rad/(N s)"},
           {"body/a_n/turns_per_s", "1"},
           {"mass_lb_per_m", "1"},
           {"steps_per_", "1"},
           {"m", "1"},
           {"", "1"}}) {
    EXPECT_EQ(UnitOfName(name), unit) << name;
  }
}

}  // namespace
}  // namespace taut::test
