#include "taut/link/robot_lock.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/unix_address.h"
#include "link/runtime_folder.h"

namespace taut::link {
namespace {

constexpr char kStop[] = "stop", kStopped[] = "stopped";

/// The same for all names of a device; empty and a complaint without a folder for it.
std::string PathFor(const std::string& device, Diagnostics& out) {
  const std::string folder = RuntimeFolder(out);
  if (folder.empty()) return {};
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(device, error);
  std::string name = error ? device : real.string();
  for (char& c : name) {
    if (c == '/') c = '_';
  }
  return folder + "/robot" + name;
}

}  // namespace

struct RobotLock::Askers {
  std::vector<std::pair<sockaddr_un, socklen_t>> addresses;
};

RobotLock::RobotLock(std::string socket_path, int lock, int socket)
    : socket_path_(std::move(socket_path)),
      lock_(lock),
      socket_(socket),
      askers_(std::make_unique<Askers>()) {}

std::unique_ptr<RobotLock> RobotLock::Take(const std::string& device, Diagnostics& out) {
  const std::string path = PathFor(device, out);
  if (path.empty()) return nullptr;
  const std::string lock_path = path + ".lock", socket_path = path + ".stop";
  const int lock = open(lock_path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (lock < 0) {
    out.Error({lock_path}, std::string("cannot be made: ") + std::strerror(errno));
    return nullptr;
  }
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    char who[32] = {};
    const ssize_t size = pread(lock, who, sizeof who - 1, 0);
    close(lock);
    out.Error({device},
              "process " + std::string(who, size > 0 ? static_cast<std::size_t>(size) : 0) +
                  " drives this robot",
              "`taut robot estop` stops it all the same");
    return nullptr;
  }
  const std::string who = std::to_string(getpid());
  if (ftruncate(lock, 0) != 0 || pwrite(lock, who.data(), who.size(), 0) < 0) {
    // Nobody will know who it is; it is no less locked.
  }
  const int socket_to = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_un address;
  unlink(socket_path.c_str());  // of one that was killed: the lock is ours
  if (socket_to < 0 || !UnixAddress(socket_path, &address) ||
      bind(socket_to, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    out.Error({socket_path}, std::string("cannot be listened to: ") + std::strerror(errno));
    if (socket_to >= 0) close(socket_to);
    close(lock);
    return nullptr;
  }
  return std::unique_ptr<RobotLock>(new RobotLock(socket_path, lock, socket_to));
}

RobotLock::~RobotLock() {
  unlink(socket_path_.c_str());
  close(socket_);
  close(lock_);
}

bool RobotLock::StopAsked() {
  bool asked = false;
  for (;;) {
    char text[16];
    sockaddr_un from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        recvfrom(socket_, text, sizeof text, 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0) return asked;
    if (static_cast<std::size_t>(got) != sizeof kStop ||
        std::memcmp(text, kStop, sizeof kStop) != 0)
      continue;
    asked = true;
    askers_->addresses.emplace_back(from, size);
  }
}

void RobotLock::Stopped() {
  for (const auto& [to, size] : std::exchange(askers_->addresses, {})) {
    sendto(socket_, kStopped, sizeof kStopped, 0, reinterpret_cast<const sockaddr*>(&to), size);
  }
}

StopAnswer AskToStop(const std::string& device, double patience_s, Diagnostics& out) {
  const std::string path = PathFor(device, out);
  sockaddr_un address;
  if (path.empty() || !UnixAddress(path + ".stop", &address)) return StopAnswer::kNobody;
  const int asking = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (asking < 0) return StopAnswer::kNobody;
  // A name of its own, which the kernel chooses, for the answer to go to.
  sockaddr_un own{};
  own.sun_family = AF_UNIX;
  const bool named =
      bind(asking, reinterpret_cast<const sockaddr*>(&own), sizeof own.sun_family) == 0;
  StopAnswer answer = StopAnswer::kNobody;
  if (sendto(asking, kStop, sizeof kStop, 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address) >= 0) {
    answer = StopAnswer::kSilent;
    pollfd waits{asking, POLLIN, 0};
    char text[16];
    if (named && poll(&waits, 1, static_cast<int>(patience_s * 1000)) > 0 &&
        recv(asking, text, sizeof text, 0) == sizeof kStopped) {
      answer = StopAnswer::kStopped;
    }
  }
  close(asking);
  return answer;
}

}  // namespace taut::link
