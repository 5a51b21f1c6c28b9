#include "trace/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string_view>

namespace taut::trace {
namespace {

/// Returns the size of this process's address space. Returns 0 if the system does not report it.
std::size_t AddressSpaceBytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  unsigned long pages = 0;
  const int found = std::fscanf(file, "%lu", &pages);
  std::fclose(file);
  return found == 1 ? pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

struct ProcessorUse {
  bool waits_for_processor = false;
  double used_s = 0;
};

ProcessorUse UseOf(pid_t pid) {
  ProcessorUse use;
  std::FILE* file = std::fopen(fmt::format("/proc/{}/stat", pid).c_str(), "r");
  if (file == nullptr) return use;
  char text[1024] = {};
  const std::size_t size = std::fread(text, 1, sizeof text - 1, file);
  std::fclose(file);
  // The name may contain any character. After it: state, ten numbers, user time and system time.
  const std::string_view all(text, size);
  const std::size_t name_end = all.rfind(')');
  char state = 0;
  unsigned long user = 0, system = 0;
  if (name_end == std::string_view::npos ||
      std::sscanf(text + name_end + 1, " %c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %lu %lu",
                  &state, &user, &system) != 3) {
    return use;
  }
  use.waits_for_processor = state == 'R';
  use.used_s = static_cast<double>(user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return use;
}

/// Prepares the child for a possible crash: resets signal handlers, disables core files and
/// redirects error output to /dev/null. Ignores SIGINT, which the parent handles.
void PrepareForTheWorst(std::size_t more_memory_bytes) {
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGPIPE}) {
    signal(number, SIG_DFL);
  }
  signal(SIGINT, SIG_IGN);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (const std::size_t now = AddressSpaceBytes(); now > 0) {
    const rlimit memory{now + more_memory_bytes, now + more_memory_bytes};
    setrlimit(RLIMIT_AS, &memory);
  }
  if (const int null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
}

}  // namespace

void ChildOutput::Write(const void* data, std::size_t size) const {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = write(descriptor_, from, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) _exit(1);
    from += done;
    size -= static_cast<std::size_t>(done);
  }
}

ChildProcess::ChildProcess(const std::function<void(const ChildOutput&)>& work,
                           std::size_t more_memory_bytes, std::chrono::milliseconds patience)
    : patience_(patience) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    trouble_ = fmt::format("could not be started: {}", std::strerror(errno));
    return;
  }
  pid_ = fork();
  if (pid_ == 0) {
    close(ends[0]);
    PrepareForTheWorst(more_memory_bytes);
    try {
      work(ChildOutput(ends[1]));
    } catch (const std::exception&) {
      _exit(1);
    }
    _exit(0);  // unlike exit(), does not flush and close the parent's files
  }
  if (pid_ < 0) trouble_ = fmt::format("could not be started: {}", std::strerror(errno));
  close(ends[1]);
  descriptor_ = ends[0];
}

ChildProcess::~ChildProcess() {
  End();
  if (descriptor_ >= 0) close(descriptor_);
}

bool ChildProcess::Read(void* to, std::size_t size) {
  constexpr int kLook_ms = 50;
  char* at = static_cast<char*>(to);
  const double patience_s = std::chrono::duration<double>(patience_).count();
  double used_before_s = -1, slept_s = 0;
  while (size > 0 && trouble_.empty() && !stream_ended_) {
    pollfd waiting{descriptor_, POLLIN, 0};
    const int ready = poll(&waiting, 1, kLook_ms);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      const ProcessorUse use = UseOf(pid_);
      if (used_before_s < 0) used_before_s = use.used_s;
      if (!use.waits_for_processor) slept_s += 1e-3 * kLook_ms;
      if (use.used_s - used_before_s >= patience_s) {
        trouble_ = fmt::format("used {} s of processor time without a result", patience_s);
      } else if (slept_s >= patience_s) {
        trouble_ = fmt::format("did not respond for {} s", patience_s);
      }
      continue;
    }
    used_before_s = -1, slept_s = 0;
    const ssize_t done = read(descriptor_, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      stream_ended_ = true;
      break;
    }
    at += done;
    size -= static_cast<std::size_t>(done);
  }
  return size == 0;
}

std::string ChildProcess::End() {
  if (pid_ <= 0) return trouble_;
  if (!stream_ended_) kill(pid_, SIGKILL);
  int status = 0;
  pid_t ended = -1;
  do {
    ended = waitpid(pid_, &status, 0);
  } while (ended < 0 && errno == EINTR);
  pid_ = -1;
  if (ended < 0 || !trouble_.empty() || !stream_ended_) return trouble_;
  if (WIFSIGNALED(status)) {
    trouble_ = fmt::format("crashed ({})", strsignal(WTERMSIG(status)));
  } else if (WEXITSTATUS(status) != 0) {
    trouble_ = fmt::format("ended with status {}", WEXITSTATUS(status));
  }
  return trouble_;
}

}  // namespace taut::trace
