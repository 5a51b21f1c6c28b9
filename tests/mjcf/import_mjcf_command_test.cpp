// Command `taut import mjcf`
#include <sys/resource.h>

#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

class ImportMjcfCommand : public CommandTest {};

TEST_F(ImportMjcfCommand, WhyCheckRefusesTheModelIsAWarning) {
  // As in MuJoCo's tests of collisions, where bodies overlap at the start.
  Write(
      "overlap.xml",
      "<mujoco><worldbody>\n"
      "<body name=\"a\"><freejoint/><geom type=\"sphere\" size=\"0.1\"/></body>\n"
      "<body name=\"b\" pos=\"0.08 0 0\"><freejoint/><geom type=\"sphere\" size=\"0.1\"/></body>\n"
      "</worldbody></mujoco>\n");
  const CommandResult warned = Taut({"import", "mjcf", "overlap.xml", "--out", "m.yaml"});
  EXPECT_EQ(warned.status, 0) << warned.errors;
  EXPECT_NE(warned.errors.find("overlap.xml: warning: `taut check` refuses the model: "),
            std::string::npos)
      << warned.errors;
  EXPECT_NE(warned.errors.find("overlap by 0.12 m"), std::string::npos) << warned.errors;
  EXPECT_EQ(Taut({"check", "m.yaml", "--quiet"}).status, 3);
  EXPECT_EQ(Taut({"import", "mjcf", "overlap.xml", "--strict"}).status, 3);
}

TEST_F(ImportMjcfCommand, WhyCheckRefusesTheExperimentIsAWarning) {
  Write(
      "deep.xml",
      "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>\n"
      "<body name=\"a\" pos=\"0 0 -0.05\"><freejoint/><geom type=\"sphere\" size=\"0.1\"/></body>\n"
      "</worldbody></mujoco>\n");
  const CommandResult model = Taut({"import", "mjcf", "deep.xml", "--out", "m.yaml"});
  EXPECT_EQ(model.errors.find("refuses"), std::string::npos) << model.errors;
  EXPECT_EQ(Taut({"check", "m.yaml", "--quiet"}).status, 0);
  const CommandResult warned =
      Taut({"import", "mjcf", "deep.xml", "--out", "m.yaml", "--experiment", "e.yaml"});
  EXPECT_EQ(warned.status, 0) << warned.errors;
  EXPECT_NE(warned.errors.find("deep.xml: warning: `taut check` refuses the experiment: "),
            std::string::npos)
      << warned.errors;
  EXPECT_NE(warned.errors.find("deep in the terrain \"floor\""), std::string::npos)
      << warned.errors;
  EXPECT_EQ(Taut({"check", "e.yaml", "--quiet"}).status, 3);
}

TEST_F(ImportMjcfCommand, PairsOfThousandsOfBodiesThatMeetTakeNoMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more address space";
#endif
  std::string bodies;
  for (int i = 0; i < 4900; ++i) {
    bodies +=
        "<body pos=\"" + std::to_string(i) + " 0 0\"><freejoint/><geom size=\"0.01\"/></body>\n";
  }
  Write("many.xml", "<mujoco><worldbody>\n" + bodies + "</worldbody></mujoco>\n");
  const CommandResult done = Taut({"import", "mjcf", "many.xml", "--out", "m.yaml"}, [] {
    const rlimit limit{400'000'000, 400'000'000};
    setrlimit(RLIMIT_AS, &limit);
  });
  EXPECT_EQ(done.status, 0) << done.errors;
  EXPECT_EQ(done.errors.find("pairs of shapes"), std::string::npos) << done.errors;
}

}  // namespace
}  // namespace taut::test
