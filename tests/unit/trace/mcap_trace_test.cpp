// Traces from MCAP files. tests/data/logs/rosbag.mcap was written by the Python packages mcap and
// mcap-ros2-support.
#include <cmath>

#include "tests/unit/trace/trace_fixture.h"
#include "trace/ros2_message.h"

namespace taut::test {
namespace {

class McapTrace : public TraceFolder {
 protected:
  static std::string Bag(const std::string& name) {
    return std::string(TAUT_SOURCE_DIR) + "/tests/data/logs/" + name;
  }
};

TEST_F(McapTrace, MessagesOfRos2BecomeChannels) {
  Diagnostics out;
  const auto trace = ReadTrace(Bag("rosbag.mcap"), out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(out.Format(), "");
  EXPECT_FALSE(trace->unfinished);
  ASSERT_EQ(trace->time_s.size(), 22u);
  EXPECT_EQ(trace->time_s[0], 0.0);
  EXPECT_DOUBLE_EQ(trace->time_s[1], 0.001);
  const auto value = [&](const std::string& name, std::size_t row) {
    const auto at = trace->Find(name);
    EXPECT_TRUE(at) << name;
    return at ? trace->values[*at][row] : NAN;
  };
  EXPECT_EQ(value("cables/states/effort/a1-c1", 2), 9.3);
  EXPECT_EQ(value("tf/transforms/strut/transform/translation/z", 3), 0.3 - 0.004);
  EXPECT_EQ(value("rig/cell/data", 4), 1.0);    // float32
  EXPECT_EQ(value("rig/cell/count", 4), -2.0);  // int16
  EXPECT_EQ(value("rig/cell/ok", 4), 1.0);
  EXPECT_EQ(value("rig/cell/data", 2), 0.5);  // between 0 and 1, whose messages are in rows 0 and 4
  EXPECT_TRUE(std::isnan(value("tf/transforms/strut/transform/translation/z", 0)));
  EXPECT_NEAR(value("cables/states/effort/a1-c1", 3), 9.3 + 0.05 / 20, 1e-12);
  EXPECT_EQ(trace->channels.size(), 2u + 7u + 3u);
}

TEST_F(McapTrace, CompressionIsNamedWithItsRemedy) {
  Diagnostics out;
  EXPECT_FALSE(ReadTrace(Bag("rosbag_zstd.mcap"), out));
  EXPECT_NE(
      out.Format().find("the file is compressed with zstd (write it again with `mcap compress "
                        "IN.mcap -o OUT.mcap --compression none`)"),
      std::string::npos)
      << out.Format();
}

TEST_F(McapTrace, EveryCutIsReadOrRefused) {
  const std::string whole = ReadFile(Bag("rosbag.mcap"));
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    Diagnostics out;
    const auto trace = ReadTrace(WriteFile("cut.mcap", whole.substr(0, size)), out);
    EXPECT_NE(trace.has_value(), !out.ok()) << size;
  }
}

TEST_F(McapTrace, EveryDamagedByteIsReadOrRefused) {
  const std::string whole = ReadFile(Bag("rosbag.mcap"));
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0xFF : 0x10));
    Diagnostics out;
    const auto trace = ReadTrace(WriteFile("damaged.mcap", bytes), out);
    EXPECT_NE(trace.has_value(), !out.ok()) << at;
  }
}

TEST_F(McapTrace, DefinitionsAreParsed) {
  std::string why;
  const auto parsed = trace::Ros2Message::Parse(
      "a_msgs/msg/A",
      "# a comment\nint32 LIMIT=3\nuint8 X = 1\nbool[<=2] flags\nfloat32[3] three # more\n"
      "string<=10 text\nB b 0\n====\nMSG: a_msgs/B\nint64 big\n",
      why);
  ASSERT_TRUE(parsed) << why;
  // little endian: 1 flag, padding, three floats, the text "hi", padding, -5
  std::string cdr("\0\1\0\0", 4);
  cdr += std::string(
      "\1\0\0\0"
      "\1"
      "\0\0\0",
      8);
  for (const float x : {1.5F, -2.0F, 0.25F}) cdr.append(reinterpret_cast<const char*>(&x), 4);
  cdr += std::string(
      "\3\0\0\0"
      "hi\0"
      "\0"
      "\0\0\0\0",
      12);
  const std::int64_t big = -5;
  cdr.append(reinterpret_cast<const char*>(&big), 8);
  std::string seen;
  EXPECT_TRUE(parsed->Decode(cdr, [&](const std::string& path, double value) {
    seen += path + "=" + std::to_string(value) + " ";
  }));
  EXPECT_EQ(seen, "three/0=1.500000 three/1=-2.000000 three/2=0.250000 b/big=-5.000000 ");
  EXPECT_FALSE(parsed->Decode(cdr.substr(0, cdr.size() - 1), [](const std::string&, double) {}));
  EXPECT_FALSE(trace::Ros2Message::Parse("a_msgs/msg/A", "b_msgs/C c\n", why));
  EXPECT_EQ(why, "the type b_msgs/C has no definition");
}

}  // namespace
}  // namespace taut::test
