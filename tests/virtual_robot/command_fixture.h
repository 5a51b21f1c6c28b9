/// Fixture for the command taut_virtual_robot, with a robot.yaml: Tetraspine3 with motors
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace taut::virtual_robot {

namespace fs = std::filesystem;

struct Done {
  int status = 0;
  std::string said;
};

class VirtualRobot : public testing::Test {
 protected:
  VirtualRobot() {
    std::string name = (fs::temp_directory_path() / "taut_vr_XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::string spine = Text(TAUT_SOURCE_DIR "/share/models/tetraspine3.yaml");
    const std::string limits =
        "{max_speed_m_per_s: 0.07, max_force_n: 50, min_rest_length_m: 0.01, "
        "min_length_m: 0.01}";
    spine.replace(spine.find(limits), limits.size(), "{min_rest_length_m: 0.01, dc_motor: {}}");
    std::ofstream(folder_ / "robot.yaml") << spine;
  }
  ~VirtualRobot() override { fs::remove_all(folder_); }

  static std::string Text(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  Done Ask(const std::string& arguments) const {
    const std::string command =
        "cd " + folder_.string() + "; " TAUT_VIRTUAL_ROBOT " " + arguments + " 2>&1";
    std::FILE* pipe = popen(command.c_str(), "r");
    Done done;
    char buffer[4096];
    while (const std::size_t got = std::fread(buffer, 1, sizeof buffer, pipe)) {
      done.said.append(buffer, got);
    }
    done.status = WEXITSTATUS(pclose(pipe));
    return done;
  }
  bool Says(const Done& done, const std::string& text) const {
    return done.said.find(text) != std::string::npos;
  }
  fs::path folder_;
};

}  // namespace taut::virtual_robot
