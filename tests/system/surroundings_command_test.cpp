// The command in other surroundings: locale, time zone, folder and environment change no results;
// inputs with errors leave no files
#include <cstdlib>
#include <map>

#include "tests/system/taut_command.h"

namespace taut::test {
namespace {

const std::string kHanging = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";

class Surroundings : public CommandTest {
 protected:
  /// Returns all files of the folder, with their contents.
  std::map<std::string, std::string> Files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      const std::string name = std::filesystem::relative(entry.path(), folder_).string();
      if (name == "out.txt" || name == "err.txt") continue;
      files[name] = entry.is_regular_file() ? Read(entry.path().string()) : "";
    }
    return files;
  }
};

TEST_F(Surroundings, ChangeNoBitsOfARun) {
  const auto result = [&](const std::string& out, const std::function<void()>& before) {
    const CommandResult run = Taut(
        {"run", kHanging, "--duration_s", "0.5", "--csv", "--quiet", "--out", Path(out)}, before);
    EXPECT_EQ(run.status, 0) << run.errors;
    const std::string summary = Read(Path(out + "/summary.json"));
    const std::string hash = "\"state_hash\": ";
    const std::string inputs = Read(Path(out + "/inputs.yaml"));
    return Read(Path(out + "/trace.csv")) +
           inputs.substr(inputs.find('\n')) +  // below the run's id
           summary.substr(summary.find(hash), hash.size() + 18);
  };
  const std::string plain = result("plain", {});
  ASSERT_NE(plain.find("cable/cable/tension_n"), plain.npos);
  const std::map<std::string, std::function<void()>> others{
      {"german", [] { setenv("LC_ALL", "de_DE.UTF-8", 1); }},
      {"turkish", [] { setenv("LC_ALL", "tr_TR.UTF-8", 1); }},
      {"unknown", [] { setenv("LC_ALL", "xx_YY", 1); }},
      {"far_east", [] { setenv("TZ", "Pacific/Auckland", 1); }},
      {"root", [] { EXPECT_EQ(chdir("/"), 0); }},
      {"homeless", [] { unsetenv("HOME"); }},
      {"empty", [] { clearenv(); }}};
  for (const auto& [name, before] : others) EXPECT_EQ(result(name, before), plain) << name;
}

TEST_F(Surroundings, InputsWithErrorsLeaveNoFiles) {
  Write("bad.yaml", "taut: 1\nkind: model\nname: bad\nnodes: {a: [0, 0]}\n");
  Write("bad_experiment.yaml", "taut: 1\nkind: experiment\nname: bad\nmodel: bad.yaml\n");
  Write("bad_study.yaml", "taut: 1\nkind: study\nname: bad\nexperiment: bad_experiment.yaml\n");
  Write("bad_fit.yaml", "taut: 1\nkind: fit\nname: bad\nexperiments: []\n");
  Write("bad.xml", "<mujoco><worldbody>");
  Write("bad.csv", "time_s,a\n0,x\n");
  const auto before = Files();
  const std::vector<std::vector<std::string>> commands{
      {"run", "bad_experiment.yaml", "--out", "out"},
      {"learn", "bad_study.yaml", "--out", "out"},
      {"fit", "bad_fit.yaml", "--out", "out"},
      {"check", "bad.yaml", "--settled", "--out", "out.yaml"},
      {"import", "mjcf", "bad.xml", "--out", "out.yaml"},
      {"import", "ntrt", "bad.yaml", "--length_unit_m", "0.1", "--out", "out.yaml"},
      {"export", "mjcf", "bad.yaml", "--out", "out.xml"},
      {"export", "shape", "bad.yaml", "--out", "out.stl"},
      {"export", "structure", "bad.yaml", "--out", "out"},
      {"report", "bad.csv", "--out", "out.html"},
      {"trace", "convert", "bad.csv", "--out", "out.mcap"}};
  for (const auto& words : commands) {
    const CommandResult result = Taut(words);
    EXPECT_EQ(result.status, 3) << words[0] << " " << words[1] << "\n" << result.errors;
    EXPECT_NE(result.errors.find("error: "), std::string::npos) << words[0];
    EXPECT_EQ(Files(), before) << words[0] << " " << words[1];
  }
}

TEST_F(Surroundings, ARunThatIsNoLongerFiniteEndsWithStatus1) {
  Write("free.yaml",
        "taut: 1\nkind: model\nname: free\nnodes: {ball: [0, 0, 1]}\n"
        "builders: [{match: ball, point_mass: {mass_kg: 1e-300}}]\n");
  Write("burst.yaml",
        "taut: 1\nkind: experiment\nname: burst\nmodel: free.yaml\nduration_s: 1\n"
        "timeline: {events: [{push: {name: burst, node: ball, direction: [1, 0, 0], force_n: [[0, "
        "1e9], [1, 1e9]]}}]}\n");
  const CommandResult result = Taut({"run", "burst.yaml", "--out", "run"});
  EXPECT_EQ(result.status, 1) << result.errors;
  EXPECT_NE((result.output + result.errors).find("the state is no longer finite, body free"),
            std::string::npos)
      << result.output << result.errors;
  EXPECT_EQ(Taut({"compare", "run", "run"}).status, 0);
}

}  // namespace
}  // namespace taut::test
