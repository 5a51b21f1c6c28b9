// Command `taut import mjcf`
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

}  // namespace
}  // namespace taut::test
