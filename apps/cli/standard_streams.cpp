#include "standard_streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "commands.h"

namespace taut::cli {
namespace {

struct Stream {
  int descriptor;
  int error = 0;  ///< First error number; 0: all output was written.
};

Stream output{STDOUT_FILENO}, errors{STDERR_FILENO};
bool output_is_news = false;

/// Accepts all data: an error is stored and reported only at the end.
ssize_t Put(void* cookie, const char* text, std::size_t size) {
  Stream& stream = *static_cast<Stream*>(cookie);
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = write(stream.descriptor, text + done, size - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {  // another program has made the terminal non-blocking
      pollfd room{stream.descriptor, POLLOUT, 0};
      poll(&room, 1, -1);
    } else if (errno != EINTR) {
      if (stream.error == 0) stream.error = errno;
      break;
    }
  }
  return static_cast<ssize_t>(size);
}

/// Replaces a stream by a guarded one. `mode`: as for setvbuf. If memory is short, the old stream
/// stays.
void Guard(std::FILE*& file, Stream& stream, int mode) {
  std::FILE* const guarded = fopencookie(&stream, "w", {nullptr, Put, nullptr, nullptr});
  if (guarded == nullptr) return;
  std::setvbuf(guarded, nullptr, mode, BUFSIZ);
  file = guarded;
}

}  // namespace

void GuardStreams() {
  // If a standard descriptor is closed, the next opened file, perhaps a trace, would get its
  // number, and printing would write into this file. A descriptor that cannot be written to takes
  // the number instead.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    open("/dev/null",
         descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // uses the lowest free descriptor
  }
  std::signal(SIGPIPE, SIG_IGN);
  Guard(stdout, output, isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF);
  Guard(stderr, errors, _IONBF);
}

void OutputIsNews() { output_is_news = true; }

int FinishOutput(int exit_code) {
  std::fflush(stdout);
  if (output.error == 0) return exit_code;
  if (output.error != EPIPE) {  // closing a pipe early is intentional
    fmt::print(stderr, "{}: cannot write to standard output: {}\n",
               output_is_news ? "warning" : "error", std::strerror(output.error));
  }
  return exit_code == kOk && !output_is_news ? kFailed : exit_code;
}

}  // namespace taut::cli
