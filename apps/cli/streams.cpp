#include "streams.h"

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
  int error = 0;  ///< The first; 0: all that was printed has arrived.
};

Stream output{STDOUT_FILENO}, errors{STDERR_FILENO};
bool output_is_news = false;

/// Takes all in any case: an error is remembered and is nobody's business until the end.
ssize_t Put(void* cookie, const char* text, std::size_t size) {
  Stream& stream = *static_cast<Stream*>(cookie);
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = write(stream.descriptor, text + done, size - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN) {  // another program has set the terminal so
      pollfd room{stream.descriptor, POLLOUT, 0};
      poll(&room, 1, -1);
    } else if (errno != EINTR) {
      if (stream.error == 0) stream.error = errno;
      break;
    }
  }
  return static_cast<ssize_t>(size);
}

/// `mode` as of setvbuf. In want of memory the stream stays what it was.
void Guard(std::FILE*& file, Stream& stream, int mode) {
  std::FILE* const guarded = fopencookie(&stream, "w", {nullptr, Put, nullptr, nullptr});
  if (guarded == nullptr) return;
  std::setvbuf(guarded, nullptr, mode, BUFSIZ);
  file = guarded;
}

}  // namespace

void GuardStreams() {
  // A closed descriptor would be given to the next file that is opened, a trace perhaps, and that
  // would be printed into. In its place stands one that cannot be written to.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // the lowest that is free
  }
  std::signal(SIGPIPE, SIG_IGN);
  Guard(stdout, output, isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF);
  Guard(stderr, errors, _IONBF);
}

void OutputIsNews() { output_is_news = true; }

int FinishOutput(int exit_code) {
  std::fflush(stdout);
  if (output.error == 0) return exit_code;
  if (output.error != EPIPE) {  // who has closed a pipe knows
    fmt::print(stderr, "{}: standard output cannot be written: {}\n",
               output_is_news ? "warning" : "error", std::strerror(output.error));
  }
  return exit_code == kOk && !output_is_news ? kFailed : exit_code;
}

}  // namespace taut::cli
