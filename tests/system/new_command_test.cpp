// `taut new`: templates of models, experiments and studies
#include <filesystem>
#include <string>
#include <vector>

#include "system/taut_command.h"

namespace taut {
namespace {

class NewCommand : public test::CommandTest {};

TEST_F(NewCommand, ANewModelIsGood) {
  EXPECT_EQ(Taut({"new", "model", "mine"}).output,
            "Written: mine.yaml\nnext: taut view mine.yaml\n");
  const test::CommandResult checked = Taut({"check", "mine.yaml", "--strict"});
  EXPECT_EQ(checked.status, 0) << checked.errors;
  EXPECT_NE(checked.output.find("model mine, 3 bodies, 9 cables"), std::string::npos);
}

TEST_F(NewCommand, ANewExperimentRuns) {
  EXPECT_EQ(Taut({"new", "experiment", "alone"}).status, 0);
  EXPECT_EQ(Taut({"new", "model", "it's", "--model", "x"}).status, 2);
  EXPECT_EQ(Taut({"new", "model", "mine"}).status, 0);
  EXPECT_EQ(Taut({"new", "experiment", "trial", "--model", "mine.yaml"}).status, 0);
  for (const std::string name : {"alone", "trial"}) {
    const test::CommandResult run = Taut({"run", name + ".yaml", "--strict"});
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_TRUE(std::filesystem::exists(Path("runs/" + name + "/trace.h5")));
  }
}

TEST_F(NewCommand, ANewStudyIsSearched) {
  EXPECT_EQ(Taut({"new", "study", "search"}).status, 0);
  const test::CommandResult run = Taut({"learn", "search.yaml", "--strict"});
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.output.rfind("search: 64 evaluations, 0 failed", 0), 0u) << run.output;
}

TEST_F(NewCommand, NewOverwritesNothing) {
  Write("mine.yaml", "what I wrote");
  const test::CommandResult again = Taut({"new", "model", "mine"});
  EXPECT_EQ(again.status, 3);
  EXPECT_EQ(again.errors, "mine.yaml: error: the file exists already, and is not overwritten\n");
  EXPECT_EQ(Read(Path("mine.yaml")), "what I wrote");
  for (const std::string model : {"a\x1b.yaml", "a\nb.yaml"}) {  // which no input file may contain
    Write(model, "");
    const test::CommandResult refused = Taut({"new", "experiment", "e", "--model", model});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.errors.find("cannot be written into a file"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(Path("e.yaml")));
  }
  EXPECT_EQ(Refusal({"new", "model", "a/b"}),
            "error: NAME: \"a/b\" is not a valid name (expected letters, digits, _ or -)");
  EXPECT_EQ(Refusal({"new", "robot", "--", "-x"}),
            "error: NAME: \"-x\" is not a valid name here (a command would read it as a flag)");
  EXPECT_EQ(Refusal({"new", "model", "null"}),
            "error: NAME: \"null\" is not a valid name here (YAML reads it as a missing value)");
  EXPECT_EQ(Refusal({"new", "modle", "a"}),
            "error: kind: \"modle\" is unknown (did you mean \"model\"?)");
}

}  // namespace
}  // namespace taut
