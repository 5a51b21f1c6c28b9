#include "taut/link/virtual_robot.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <thread>

#include "base/unix_address.h"
#include "link/runtime_folder.h"
#include "taut/shipped.h"

namespace taut::link {
namespace {

constexpr char kProgram[] = "taut_virtual_robot";
/// Limit of the start-up time: read the model and start six boards on a busy machine.
constexpr int kStart_ms = 30'000;

/// Returns $TAUT_VIRTUAL_ROBOT if it is set. Otherwise returns the program in the folder of this
/// program, or its name, to be found on the search path.
std::string ProgramPath() {
  if (const char* const given = std::getenv("TAUT_VIRTUAL_ROBOT"); given && *given != '\0') {
    return given;
  }
  return FindBesideProgram(kProgram).value_or(kProgram);
}

std::string FolderOfIt(Diagnostics& out) {
  const std::string runtime = RuntimeFolder(out);
  if (runtime.empty()) return {};
  std::string folder = runtime + "/virtual";
  if (mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return folder;
  out.Error("folder.not_made", {folder},
            std::string("cannot create the folder: ") + std::strerror(errno));
  return {};
}

/// Returns whether a process listens on this socket. A link may be left over from an earlier
/// process, and may lead to another terminal.
bool Lives(const std::string& truth) {
  sockaddr_un address;
  if (!UnixAddress(truth, &address)) return false;
  const int caller = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (caller < 0) return false;
  const bool lives =
      connect(caller, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(caller);
  return lives;
}

/// Returns the first line received, without its line end. Returns nothing after a timeout.
std::optional<std::string> FirstLine(int from) {
  std::string line;
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kStart_ms);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    pollfd waits{from, POLLIN, 0};
    if (left.count() <= 0 || poll(&waits, 1, static_cast<int>(left.count())) <= 0) return {};
    char c = 0;
    if (read(from, &c, 1) != 1) return {};
    if (c == '\n') return line;
    line += c;
  }
}

}  // namespace

VirtualRobot::VirtualRobot(const std::string& folder, int process, int says)
    : device_(folder + "/port"), truth_(folder + "/truth"), process_(process), says_(says) {}

VirtualRobot::~VirtualRobot() {
  if (says_ >= 0) close(says_);
  if (process_ <= 0) return;
  kill(process_, SIGTERM);
  for (int i = 0; i < 200; ++i) {
    if (waitpid(process_, nullptr, WNOHANG) != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

std::unique_ptr<VirtualRobot> VirtualRobot::Find(Diagnostics& out) {
  const std::string folder = FolderOfIt(out);
  if (folder.empty()) return nullptr;
  std::unique_ptr<VirtualRobot> robot(new VirtualRobot(folder, -1, -1));
  return Lives(robot->truth_) ? std::move(robot) : nullptr;
}

std::unique_ptr<VirtualRobot> VirtualRobot::Start(const std::vector<std::string>& arguments,
                                                  Diagnostics& out) {
  const std::string folder = FolderOfIt(out);
  if (folder.empty()) return nullptr;
  const std::string program = ProgramPath();
  std::vector<std::string> words{program,          "--stand", "--with_parent",
                                 "--slip_s",       "0.02",    "--link",
                                 folder + "/port", "--truth", folder + "/truth"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int says[2];
  if (pipe2(says, O_CLOEXEC) != 0) {
    out.Error("virtual_robot.no_pipe", {},
              std::string("cannot create a pipe: ") + std::strerror(errno));
    return nullptr;
  }
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);  // Ctrl-C must not end the robot before the driving program has switched off its
                    // motors
    dup2(says[1], STDOUT_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  close(says[1]);
  std::unique_ptr<VirtualRobot> robot(new VirtualRobot(folder, child, says[0]));
  const auto line = child > 0 ? FirstLine(says[0]) : std::nullopt;
  if (!line) {
    int status = 0;
    const bool ended = child > 0 && waitpid(child, &status, WNOHANG) == child;
    if (ended) robot->process_ = -1;
    const bool missing = ended && WIFEXITED(status) && WEXITSTATUS(status) == 127;
    out.Error("virtual_robot.not_started", {program},
              missing ? "the program does not exist" : "the program did not start",
              missing ? "install avr-g++ and libsimavr and build taut (docs/hardware/"
                        "virtual_robot.md), or set TAUT_VIRTUAL_ROBOT to its path"
                      : "");
    return nullptr;
  }
  return robot;
}

}  // namespace taut::link
