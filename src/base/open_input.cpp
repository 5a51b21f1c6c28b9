#include "base/open_input.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace taut::base {
namespace {

constexpr std::chrono::milliseconds kBetween{20};

/// Calls `done` until it returns true. Returns false after `kPipePatience_s`.
template <class F>
bool Await(const F& done) {
  const auto until =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(kPipePatience_s);
  while (!done()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(kBetween);
  }
  return true;
}

/// Returns whether a program has a pipe open for writing, or had it open before.
bool HasWriter(int descriptor) {
  pollfd state{descriptor, POLLIN, 0};
  if (poll(&state, 1, 0) > 0 && (state.revents & (POLLIN | POLLHUP)) != 0) return true;
#ifdef __linux__
  // A program that has not written yet: copying its bytes, without taking them, would block.
  int copy[2];
  if (pipe2(copy, O_CLOEXEC | O_NONBLOCK) != 0) return false;
  const ssize_t count = tee(descriptor, copy[1], 1, SPLICE_F_NONBLOCK);
  const bool has_writer = count > 0 || (count < 0 && errno == EAGAIN);
  close(copy[0]);
  close(copy[1]);
  return has_writer;
#else
  return false;
#endif
}

/// Lets reading and writing wait again.
bool MakeBlocking(int descriptor) {
  const int flags = fcntl(descriptor, F_GETFL);
  return flags >= 0 && fcntl(descriptor, F_SETFL, flags & ~O_NONBLOCK) == 0;
}

OpenFile Failed(int error) {
  errno = error;
  return OpenFile(-1);
}

}  // namespace

OpenFile::~OpenFile() {
  const int error = errno;
  if (descriptor_ >= 0) close(descriptor_);
  errno = error;
}

int OpenFile::Release() { return std::exchange(descriptor_, -1); }

OpenFile OpenToRead(const std::string& path) {
  OpenFile file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  struct stat info {};
  if (!file || fstat(file.get(), &info) != 0) return Failed(errno);
  if (S_ISFIFO(info.st_mode) && !Await([&] { return HasWriter(file.get()); })) {
    return Failed(ETIMEDOUT);
  }
  const bool waits = S_ISREG(info.st_mode) || S_ISFIFO(info.st_mode) || isatty(file.get()) == 1;
  if (waits && !MakeBlocking(file.get())) return Failed(errno);
  return file;
}

OpenFile OpenToAppend(const std::string& path) {
  int descriptor = -1;
  const bool opened = Await([&] {
    descriptor = open(path.c_str(), O_WRONLY | O_APPEND | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    return descriptor >= 0 || errno != ENXIO;
  });
  if (!opened) return Failed(ETIMEDOUT);
  OpenFile file(descriptor);
  if (!file || !MakeBlocking(descriptor)) return Failed(errno);
  return file;
}

std::string OpenError(int error) {
  if (error == ETIMEDOUT) return "no other program has opened this pipe within 5 s";
  return std::strerror(error);
}

}  // namespace taut::base
