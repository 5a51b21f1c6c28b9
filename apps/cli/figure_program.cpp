// Python program that draws figures. Its text is part of the command, so that no installation can
// lack it; the interpreter and matplotlib are the user's.
#include "figure_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <vector>

#include "figure_script.h"

namespace taut::cli {
namespace {

/// Exit statuses: `NO_MATPLOTLIB` of plot.py, and the status of shells without the interpreter.
constexpr int kNoMatplotlib = 4, kNoProgram = 127;

/// With `python3 -c`, modules in the working folder would replace modules of Python.
constexpr const char* kWithoutWorkingFolder =
    "import sys\nsys.path = [folder for folder in sys.path if folder]\n";

struct PipeEnds {
  int read = -1, write = -1;
};

bool OpenPipe(PipeEnds& ends) {
  std::array<int, 2> both{};
  if (pipe2(both.data(), O_CLOEXEC) != 0) return false;
  ends = {both[0], both[1]};
  return true;
}

void Close(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

/// Writes `input` into `to` and reads all of `from`, both as far as the program allows.
std::string Exchange(const std::string& input, int to, int from) {
  fcntl(to, F_SETFL, O_NONBLOCK);
  std::string output;
  std::array<char, 65536> block;
  std::size_t sent = 0;
  while (true) {
    if (sent == input.size()) Close(to);
    std::array<pollfd, 2> ready{{{from, POLLIN, 0}, {to, POLLOUT, 0}}};  // poll ignores -1
    if (poll(ready.data(), ready.size(), -1) < 0 && errno != EINTR) break;
    if (ready[1].revents != 0) {
      const ssize_t count = write(to, input.data() + sent, input.size() - sent);
      if (count > 0) sent += static_cast<std::size_t>(count);
      if (count < 0 && errno != EAGAIN && errno != EINTR) Close(to);  // the program has ended
    }
    if (ready[0].revents != 0) {
      const ssize_t count = read(from, block.data(), block.size());
      if (count > 0) output.append(block.data(), static_cast<std::size_t>(count));
      if (count == 0 || (count < 0 && errno != EINTR)) break;
    }
  }
  Close(to);
  return output;
}

/// Runs the program with one interpreter. Returns its exit status, -1 if it was killed or did not
/// start.
int RunWith(const std::string& python, const std::string& request, std::string& figure) {
  PipeEnds in, out;
  if (!OpenPipe(in) || !OpenPipe(out)) {
    Close(in.read);
    Close(in.write);
    return -1;
  }
  const std::string text = std::string(kWithoutWorkingFolder) + kFigureScript;
  const char* const words[] = {python.c_str(), "-c", text.c_str(), nullptr};
  const pid_t child = fork();
  if (child == 0) {
    dup2(in.read, STDIN_FILENO);
    dup2(out.write, STDOUT_FILENO);
    execvp(words[0], const_cast<char* const*>(words));
    _exit(kNoProgram);
  }
  Close(in.read);
  Close(out.write);
  if (child < 0) {
    Close(in.write);
    Close(out.read);
    return -1;
  }
  struct sigaction ignore = {}, before = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &before);  // the program may end before it has read everything
  figure = Exchange(request, in.write, out.read);
  sigaction(SIGPIPE, &before, nullptr);
  Close(out.read);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::optional<std::string> DrawFigure(const std::string& request, Diagnostics& out) {
  const char* const chosen = std::getenv("TAUT_PYTHON");
  const bool choice = chosen != nullptr && *chosen != '\0';
  // Debian's matplotlib belongs to /usr/bin/python3, which may be hidden by another python3.
  const std::vector<std::string> pythons =
      choice ? std::vector<std::string>{chosen}
             : std::vector<std::string>{"python3", "/usr/bin/python3"};
  bool found = false;
  for (const std::string& python : pythons) {
    std::string figure;
    const int status = RunWith(python, request, figure);
    if (status == 0) return figure;
    found = found || status != kNoProgram;
    if (status == kNoMatplotlib || status == kNoProgram) continue;
    out.Error("figure.not_drawn", {},
              status < 0 ? fmt::format("{} was killed or did not start", python)
                         : fmt::format("{} failed with exit status {}", python, status),
              "see its output above, if any");
    return std::nullopt;
  }
  const std::string where =
      choice ? fmt::format("the program {} of TAUT_PYTHON", chosen) : std::string("Python 3");
  if (found) {
    out.Error("figure.no_matplotlib", {},
              fmt::format("figures need matplotlib, which {} lacks", where),
              "run `apt install python3-matplotlib` or `pip install matplotlib`, or set "
              "TAUT_PYTHON to a Python that has it");
  } else {
    out.Error("figure.no_python", {}, fmt::format("figures need {}, which is missing", where),
              "run `apt install python3-matplotlib`");
  }
  return std::nullopt;
}

}  // namespace taut::cli
