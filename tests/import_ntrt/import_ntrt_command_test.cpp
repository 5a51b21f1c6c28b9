// The command `taut import ntrt`
#include "system/taut_command.h"

namespace taut::test {
namespace {

const std::string kSuperBall = TAUT_SOURCE_DIR "/docs/from_ntrt/SuperBall.yaml";

class ImportNtrtCommand : public CommandTest {};

TEST_F(ImportNtrtCommand, TheModelGoesToTheFileOrIsPrinted) {
  const CommandResult written =
      Taut({"import", "ntrt", kSuperBall, "--length_unit_m", "0.1", "--out", "m.yaml"});
  EXPECT_EQ(written.status, 0) << written.errors;
  EXPECT_EQ(written.output.rfind("m.yaml: model of 6 bodies of 20.99 kg, 24 cables", 0), 0u)
      << written.output;
  EXPECT_NE(written.output.find("\n  left out: history of superball_string"), std::string::npos);
  const CommandResult printed = Taut({"import", "ntrt", kSuperBall, "--length_unit_m", "0.1"});
  EXPECT_EQ(printed.output, Read(Path("m.yaml")));
  EXPECT_EQ(Taut({"check", "m.yaml", "--strict", "--quiet"}).status, 0);
  const CommandResult named =
      Taut({"import", "ntrt", kSuperBall, "--length_unit_m", "1", "--name", "ball"});
  EXPECT_NE(named.output.find("\nname: ball\n"), std::string::npos);
}

TEST_F(ImportNtrtCommand, WithoutAUnitItSaysHowLargeTheRobotWouldBe) {
  const CommandResult asked = Taut({"import", "ntrt", kSuperBall});
  EXPECT_EQ(asked.status, 2);
  EXPECT_NE(asked.errors.find("the robot is 1.68 m large"), std::string::npos) << asked.errors;
  for (const std::string unit : {"0", "-1", "nan", "dm", "1e10"}) {
    EXPECT_EQ(Taut({"import", "ntrt", kSuperBall, "--length_unit_m", unit}).status, 2) << unit;
  }
}

TEST_F(ImportNtrtCommand, WhyCheckRefusesTheModelIsAWarning) {
  // Two rods that cross, as in the hinge of LaikaICRA2019Model.
  Write("hinge.yaml",
        "nodes: {a1: [0, 1, 0], a2: [2, 1, 0], b1: [1, 1, -1], b2: [1, 1, 1]}\n"
        "pair_groups:\n  rod: [[a1, a2], [b1, b2]]\n"
        "  cable: [[a1, b1], [a1, b2], [a2, b1], [a2, b2]]\n"
        "builders:\n  rod: {class: tgRodInfo, parameters: {density: 0.7, radius: 0.1}}\n"
        "  cable: {class: tgBasicActuatorInfo, parameters: {stiffness: 1000, damping: 10, "
        "pretension: 100}}\n");
  const CommandResult warned =
      Taut({"import", "ntrt", "hinge.yaml", "--length_unit_m", "0.1", "--out", "m.yaml"});
  EXPECT_EQ(warned.status, 0);
  EXPECT_NE(warned.errors.find("hinge.yaml: warning: `taut check` refuses the model: "),
            std::string::npos)
      << warned.errors;
  EXPECT_NE(warned.errors.find("overlap by 0.02 m"), std::string::npos) << warned.errors;
  EXPECT_NE(warned.errors.find("list both bodies in `apart` of the model"), std::string::npos);
  EXPECT_EQ(Taut({"check", "m.yaml", "--quiet"}).status, 3);
  // Applying the hint fixes the model.
  Write("m.yaml", Read(Path("m.yaml")) + "apart: [[a1-a2, b1-b2]]\n");
  EXPECT_EQ(Taut({"check", "m.yaml", "--quiet"}).status, 0);
  EXPECT_EQ(Taut({"import", "ntrt", "hinge.yaml", "--length_unit_m", "0.1", "--strict"}).status, 3);
}

TEST_F(ImportNtrtCommand, BadInputIsRefused) {
  const CommandResult none = Taut({"import", "ntrt", "absent.yaml", "--length_unit_m", "1"});
  EXPECT_EQ(none.status, 3);
  EXPECT_EQ(none.errors, "absent.yaml: error: cannot open: No such file or directory\n");
  EXPECT_EQ(Taut({"import", "ntrt", ".", "--length_unit_m", "1"}).status, 3);
  EXPECT_EQ(Taut({"import", "ntrt", "absent.yaml"}).status, 2);
  Write("s.yaml",
        "nodes: {a: [0, 0, 0], b: [0, 1, 0]}\npair_groups: {rod: [[a, b]], wire: [[a, b]]}\n");
  const CommandResult warned = Taut({"import", "ntrt", "s.yaml", "--length_unit_m", "1"});
  EXPECT_EQ(warned.status, 0);
  EXPECT_EQ(warned.errors.find("s.yaml:2:37: warning: another pair already joins"), 0u)
      << warned.errors;
  const CommandResult strict =
      Taut({"import", "ntrt", "s.yaml", "--length_unit_m", "1", "--strict", "--out", "m.yaml"});
  EXPECT_EQ(strict.status, 3);
  EXPECT_FALSE(std::filesystem::exists(Path("m.yaml")));
  EXPECT_EQ(Taut({"import", "ntrt", kSuperBall, "--length_unit_m", "1", "--out", "/nowhere/m.yaml"})
                .status,
            1);
  EXPECT_EQ(Taut({"import"}).status, 2);
}

}  // namespace
}  // namespace taut::test
