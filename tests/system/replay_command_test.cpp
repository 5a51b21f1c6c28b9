// `taut run --replay`: an experiment's controllers act on a recording.
#include <algorithm>

#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

const std::string kGait = TAUT_SOURCE_DIR "/share/experiments/sine_hand_tuned.yaml";

class Replay : public CommandTest {
 protected:
  Trace Load(const std::string& name) {
    Diagnostics out;
    auto trace = ReadTrace(Path(name), out);
    EXPECT_TRUE(trace) << out.Format();
    return trace.value_or(Trace{});
  }
};

TEST_F(Replay, SaysWhatWasSaidAndWhereItIsFrom) {
  // Recorded at 100 Hz, the experiment's rate, and controlled at 1 kHz: quantities that depend on
  // the last row only are equal.
  const auto run = Taut({"run", kGait, "--duration_s", "2", "--out", "first"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto again = Taut({"run", kGait, "--replay", "first/trace.h5", "--out", "again", "--csv"});
  ASSERT_EQ(again.status, 0) << again.errors;
  const Trace first = Load("first/trace.h5"), said = Load("again/trace.h5");
  EXPECT_EQ(said.time_s.back(), 2.0);
  const auto from = std::find_if(said.metadata.begin(), said.metadata.end(),
                                 [](const auto& pair) { return pair.first == "replay_of"; });
  ASSERT_NE(from, said.metadata.end());
  EXPECT_EQ(from->second, "first/trace.h5");
  ASSERT_EQ(said.time_s, first.time_s);
  for (const char* name :
       {"cable/outer_top_1/tension_n", "cable/outer_top_1/rest_length_m",
        "cable/outer_top_1/velocity_input_m_per_s", "body/segment_0/position_x_m"}) {
    const auto a = first.Find(name), b = said.Find(name);
    ASSERT_TRUE(a && b) << name;
    EXPECT_EQ(first.values[*a], said.values[*b]) << name;
  }
  EXPECT_FALSE(said.Find("system/kinetic_j"));
  // From CSV, with a shorter duration.
  const auto text = Taut({"run", kGait, "--replay", "again/trace.csv", "--duration_s", "0.5",
                          "--out", "third", "--quiet"});
  ASSERT_EQ(text.status, 0) << text.errors;
  EXPECT_EQ(Load("third/trace.h5").time_s.back(), 0.5);
}

TEST_F(Replay, OfWhatIsNoLogOfThisRobotIsAnError) {
  EXPECT_EQ(Taut({"run", kGait, "--replay", "nothere.h5"}).status, 3);
  Write("other.csv", "time_s,cable/nobody/tension_n\n0,1\n");
  const auto other = Taut({"run", kGait, "--replay", "other.csv"});
  EXPECT_EQ(other.status, 3);
  EXPECT_NE(other.errors.find("the recording has no channels of a cable of tetraspine3"),
            std::string::npos)
      << other.errors;
  Write("empty.csv", "time_s,cable/outer_top_1/tension_n\n");
  EXPECT_EQ(Taut({"run", kGait, "--replay", "empty.csv"}).status, 3);
  EXPECT_FALSE(std::filesystem::exists(Path("runs")));
}

}  // namespace
}  // namespace taut::test
