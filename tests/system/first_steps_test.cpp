// The command that script/run builds first: it has all commands of the first steps, gives the same
// results, and names the way to build the others.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "system/taut_command.h"

namespace taut {
namespace {

class FirstSteps : public test::CommandTest {
 protected:
  /// Returns the first words of the lines that list commands.
  static std::vector<std::string> Commands(const std::string& overview) {
    std::vector<std::string> names;
    std::istringstream lines(overview);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("  ", 0) == 0) names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    return names;
  }
};

TEST_F(FirstSteps, AllCommandsAreListedInTheSameOrder) {
  const auto first = Commands(Taut({}).output);
  const std::string path = Path("full.txt");
  ASSERT_EQ(std::system((std::string(TAUT_FULL) + " >" + path).c_str()), 0);
  EXPECT_EQ(first, Commands(Read(path)));
  EXPECT_NE(std::ranges::find(first, "analyze"), first.end());
}

TEST_F(FirstSteps, ARunEndsInTheSameState) {
  const std::string hang = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";
  ASSERT_EQ(Taut({"run", hang, "--out", Path("first")}).status, 0);
  const std::string full =
      std::string(TAUT_FULL) + " run " + hang + " --out " + Path("full") + " >/dev/null";
  ASSERT_EQ(std::system(full.c_str()), 0);
  const auto first = nlohmann::json::parse(Read(Path("first/summary.json")));
  const auto all = nlohmann::json::parse(Read(Path("full/summary.json")));
  ASSERT_TRUE(first.contains("state_hash")) << first.dump();
  for (const char* const key : {"state_hash", "cables", "struts", "status"}) {
    EXPECT_EQ(first[key], all[key]) << key;
  }
}

TEST_F(FirstSteps, TheOtherCommandsNameTheWayToBuildThem) {
  for (const char* const name : {"analyze", "compare", "export", "fit", "import", "learn", "plot",
                                 "robot", "size", "trace"}) {
    const test::CommandResult result = Taut({name, "model.yaml", "--tables"});
    EXPECT_EQ(result.status, 1) << name;
    EXPECT_NE(result.errors.find("error: `taut " + std::string(name) + "` is not built yet"),
              std::string::npos)
        << result.errors;
    EXPECT_NE(result.errors.find("script/build release taut"), std::string::npos) << result.errors;
  }
}

}  // namespace
}  // namespace taut
