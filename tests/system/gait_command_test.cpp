// The commands `taut gait` and `taut check --couplings`
#include <algorithm>
#include <nlohmann/json.hpp>

#include "system/taut_command.h"

namespace taut::test {
namespace {

const std::string kRoot = TAUT_SOURCE_DIR "/";

class GaitCommand : public CommandTest {};

TEST_F(GaitCommand, CouplingsAreShownCountedAndDrawn) {
  const std::string spine = kRoot + "share/models/tetraspine3.yaml";
  const CommandResult text = Taut({"check", spine, "--couplings", "--svg", "c.svg"});
  EXPECT_EQ(text.status, 0) << text.errors;
  EXPECT_EQ(text.output.find("12 oscillators, 132 couplings, 57 groups.\n"), 0u) << text.output;
  EXPECT_NE(text.output.find("frequency, amplitude): 116."), std::string::npos);
  EXPECT_NE(text.output.find("same.outer_right.outer_left"), std::string::npos);
  const std::string svg = Read(Path("c.svg"));
  std::size_t circles = 0, lines = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != svg.npos; ++at) ++circles;
  for (std::size_t at = 0; (at = svg.find("<line", at)) != svg.npos; ++at) ++lines;
  EXPECT_EQ(circles, 12u);
  EXPECT_EQ(lines, 66u);  // 132 couplings, one line for both directions
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");

  const CommandResult free =
      Taut({"check", spine, "--couplings", "--symmetry", "none", "--json", "--set", "segments=4"});
  EXPECT_EQ(free.status, 0) << free.errors;
  const auto json = nlohmann::json::parse(free.output);
  EXPECT_EQ(json["oscillators"].size(), 18u);
  EXPECT_EQ(json["couplings"].size(), 3u * 30 + 2 * 72);
  EXPECT_EQ(json["couplings"][0]["group"], "outer_right_1.outer_left_1");
}

TEST_F(GaitCommand, AnExperimentShowsTheNetworkOfItsOwnGait) {
  const CommandResult shown =
      Taut({"check", kRoot + "share/experiments/cpg_learned.yaml", "--couplings", "--json"});
  EXPECT_EQ(shown.status, 0) << shown.errors;
  const auto json = nlohmann::json::parse(shown.output);
  EXPECT_EQ(json["oscillators"][0], "outer_top_1");  // the order of 2015
  EXPECT_EQ(json["couplings"][0]["group"], "rp1.0.1");
}

TEST_F(GaitCommand, WhatCannotBeDrawnOrWrittenFails) {
  const std::string spine = kRoot + "share/models/tetraspine3.yaml";
  EXPECT_EQ(Taut({"check", spine, "--couplings", "--svg", "/nowhere/c.svg"}).status, 1);
  const CommandResult created = Taut({"gait", "create", spine, "--out", "/nowhere/g.yaml"});
  EXPECT_EQ(created.status, 1);
  EXPECT_EQ(created.errors, "/nowhere/g.yaml: error: cannot write: No such file or directory\n");
}

TEST_F(GaitCommand, ACreatedGaitIsGoodAndHasEveryNumber) {
  const std::string spine = kRoot + "share/models/tetraspine12.yaml";
  ASSERT_EQ(Taut({"gait", "create", spine, "--name", "blank", "--out", "g.yaml"}).status, 0);
  EXPECT_EQ(Taut({"check", "g.yaml", "--quiet"}).status, 0);
  const CommandResult values = Taut({"gait", "values", "g.yaml", "--json"});
  const auto json = nlohmann::json::parse(values.output);
  EXPECT_EQ(json["name"], "blank");
  EXPECT_EQ(json["values"].size(), 3u + 114);  // 116 of the paper, and the convergence rate
  EXPECT_EQ(json["values"][3]["name"], "cpg.front.outer_right.outer_right.weight_per_m");
  EXPECT_EQ(json["values"][3]["unit"], "1/m");
}

TEST_F(GaitCommand, ACreatedGaitMayDriveRestLengths) {
  const std::string spine = kRoot + "share/models/tetraspine3.yaml";
  ASSERT_EQ(Taut({"gait", "create", spine, "--drives", "rest_length", "--out", "g.yaml"}).status,
            0);
  EXPECT_NE(Read(Path("g.yaml")).find("drives: rest_length\n"), std::string::npos);
  const auto json = nlohmann::json::parse(Taut({"gait", "values", "g.yaml", "--json"}).output);
  EXPECT_EQ(json["values"][1]["name"], "cpg.amplitude_m");
  EXPECT_EQ(json["values"][3]["unit"], "1/(m s)");
  const CommandResult table =
      Taut({"gait", "export", "g.yaml", spine, "--rate_hz", "10", "--duration_s", "0.2"});
  EXPECT_EQ(table.status, 0) << table.errors;
  EXPECT_EQ(table.output.find("time_s,outer_right_1_m,"), 0u) << table.output;
}

TEST_F(GaitCommand, AnExportedTableIsOneLineARow) {
  const CommandResult table =
      Taut({"gait", "export", kRoot + "share/gaits/hand_tuned_sine.yaml",
            kRoot + "share/models/tetraspine3.yaml", "--rate_hz", "10", "--duration_s", "0.2"});
  EXPECT_EQ(table.status, 0) << table.errors;
  EXPECT_EQ(table.output.find("time_s,outer_right_1_m_per_s,"), 0u);
  EXPECT_EQ(std::count(table.output.begin(), table.output.end(), '\n'), 4);
}

TEST_F(GaitCommand, WrongFilesAreAnsweredWithTheirPlace) {
  Write("g.yaml", "taut: 1\nkind: gait\nname: g\nsine: {frequency_hz: 1, waves: 3}\n");
  const CommandResult bad = Taut({"check", "g.yaml", "--json"});
  EXPECT_EQ(bad.status, 3);
  EXPECT_NE(bad.errors.find("g.yaml:4:32: error: sine.waves must be a list"), std::string::npos)
      << bad.errors;
  EXPECT_EQ(nlohmann::json::parse(bad.output)["ok"], false);
  EXPECT_EQ(Taut({"gait", "values", "none.yaml"}).status, 3);
  EXPECT_EQ(Taut({"gait", "import", "none"}).status, 3);
  EXPECT_EQ(Taut({"gait", "export", "g.yaml", "none.yaml"}).status, 3);
  // errors of the gait and of the robot, reported together
  const CommandResult both = Taut({"gait", "export", "g.yaml", "none.yaml"});
  EXPECT_NE(both.errors.find("g.yaml:4"), std::string::npos);
  EXPECT_NE(both.errors.find("none.yaml"), std::string::npos);
  // the table of a gait that does not match the robot
  const CommandResult misfit = Taut(
      {"gait", "export", kRoot + "share/gaits/cpg_learned.yaml", kRoot + "share/models/rod.yaml"});
  EXPECT_EQ(misfit.status, 3);
  EXPECT_NE(misfit.errors.find("cpg.order: there is no cable \"outer_top_1\""), std::string::npos)
      << misfit.errors;
}

TEST_F(GaitCommand, WrongUseIsSaid) {
  EXPECT_EQ(Taut({"gait"}).status, 2);
  EXPECT_EQ(Taut({"gait", "export", "g.yaml"}).status, 2);
  EXPECT_EQ(Taut({"gait", "export", "g.yaml", "m.yaml", "--rate_hz", "0"}).status, 2);
  EXPECT_EQ(Taut({"gait", "import", "x", "--order", "2017"}).status, 2);
  EXPECT_EQ(Taut({"check", "m.yaml", "--couplings", "--symmetry", "all"}).status, 2);
  EXPECT_EQ(Taut({"gait", "create", "m.yaml", "--drives", "tension"}).status, 2);
}

}  // namespace
}  // namespace taut::test
