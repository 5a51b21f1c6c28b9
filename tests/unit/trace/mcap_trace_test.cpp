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

// Bags that this file writes, record by record.
std::string Bytes(std::uint64_t value, std::size_t size) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}
std::string Sized(const std::string& text) { return Bytes(text.size(), 4) + text; }
std::string Record(char kind, const std::string& content) {
  return kind + Bytes(content.size(), 8) + content;
}
std::string Schema(const std::string& name, const std::string& encoding, const std::string& text) {
  return Record(3, Bytes(1, 2) + Sized(name) + Sized(encoding) + Sized(text));
}
std::string Channel(int id, const std::string& topic, const std::string& encoding) {
  return Record(4, Bytes(static_cast<std::uint64_t>(id), 2) + Bytes(1, 2) + Sized(topic) +
                       Sized(encoding) + Bytes(0, 4));
}
std::string Message(int channel, std::uint64_t time_ns, const std::string& data) {
  return Record(5, Bytes(static_cast<std::uint64_t>(channel), 2) + Bytes(0, 4) + Bytes(time_ns, 8) +
                       Bytes(time_ns, 8) + data);
}
const std::string kMagic = "\x89MCAP0\r\n", kCdr("\0\1\0\0", 4);

TEST_F(McapTrace, TheTableOfAllTimesAndNumbersHasALimit) {
  // Each message has another number, so that the table has the square of their count.
  std::string bag = kMagic + Schema("s", "jsonschema", "{}") + Channel(1, "/a", "json");
  for (int i = 0; i < 10'001; ++i) {
    bag += Message(1, static_cast<std::uint64_t>(i), "{\"n" + std::to_string(i) + "\":1}");
  }
  Diagnostics out;
  EXPECT_FALSE(ReadTrace(WriteFile("wide.mcap", bag), out));
  EXPECT_NE(out.Format().find("the table of all message times and channels has more than "
                              "100 million values (take a shorter part of the bag"),
            std::string::npos)
      << out.Format();
}

TEST_F(McapTrace, NamesHaveALimit) {
  const std::string name(1001, 'n');
  const std::string long_key =
      kMagic + Schema("s", "jsonschema", "{}") + Channel(1, "/a", "json") +
      Message(1, 0, "{\"" + std::string(1'000'000, 'k') + "\":{\"a\":1,\"b\":2}}");
  const std::string long_topic =
      kMagic + Schema("s", "jsonschema", "{}") + Channel(1, "/" + name, "json");
  for (const auto& [bag, what] :
       {std::pair(long_key, "the name of a channel has more than 1000 bytes"),
        std::pair(long_topic, "the name of a topic has more than 1000 bytes")}) {
    Diagnostics out;
    EXPECT_FALSE(ReadTrace(WriteFile("names.mcap", bag), out));
    EXPECT_NE(out.Format().find(what), std::string::npos) << out.Format().substr(0, 300);
  }
  std::string why;
  EXPECT_FALSE(trace::Ros2Message::Parse("a/A", "float64 " + name + "\n", why));
  EXPECT_EQ(why, "a name of its definition has more than 1000 bytes");
}

TEST_F(McapTrace, ChannelsShareTheTextOfTheirSchema) {
  // A copy for each channel would take 40 GB, and its parsing minutes.
  std::string bag = kMagic + Schema("a/A", "ros2msg", "float64 x\n#" + std::string(1'000'000, 'y'));
  const std::string one_number = kCdr + Bytes(0, 8);
  for (int i = 1; i <= 40'000; ++i) {
    bag += Channel(i, "/t" + std::to_string(i), "cdr");
    if (i <= 1000) bag += Message(i, 0, one_number) + Message(i, 1'000'000, one_number);
  }
  Diagnostics out;
  const auto trace = ReadTrace(WriteFile("channels.mcap", bag), out);
  ASSERT_TRUE(trace) << out.Format();
  EXPECT_EQ(trace->channels.size(), 1000u);
}

TEST_F(McapTrace, MessagesOfTypesWithoutFieldsEnd) {
  // Nested lists of a type without fields have 1000^14 elements, and nested fields 10^14.
  std::string lists = "T1 f\n", fields = lists;
  for (int k = 1; k < 15; ++k) {
    const std::string next = "T" + std::to_string(k + 1);
    lists += "MSG: a/T" + std::to_string(k) + "\n" + next + "[1000] f\n";
    fields += "MSG: a/T" + std::to_string(k) + "\n";
    for (int j = 0; j < 10; ++j) fields += next + " f" + std::to_string(j) + "\n";
  }
  for (const std::string& definition : {lists, fields}) {
    std::string why;
    const auto type = trace::Ros2Message::Parse("a/T0", definition + "MSG: a/T15\n", why);
    ASSERT_TRUE(type) << why;
    EXPECT_FALSE(type->Decode(kCdr + std::string(2000, '\0'), [](const std::string&, double) {}));
  }
}

}  // namespace
}  // namespace taut::test
