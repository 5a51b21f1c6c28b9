// Commands with settled starts, and poses written as models
#include <nlohmann/json.hpp>

#include "tests/system/taut_command.h"
#include "tests/unit/scenes/heap_models.h"

namespace taut::test {
namespace {

const std::vector<std::string> kHeap{"--set", "turn_rad=-0.6", "--set", "side_n=2"};

class SettledCommand : public CommandTest {
 protected:
  SettledCommand() {
    Write("prism.yaml", kPrism);
    Write("stands.yaml", kSettledPrism);
    WriteNeverSettles();
  }
  CommandResult With(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Taut(arguments);
  }
};

TEST_F(SettledCommand, AHeapIsAWarningAndWithStrictAnError) {
  const CommandResult check = With({"check", "stands.yaml", "--quiet"}, kHeap);
  EXPECT_EQ(check.status, 0) << check.errors;
  EXPECT_TRUE(check.errors.starts_with("warning: ")) << check.errors;
  EXPECT_NE(check.errors.find("slack after settling"), std::string::npos) << check.errors;
  const CommandResult strict = With({"check", "stands.yaml", "--quiet", "--strict"}, kHeap);
  EXPECT_EQ(strict.status, 3);
  EXPECT_TRUE(strict.errors.starts_with("error: ")) << strict.errors;

  const CommandResult run = With({"run", "stands.yaml", "--quiet", "--duration_s", "0.01"}, kHeap);
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.errors.find("slack after settling"), std::string::npos) << run.errors;
  const auto summary = nlohmann::json::parse(Read(Path("runs/stands/summary.json")));
  EXPECT_GT(summary["start"]["slack_cables"].size(), 0u);
  const CommandResult strict_run =
      With({"run", "stands.yaml", "--quiet", "--strict", "--out", "strict"}, kHeap);
  EXPECT_EQ(strict_run.status, 3) << strict_run.errors;
  EXPECT_FALSE(std::filesystem::exists(Path("strict")));
}

TEST_F(SettledCommand, WhatSettlesIsWrittenAndStaysThere) {
  const CommandResult check =
      Taut({"check", "stands.yaml", "--settled", "--out", "settled.yaml", "--strict"});
  ASSERT_EQ(check.status, 0) << check.errors;
  EXPECT_NE(check.output.find("Model: settled.yaml\n"), std::string::npos) << check.output;
  EXPECT_EQ(Taut({"check", "settled.yaml", "--strict", "--quiet"}).errors, "");
  Write("again.yaml",
        "taut: 1\nkind: experiment\nbase: stands.yaml\nname: again\n"
        "model: settled.yaml\nstart: as_described\n");
  ASSERT_EQ(Taut({"run", "again.yaml", "--quiet", "--final_pose", "end.yaml"}).status, 0);
  const CommandResult end = Taut({"check", "end.yaml", "--json"});
  const CommandResult start = Taut({"check", "settled.yaml", "--json"});
  const auto a = nlohmann::json::parse(start.output), b = nlohmann::json::parse(end.output);
  ASSERT_EQ(a["nodes"].size(), 6u);
  for (std::size_t n = 0; n < 6; ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(a["nodes"][n]["position_m"][i].get<double>(),
                  b["nodes"][n]["position_m"][i].get<double>(), 1e-6);
    }
  }
}

TEST_F(SettledCommand, WhatCannotBeWrittenIsSaid) {
  const CommandResult never = Taut({"check", "never.yaml", "--settled", "--out", "m.yaml"});
  EXPECT_EQ(never.status, 3);
  EXPECT_NE(never.errors.find("error: the robot does not settle to an equilibrium on its ground"),
            std::string::npos)
      << never.errors;
  EXPECT_FALSE(std::filesystem::exists(Path("m.yaml")));

  const CommandResult nowhere =
      Taut({"check", "stands.yaml", "--settled", "--out", "no/such/m.yaml", "--quiet"});
  EXPECT_EQ(nowhere.status, 1) << nowhere.errors;
  EXPECT_TRUE(nowhere.errors.starts_with("no/such/m.yaml: error: ")) << nowhere.errors;
  const CommandResult run = Taut({"run", "stands.yaml", "--final_pose", "no/such/m.yaml"});
  EXPECT_EQ(run.status, 3) << run.errors;
  EXPECT_NE(run.errors.find("no/such/m.yaml: error: cannot write: there is no folder "),
            std::string::npos)
      << run.errors;
  EXPECT_FALSE(std::filesystem::exists(Path("runs")));

  EXPECT_EQ(Taut({"check", "stands.yaml", "--out", "m.yaml"}).status, 2);
  EXPECT_EQ(Taut({"run", "stands.yaml", "--replay", "log.csv", "--final_pose", "m.yaml"}).errors,
            "error: --final_pose cannot be combined with --replay, which simulates no motion\n");
}

}  // namespace
}  // namespace taut::test
