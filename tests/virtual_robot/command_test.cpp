// The command taut_virtual_robot: output and exit status
#include "tests/virtual_robot/command_fixture.h"

namespace taut::virtual_robot {
namespace {

TEST_F(VirtualRobot, HelpsAndSaysItsLicence) {
  const Done done = Ask("--help");
  EXPECT_EQ(done.status, 0);
  for (const char* text : {"--model", "--faults", "--link", "--log", "--seed", "--stand", "--truth",
                           "--with_parent", "Examples:", "GNU General Public License"}) {
    EXPECT_TRUE(Says(done, text)) << text << "\n" << done.said;
  }
}

TEST_F(VirtualRobot, WrongUsageIsStatusTwo) {
  EXPECT_EQ(Ask("").status, 2);
  EXPECT_EQ(Ask("--model").status, 2);
  EXPECT_EQ(Ask("--model robot.yaml --speed 3").status, 2);
  EXPECT_EQ(Ask("--model robot.yaml --experiment e.yaml").status, 2);
  EXPECT_EQ(Ask("--model robot.yaml --set nothing --measure 1").status, 2);
  EXPECT_EQ(Ask("--model robot.yaml --stand --measure 1").status, 2);
  EXPECT_EQ(Ask("--experiment e.yaml --truth truth --run").status, 2);
  EXPECT_EQ(Ask("--experiment e.yaml --calibration c.yaml").status, 2);
  EXPECT_EQ(Ask("--experiment e.yaml --csv").status, 2);
}

TEST_F(VirtualRobot, AllMistakesOfAllFilesAreSaidAtOnce) {
  std::ofstream(folder_ / "faults.yaml") << "taut: 1\nkind: faults\nname: f\nfaults:\n"
                                            "  - {kind: cut_cable, at_s: 1, cable: outer_top_9}\n"
                                            "  - {kind: brown_out, at_s: -1, board: 6}\n";
  const Done done =
      Ask("--model robot.yaml --firmware robot.yaml --faults faults.yaml --measure 1");
  EXPECT_EQ(done.status, 3);
  EXPECT_TRUE(Says(done, "robot.yaml: error: the firmware is not an ELF file")) << done.said;
  EXPECT_TRUE(Says(done, "faults.yaml:5:")) << done.said;
  EXPECT_TRUE(Says(done, "faults.yaml:6:")) << done.said;
  const Done model = Ask("--model " TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml --measure 1");
  EXPECT_EQ(model.status, 3);
  EXPECT_TRUE(Says(model, "is not a motor")) << model.said;
}

TEST_F(VirtualRobot, ACalibrationIsReadAndWhatWasHeardIsText) {
  const std::string run = "--experiment " TAUT_SOURCE_DIR
                          "/share/experiments/push_20n_motors.yaml --run --quiet --duration_s 0.05 "
                          "--csv --out run --calibration ";
  std::ofstream(folder_ / "wrong.yaml")
      << "taut: 1\nkind: calibration\nname: c\ncables:\n"
         "  - {cable: outer_top_9, measured: 2026-01-01, load_cell_n_per_count: 0.2}\n";
  const Done wrong = Ask(run + "wrong.yaml");
  EXPECT_EQ(wrong.status, 3);
  EXPECT_TRUE(Says(wrong, "wrong.yaml:5:")) << wrong.said;
  const Done done = Ask(run + TAUT_SOURCE_DIR "/share/calibrations/as_assumed.yaml");
  EXPECT_EQ(done.status, 0) << done.said;
  for (const char* name : {"trace.csv", "host.csv"}) {
    const std::string text = Text(folder_ / "run" / name);
    EXPECT_EQ(text.rfind("time_s,", 0), 0U) << name;
    EXPECT_GT(std::count(text.begin(), text.end(), '\n'), 3) << name;
  }
}

TEST_F(VirtualRobot, MeasuresItsSpeedAndLogsWhatHappens) {
  std::ofstream(folder_ / "faults.yaml")
      << "taut: 1\nkind: faults\nname: f\nfaults:\n"
         "  - {kind: brown_out, at_s: 0.3, for_s: 0.01, board: 2}\n";
  const std::string arguments = "--model robot.yaml --faults faults.yaml --measure 0.2 --frames ";
  const Done done = Ask(arguments + "--log first.log");
  EXPECT_EQ(done.status, 0) << done.said;
  EXPECT_TRUE(Says(done, "x real time")) << done.said;
  const std::string log = Text(folder_ / "first.log");
  EXPECT_NE(log.find("0.300000000 fault: brown_out of board 2 begins\n"), std::string::npos);
  EXPECT_NE(log.find("0.310000000 board 2: reset: brown-out\n"), std::string::npos);
  EXPECT_EQ(Ask(arguments + "--log second.log").status, 0);
  EXPECT_TRUE(log == Text(folder_ / "second.log")) << "two runs, the same bytes";
  EXPECT_EQ(Ask(arguments + "--log third.log --seed 2").status, 0);
  EXPECT_FALSE(log == Text(folder_ / "third.log"));
}

TEST_F(VirtualRobot, EndsCleanlyOnAnInterrupt) {
  const Done done =
      Ask("--model robot.yaml --link robot > path & pid=$!; "
          "for i in $(seq 200); do [ -L robot ] && break; sleep 0.1; done; "
          "[ -c robot ] || echo no device; kill -INT $pid; wait $pid; echo status $?; "
          "[ -L robot ] && echo left behind; cat path");
  EXPECT_TRUE(Says(done, "status 0")) << done.said;
  EXPECT_TRUE(Says(done, "/dev/pts/")) << done.said;
  EXPECT_FALSE(Says(done, "no device")) << done.said;
  EXPECT_FALSE(Says(done, "left behind")) << done.said;
}

}  // namespace
}  // namespace taut::virtual_robot
