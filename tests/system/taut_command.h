/// Fixture that runs the command `taut` in a temporary folder
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace taut::test {

struct CommandResult {
  int status = -1;  ///< Exit status; 128 + signal number if a signal ended it, as in shells.
  std::string output, errors;
};

class CommandTest : public testing::Test {
 protected:
  CommandTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "taut_command_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~CommandTest() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name), std::ios::binary) << text;
    return Path(name);
  }

  /// Writes never.yaml, an experiment without an equilibrium to start from: a ball in free fall.
  void WriteNeverSettles() const {
    Write("falls.yaml",
          "taut: 1\nkind: model\nname: falls\nnodes:\n  ball: [0, 0, 1]\nbuilders:\n"
          "  - {match: ball, point_mass: {mass_kg: 1}}\n");
    Write("never.yaml",
          "taut: 1\nkind: experiment\nname: never\nmodel: falls.yaml\nduration_s: 1\n"
          "start: settled\n");
  }

  static std::string Read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Starts `taut` with these arguments in the folder; `before` runs in the new process.
  pid_t Start(const std::vector<std::string>& arguments,
              const std::function<void()>& before = {}) const {
    const pid_t pid = fork();
    if (pid != 0) return pid;
    std::vector<char*> words;
    std::string command = TAUT_COMMAND;
    words.push_back(command.data());
    std::vector<std::string> copies = arguments;
    for (std::string& word : copies) words.push_back(word.data());
    words.push_back(nullptr);
    if (chdir(folder_.c_str()) != 0) _exit(99);
    for (const auto& [name, to] :
         {std::pair("out.txt", STDOUT_FILENO), {"err.txt", STDERR_FILENO}}) {
      const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
      if (file < 0 || dup2(file, to) < 0) _exit(98);
    }
    if (before) before();
    execv(TAUT_COMMAND, words.data());
    _exit(97);
  }

  CommandResult End(pid_t pid) const {
    int status = 0;
    if (waitpid(pid, &status, 0) != pid) return {};
    const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return {code, Read(Path("out.txt")), Read(Path("err.txt"))};
  }

  CommandResult Taut(const std::vector<std::string>& arguments,
                     const std::function<void()>& before = {}) const {
    return End(Start(arguments, before));
  }

  /// Returns the first line of the error for a wrong command line.
  std::string Refusal(const std::vector<std::string>& arguments) const {
    const CommandResult result = Taut(arguments);
    EXPECT_EQ(result.status, 2) << result.errors;
    EXPECT_EQ(result.output, "");
    return result.errors.substr(0, result.errors.find('\n'));
  }

  std::filesystem::path folder_;
};

}  // namespace taut::test
