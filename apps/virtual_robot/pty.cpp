#include "apps/virtual_robot/pty.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace taut::virtual_robot {
namespace {

/// Replaces `link` atomically by a symbolic link to `target`.
std::string MakeLink(const std::string& target, const std::string& link) {
  struct stat there {};
  if (lstat(link.c_str(), &there) == 0 && !S_ISLNK(there.st_mode)) {
    return "the path exists and is not a symbolic link";
  }
  const std::string fresh = link + "." + std::to_string(getpid()) + ".new";
  if (symlink(target.c_str(), fresh.c_str()) != 0) return std::strerror(errno);
  if (std::rename(fresh.c_str(), link.c_str()) == 0) return "";
  std::string why = std::strerror(errno);
  unlink(fresh.c_str());
  return why;
}

}  // namespace

Pty::Pty(int master, int slave, std::string path, std::string link)
    : master_(master), slave_(slave), path_(std::move(path)), link_(std::move(link)) {}

Pty::Pty(Pty&& other) noexcept
    : master_(std::exchange(other.master_, -1)),
      slave_(std::exchange(other.slave_, -1)),
      path_(std::move(other.path_)),
      link_(std::exchange(other.link_, {})) {}

Pty::~Pty() {
  if (master_ < 0) return;
  char target[256] = {};
  // Another program may have replaced the link since.
  if (!link_.empty() && readlink(link_.c_str(), target, sizeof target - 1) > 0 && path_ == target) {
    unlink(link_.c_str());
  }
  close(slave_);
  close(master_);
}

std::optional<Pty> Pty::Open(const std::string& link, Diagnostics& out) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[128] = {};
  if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0 ||
      ptsname_r(master, name, sizeof name) != 0) {
    out.Error("pseudo_terminal.not_opened", {"pseudo-terminal"},
              std::string("cannot open: ") + std::strerror(errno));
    if (master >= 0) close(master);
    return std::nullopt;
  }
  const int slave = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (slave < 0 || tcgetattr(slave, &settings) != 0) {
    out.Error("pseudo_terminal.not_opened", {name},
              std::string("cannot open: ") + std::strerror(errno));
    if (slave >= 0) close(slave);
    close(master);
    return std::nullopt;
  }
  cfmakeraw(&settings);
  tcsetattr(slave, TCSANOW, &settings);
  if (!link.empty()) {
    const std::string why = MakeLink(name, link);
    if (!why.empty()) {
      out.Error("pseudo_terminal.not_linked", {link},
                "cannot create the link to " + std::string(name) + ": " + why,
                "choose an unused path");
      close(slave);
      close(master);
      return std::nullopt;
    }
  }
  return Pty(master, slave, name, link);
}

bool Pty::Wait(double seconds) const {
  pollfd wanted{master_, POLLIN, 0};
  timespec limit{};
  limit.tv_nsec = static_cast<long>(seconds * 1e9);
  return ppoll(&wanted, 1, &limit, nullptr) > 0 && (wanted.revents & POLLIN) != 0;
}

std::vector<std::uint8_t> Pty::Read() const {
  std::vector<std::uint8_t> bytes(4096);
  const ssize_t count = read(master_, bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

void Pty::Write(std::span<const std::uint8_t> bytes) const {
  [[maybe_unused]] const ssize_t written = write(master_, bytes.data(), bytes.size());
}

}  // namespace taut::virtual_robot
