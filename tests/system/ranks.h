/// Fixture that runs `taut` in several processes with mpirun
#pragma once

#include <cstring>

#include "tests/system/taut_command.h"

namespace taut::test {

class RanksTest : public CommandTest {
 protected:
  void SetUp() override {
    if (std::strcmp(TAUT_MPIRUN, "") == 0) GTEST_SKIP() << "built without MPI, or no mpirun";
  }

  /// Starts `taut` with these arguments on this many processes, which are mpirun's children.
  pid_t StartRanks(int ranks, const std::vector<std::string>& arguments) const {
    const pid_t pid = fork();
    if (pid != 0) return pid;
    std::vector<std::string> words{TAUT_MPIRUN, "--oversubscribe", "-np", std::to_string(ranks),
                                   TAUT_COMMAND};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> all;
    for (std::string& word : words) all.push_back(word.data());
    all.push_back(nullptr);
    if (chdir(folder_.c_str()) != 0) _exit(99);
    for (const auto& [name, to] :
         {std::pair("out.txt", STDOUT_FILENO), {"err.txt", STDERR_FILENO}}) {
      const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0666);
      if (file < 0 || dup2(file, to) < 0) _exit(98);
    }
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    execv(TAUT_MPIRUN, all.data());
    _exit(97);
  }
};

}  // namespace taut::test
