// Mapping files: names, units and axes of other programs
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "taut/compare.h"
#include "tests/unit/trace/trace_fixture.h"

namespace taut::test {
namespace {

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w, x, y, z

Quaternion Product(const Quaternion& p, const Quaternion& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

Vector Turned(const Quaternion& q, const Vector& v) {
  const Quaternion turned = Product(Product(q, {0, v[0], v[1], v[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {turned[1], turned[2], turned[3]};
}

class MappingTest : public TraceFolder {
 protected:
  std::string Complaint(const std::string& json) {
    Diagnostics out;
    EXPECT_FALSE(LoadMapping(WriteFile("m.json", json), out));
    std::string text = out.Format();
    const std::string head = Path("m.json") + ": error: ";
    for (std::size_t at; (at = text.find(head)) != text.npos;) text.erase(at, head.size());
    return text;
  }

  std::optional<Trace> Mapped(const std::string& map_path, const Trace& trace) {
    Diagnostics out;
    const auto mapping = LoadMapping(map_path, out);
    EXPECT_TRUE(mapping) << out.Format();
    if (!mapping) return std::nullopt;
    auto mapped = ApplyMapping(*mapping, trace, "t.csv", out);
    EXPECT_TRUE(mapped) << out.Format();
    return mapped;
  }

  /// Returns a trace of one row.
  static Trace Row(const std::vector<std::pair<std::string, double>>& values) {
    Trace trace;
    trace.time_s = {0.0};
    for (const auto& [name, value] : values) {
      trace.channels.push_back({name, "1"});
      trace.values.push_back({value});
    }
    return trace;
  }

  static double At(const Trace& trace, const std::string& name) {
    const auto channel = trace.Find(name);
    EXPECT_TRUE(channel) << name;
    return channel ? trace.values[*channel].at(0) : std::nan("");
  }

  static Quaternion Orientation(const Trace& trace, const std::string& body) {
    Quaternion q;
    for (std::size_t i = 0; i < 4; ++i) {
      q[i] = At(trace, "body/" + body + "/orientation_" + "wxyz"[i]);
    }
    return q;
  }
};

const std::string kNtrt = TAUT_SOURCE_DIR "/share/mappings/ntrt.json";

TEST_F(MappingTest, NtrtNamesBecomeOurs) {
  const auto trace = Mapped(kNtrt, Row({{"outer_top_1_tension_N", 1},
                                        {"outer_top_1_rest_length_m", 2},
                                        {"outer_top_1_length_m", 3},
                                        {"outer_top_1_damping_N", 4},
                                        {"outer_top_1_setpoint_N", 5},
                                        {"push_force_N", 6},
                                        {"contact_points", 7},
                                        {"outer_top_1_cpg_m_s", 8}}));
  ASSERT_TRUE(trace);
  EXPECT_EQ(At(*trace, "cable/outer_top_1/elastic_n"), 1);
  EXPECT_EQ(At(*trace, "cable/outer_top_1/rest_length_m"), 2);
  EXPECT_EQ(At(*trace, "cable/outer_top_1/length_m"), 3);
  EXPECT_EQ(At(*trace, "cable/outer_top_1/damping_n"), 4);
  EXPECT_EQ(At(*trace, "cable/outer_top_1/setpoint_n"), 5);
  EXPECT_EQ(At(*trace, "push/push/force_n"), 6);
  EXPECT_EQ(At(*trace, "system/contact_count"), 7);
  EXPECT_EQ(At(*trace, "outer_top_1_cpg_m_s"), 8) << "what no rule fits stays";
  EXPECT_EQ(trace->channels[0].unit, "N");
  EXPECT_EQ(trace->channels[1].unit, "m");
  EXPECT_EQ(trace->channels[6].unit, "1");
}

TEST_F(MappingTest, NtrtPositionsAreTurnedAndStandOnOurFloor) {
  const auto trace =
      Mapped(kNtrt, Row({{"segment_0_x_m", 1}, {"segment_0_y_m", 2.015}, {"segment_0_z_m", 3}}));
  ASSERT_TRUE(trace);
  EXPECT_EQ(At(*trace, "body/segment_0/position_x_m"), 3) << "forward is NTRT's z";
  EXPECT_EQ(At(*trace, "body/segment_0/position_y_m"), 1) << "left is NTRT's x";
  EXPECT_NEAR(At(*trace, "body/segment_0/position_z_m"), 2, 1e-15) << "up is NTRT's y";
}

TEST_F(MappingTest, NtrtRotationsAreTheSameRotationsInOurAxes) {
  const double half = std::sqrt(0.5);
  // NTRT: 90 degrees about y, its up axis. Here: 90 degrees about z; forward becomes left.
  auto trace = Mapped(kNtrt, Row({{"s_qx", 0}, {"s_qy", half}, {"s_qz", 0}, {"s_qw", half}}));
  ASSERT_TRUE(trace);
  EXPECT_EQ(Orientation(*trace, "s"), (Quaternion{half, 0, 0, half}));
  const Vector left = Turned(Orientation(*trace, "s"), {1, 0, 0});
  EXPECT_NEAR(left[1], 1.0, 1e-15);

  // Any rotation: rotating and then changing axes equals changing axes and then rotating.
  const Quaternion q{0.5, -0.1, 0.7, std::sqrt(1 - 0.25 - 0.01 - 0.49)};
  const Vector v{0.3, -1.2, 2.5}, turned = Turned(q, v);
  trace = Mapped(kNtrt, Row({{"s_qw", q[0]}, {"s_qx", q[1]}, {"s_qy", q[2]}, {"s_qz", q[3]}}));
  ASSERT_TRUE(trace);
  const Vector ours = Turned(Orientation(*trace, "s"), {v[2], v[0], v[1]});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(ours[i], turned[(i + 2) % 3], 1e-14);
}

TEST_F(MappingTest, AxesMayPointTheOtherWay) {
  // x forward, y right, z down (aircraft axes), in feet
  const std::string path = WriteFile("m.json", R"({"version": 1,
    "axes": {"x": "x", "y": "-y", "z": "-z"},
    "vectors": [{"from": "p{axis}", "to": "body/s/position_{axis}_m", "scale": 0.3048,
                 "offset": [1, 2, 3]}],
    "quaternions": [{"from": "q{axis}", "to": "body/s/orientation_{axis}"}]})");
  const Quaternion q{0.5, -0.1, 0.7, std::sqrt(1 - 0.25 - 0.01 - 0.49)};
  const auto trace = Mapped(path, Row({{"px", 1},
                                       {"py", 10},
                                       {"pz", 100},
                                       {"qw", q[0]},
                                       {"qx", q[1]},
                                       {"qy", q[2]},
                                       {"qz", q[3]}}));
  ASSERT_TRUE(trace);
  EXPECT_DOUBLE_EQ(At(*trace, "body/s/position_x_m"), 1.3048);
  EXPECT_DOUBLE_EQ(At(*trace, "body/s/position_y_m"), 2 - 3.048);
  EXPECT_DOUBLE_EQ(At(*trace, "body/s/position_z_m"), 3 - 30.48);
  const Vector v{0.3, -1.2, 2.5}, turned = Turned(q, v);
  const Vector ours = Turned(Orientation(*trace, "s"), {v[0], -v[1], -v[2]});
  EXPECT_NEAR(ours[0], turned[0], 1e-14);
  EXPECT_NEAR(ours[1], -turned[1], 1e-14);
  EXPECT_NEAR(ours[2], -turned[2], 1e-14);
}

TEST_F(MappingTest, UnitsAreScaledAndTheFirstRuleThatFitsCounts) {
  const std::string path = WriteFile("m.json", R"({"version": 1, "channels": [
    {"from": "t1_lbf", "to": "special", "unit": "lbf"},
    {"from": "*_lbf", "to": "cable/*/tension_n", "scale": 4.4482216152605, "offset": -1}]})");
  const auto trace = Mapped(path, Row({{"t1_lbf", 2}, {"t2_lbf", 10}}));
  ASSERT_TRUE(trace);
  EXPECT_EQ(At(*trace, "special"), 2);
  EXPECT_EQ(trace->channels[0].unit, "lbf");
  EXPECT_DOUBLE_EQ(At(*trace, "cable/t2/tension_n"), 43.482216152605);
  EXPECT_EQ(trace->channels[1].unit, "N") << "as the name says";
}

TEST_F(MappingTest, WrapIsThePeriodOfTheResult) {
  const auto trace = Mapped(WriteFile("m.json", R"({"version": 1, "channels": [
      {"from": "yaw", "to": "a_rad", "from_unit": "deg", "wrap": "turn"},
      {"from": "heading", "to": "b_rad", "from_unit": "deg", "wrap": 360},
      {"from": "drum", "to": "c_m", "scale": -0.5, "wrap": 4096},
      {"from": "x", "to": "d_rad"}]})"),
                            Row({{"yaw", 90}, {"heading", 90}, {"drum", 1}, {"x", 1}}));
  ASSERT_TRUE(trace);
  EXPECT_EQ(trace->channels[0].period, 2 * std::acos(-1.0));
  EXPECT_NEAR(trace->channels[1].period, 2 * std::acos(-1.0), 1e-15);
  EXPECT_EQ(trace->channels[2].period, 2048);
  EXPECT_EQ(trace->channels[3].period, 0);
}

TEST_F(MappingTest, WrapIsATurnOfAnAngleOrANumberAbove0) {
  EXPECT_EQ(Complaint(R"({"version": 1, "channels": [
              {"from": "a", "to": "a_m", "wrap": "turn"}, {"from": "b", "to": "b_rad", "wrap": 0},
              {"from": "c", "to": "c_rad", "wrap": "360"},
              {"from": "d", "to": "d", "unit": "rad", "wrap": true}]})"),
            "channels[0].wrap is \"turn\", but the result is in m, not in rad\n"
            "channels[1].wrap must be \"turn\", or the period of the file's values, a number above "
            "0\n"
            "channels[2].wrap must be \"turn\", or the period of the file's values, a number above "
            "0\n"
            "channels[3].wrap must be \"turn\", or the period of the file's values, a number above "
            "0\n");
}

TEST_F(MappingTest, TwoChannelsMayNotBecomeOne) {
  Diagnostics out;
  const auto mapping = LoadMapping(
      WriteFile("m.json", R"({"version": 1, "channels": [{"from": "*_N", "to": "f"}]})"), out);
  EXPECT_FALSE(mapping) << "a `*` on one side only";
  const auto good = LoadMapping(
      WriteFile("m.json", R"({"version": 1, "channels": [{"from": "a", "to": "b"}]})"), out = {});
  ASSERT_TRUE(good) << out.Format();
  EXPECT_FALSE(ApplyMapping(*good, Row({{"a", 1}, {"b", 2}}), "t.csv", out));
  EXPECT_EQ(out.Format(), "t.csv: error: the mapping creates the channel b twice\n");
}

TEST_F(MappingTest, AFileOfMoreThan10MbIsRefused) {
  Diagnostics out;
  const std::string path = WriteFile("m.json", "{}");
  std::filesystem::resize_file(path, 10'000'001);
  EXPECT_FALSE(LoadMapping(path, out));
  EXPECT_EQ(WithoutFolder(out.Format()),
            "m.json: error: the file is larger than 10 MB (expected a mapping)\n");
}

TEST_F(MappingTest, ComplaintsNameTheKeyAndComeAllAtOnce) {
  EXPECT_EQ(Complaint(R"({"version": 1, "chanels": [], "vectors": {}, "description": 3})"),
            "chanels is not a known key (did you mean \"channels\"?)\n"
            "description must be a string\n"
            "vectors must be a list [ ... ]\n");
  EXPECT_EQ(Complaint(R"({"version": 2})"),
            "version must be 1, the version of mapping files that this taut reads\n");
  EXPECT_EQ(Complaint("[]"), "the mapping must be an object { ... }\n");
  EXPECT_EQ(Complaint(R"({"version": 1, "channels": [
              {"from": "*a*", "to": "*b", "scale": "2", "ofset": 1}, 3, {"from": ""}]})"),
            "channels[0].from has more than one `*`\n"
            "channels[0].ofset is not a known key (did you mean \"offset\"?)\n"
            "channels[0].scale must be a number\n"
            "channels[1] must be an object { ... }\n"
            "channels[2].from must be a string\n"
            "channels[2].to is missing\n");
  EXPECT_EQ(Complaint(R"({"version": 1, "version": 1})"),
            "key \"version\" occurs twice in one object\n");
  const std::string syntax = Complaint("{\"version\": 1,\n x}");
  EXPECT_EQ(syntax.substr(0, 55), "the mapping is not JSON: parse error at line 2, column ")
      << syntax;
  Diagnostics out;
  EXPECT_FALSE(LoadMapping(Path("none.json"), out));
  EXPECT_EQ(out.Format(), Path("none.json") + ": error: cannot open: No such file or directory\n");
  Diagnostics folder;
  EXPECT_FALSE(LoadMapping(TAUT_SOURCE_DIR, folder));
  EXPECT_EQ(folder.Format(), TAUT_SOURCE_DIR ": error: the path is a directory, not a file\n");
  EXPECT_EQ(Complaint(R"({"version": 1, "channels": [{"from": "a", "to": "\u001b[2J"}]})"),
            "channels[0].to contains a control character\n");
}

TEST_F(MappingTest, AxesMustBeARotation) {
  const auto axes = [&](const std::string& x, const std::string& y, const std::string& z) {
    return Complaint(R"({"version": 1, "axes": {"x": ")" + x + R"(", "y": ")" + y + R"(", "z": ")" +
                     z + R"("}})");
  };
  EXPECT_EQ(axes("x", "z", "y"), "axes must be a rotation, not a reflection\n");
  EXPECT_EQ(axes("x", "x", "y"), "axes uses an axis twice\n");
  EXPECT_EQ(axes("x", "u", "y"), "axes.y must be one of x, y, z, -x, -y, -z\n");
  EXPECT_EQ(Complaint(R"({"version": 1, "axes": {"x": "y"}})"),
            "axes.y is missing\naxes.y must be one of x, y, z, -x, -y, -z\n");
  EXPECT_EQ(Complaint(R"({"version": 1, "axes": 3})"), "axes must be an object { ... }\n");
}

TEST_F(MappingTest, VectorsNeedAnAxisInEveryName) {
  EXPECT_EQ(Complaint(R"({"version": 1, "vectors": [
              {"from": "p{axis}{axis}", "to": "q", "offset": [1, 2]}],
              "quaternions": [{"from": "*q{axis}", "to": "o{axis}"}]})"),
            "quaternions[0] has a `*` in only one of \"from\" and \"to\"\n"
            "vectors[0].from must contain {axis} once, in the place of x, y and z\n"
            "vectors[0].offset must be a list of three numbers, along taut's x, y and z\n"
            "vectors[0].to must contain {axis} once, in the place of x, y and z\n");
}

/// Returns NTRT's traces, which are next to the checkout or in TAUT_REFERENCE; taut may not
/// redistribute them.
std::vector<std::string> ReferenceTraces() {
  const char* given = std::getenv("TAUT_REFERENCE");
  const std::filesystem::path folder =
      given != nullptr ? given : std::filesystem::path(TAUT_SOURCE_DIR "/../shared/reference");
  std::vector<std::string> paths;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "ntrt/traces", none)) {
    if (entry.path().string().ends_with(".csv.gz")) paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST_F(MappingTest, EveryReferenceTraceOfNtrtCanBeReadAndMapped) {
  const std::vector<std::string> paths = ReferenceTraces();
  std::cout << paths.size() << " reference traces\n";
  if (paths.empty()) GTEST_SKIP() << "0 reference traces: set TAUT_REFERENCE";
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    Diagnostics out;
    const auto raw = ReadTrace(path, out);
    ASSERT_TRUE(raw) << out.Format();
    const auto trace = Mapped(kNtrt, *raw);
    ASSERT_TRUE(trace);
    EXPECT_GT(trace->time_s.size(), 900u);
    std::size_t quaternions = 0;
    for (std::size_t i = 0; i < trace->channels.size(); ++i) {
      const std::string& name = trace->channels[i].name;
      const bool ours = name.find('/') != name.npos;
      EXPECT_TRUE(ours || name.ends_with("_m_s")) << name;  // velocity inputs have no channel here
      if (!name.ends_with("/orientation_w")) continue;
      const std::string body = name.substr(5, name.size() - 5 - 14);
      double norm = 0.0;
      for (const double part : Orientation(*trace, body)) norm += part * part;
      EXPECT_NEAR(norm, 1.0, 1e-6);
      ++quaternions;
    }
    EXPECT_GT(quaternions, 0u);
  }
}

TEST_F(MappingTest, NtrtsPushTestHasTheLargestTensionThatNtrtReported) {
  const std::vector<std::string> paths = ReferenceTraces();
  const auto path = std::find_if(paths.begin(), paths.end(), [](const std::string& p) {
    return p.ends_with("/push_1000hz.csv.gz");
  });
  if (path == paths.end()) GTEST_SKIP() << "0 reference traces: set TAUT_REFERENCE";
  Diagnostics out;
  const auto raw = ReadTrace(*path, out);
  ASSERT_TRUE(raw) << out.Format();
  const auto trace = Mapped(kNtrt, *raw);
  ASSERT_TRUE(trace);
  // the robot's start: front segment at x = 0.793 m, its center 0.125 m high
  EXPECT_NEAR(At(*trace, "body/segment_0/position_x_m"), 0.7932759, 1e-7);
  EXPECT_NEAR(At(*trace, "body/segment_0/position_y_m"), 0.0, 1e-7);
  EXPECT_NEAR(At(*trace, "body/segment_0/position_z_m"), 0.125465, 1e-7);
  const Comparison same = Compare(*trace, *trace, {});
  ASSERT_EQ(same.system.size(), 1u);
  EXPECT_EQ(same.system[0].channel_a, "cable/inner_top_1/elastic_n");
  EXPECT_NEAR(same.system[0].a.value, 32.3275, 5e-4);
  EXPECT_EQ(same.system[0].error_percent, 0.0);
}

}  // namespace
}  // namespace taut::test
