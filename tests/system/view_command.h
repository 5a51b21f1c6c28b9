/// Fixture for `taut view` and `taut report` with a minimal page
#pragma once

#include <chrono>
#include <regex>
#include <thread>

#include "tests/system/taut_command.h"
#include "tests/viewer/client.h"

namespace taut::test {

inline const std::string kHang = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";
inline const std::string kPush = TAUT_SOURCE_DIR "/share/experiments/push_20n.yaml";
inline const std::string kNoPages =
    "error: the viewer's pages are missing (to build them: apt-get install nodejs npm, then "
    "script/build)\n";
/// Template of reports, reduced to its data element
inline const std::string kTemplate =
    R"(<!doctype html><script type="application/json" id="taut-report"></script><p>end)";

class ViewCommand : public CommandTest {
 protected:
  ViewCommand() {
    std::filesystem::create_directory(Path("web"));
    Write("web/index.html", "<p>the page");
    Write("web/report.html", kTemplate);
  }
  ~ViewCommand() override {
    if (viewing_ > 0) Stop(viewing_);  // the test threw
  }

  CommandResult Run(const std::vector<std::string>& arguments, const std::string& web = "web") {
    return Taut(arguments, [&] { setenv("TAUT_WEB", web.c_str(), 1); });
  }

  /// Starts `taut view` on a free port, with the tests' tokens, and waits for its address.
  pid_t StartView(std::vector<std::string> arguments, const std::function<void()>& before = {}) {
    arguments.insert(arguments.begin(), "view");
    arguments.insert(arguments.end(), {"--port", "0"});
    std::filesystem::remove(Path("out.txt"));
    const pid_t pid = Start(arguments, [&] {
      setenv("TAUT_WEB", "web", 1);
      setenv("TAUT_TOKEN", kDriveToken.c_str(), 1);
      setenv("TAUT_WATCH_TOKEN", kWatchToken.c_str(), 1);
      if (before) before();
    });
    viewing_ = pid;
    const std::regex address("http://([^:]+):([0-9]+)/([^\n]*)\nWatch only: ([^\n]*)\n");
    std::smatch found;
    while (waitpid(pid, nullptr, WNOHANG) == 0) {
      const std::string said = Read(Path("out.txt"));
      if (std::regex_search(said, found, address)) {
        host_ = found[1];
        port_ = static_cast<std::uint16_t>(std::stoi(found[2]));
        query_ = found[3];
        watch_ = found[4];
        return pid;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    viewing_ = -1;
    ADD_FAILURE() << "ended without an address: " << Read(Path("out.txt")) << Read(Path("err.txt"));
    return pid;
  }

  int Stop(pid_t pid, int signal = SIGINT) {
    kill(pid, signal);
    viewing_ = -1;
    return End(pid).status;
  }

  pid_t viewing_ = -1;
  std::string host_, query_, watch_;
  std::uint16_t port_ = 0;
};

}  // namespace taut::test
