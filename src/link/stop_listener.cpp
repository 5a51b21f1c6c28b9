#include "taut/link/stop_listener.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

#include "link/device_lock.h"

namespace taut::link {
namespace {

constexpr char kStop[] = "stop", kStopped[] = "stopped", kTried[] = "unconfirmed";

/// Builds an abstract socket address of Linux, which is independent of folder and user. Returns its
/// size; 0 on failure.
socklen_t AddressOf(const std::string& device, sockaddr_un* to) {
  const std::string key = DeviceKey(device);
  if (key.empty()) return 0;
  const std::string name = "taut-robot-stop-" + key;
  *to = {};
  to->sun_family = AF_UNIX;
  if (name.size() + 1 > sizeof to->sun_path) return 0;
  std::memcpy(to->sun_path + 1, name.data(), name.size());
  return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
}

}  // namespace

struct StopListener::Askers {
  std::vector<std::pair<sockaddr_un, socklen_t>> addresses;
};

StopListener::StopListener(int socket) : socket_(socket), askers_(std::make_unique<Askers>()) {}

std::unique_ptr<StopListener> StopListener::Open(const std::string& device, Diagnostics& out) {
  sockaddr_un address;
  const socklen_t size = AddressOf(device, &address);
  const int listening = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (listening >= 0 && size > 0 &&
      bind(listening, reinterpret_cast<const sockaddr*>(&address), size) == 0) {
    return std::unique_ptr<StopListener>(new StopListener(listening));
  }
  out.Error("robot.no_stop_listener", {device},
            std::string("cannot listen for emergency stops: ") +
                (size == 0 ? "no such device" : std::strerror(errno)));
  if (listening >= 0) close(listening);
  return nullptr;
}

StopListener::~StopListener() { close(socket_); }

bool StopListener::StopAsked() {
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

void StopListener::Answer(StopAnswer answer) {
  const char* const text = answer == StopAnswer::kStopped ? kStopped : kTried;
  for (const auto& [to, size] : std::exchange(askers_->addresses, {})) {
    sendto(socket_, text, std::strlen(text) + 1, 0, reinterpret_cast<const sockaddr*>(&to), size);
  }
}

StopAnswer AskToStop(const std::string& device, double patience_s) {
  sockaddr_un address;
  const socklen_t size = AddressOf(device, &address);
  if (size == 0) return StopAnswer::kNobody;
  const int asking = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (asking < 0) return StopAnswer::kNobody;
  // The kernel chooses an address to which the answer is sent.
  sockaddr_un own{};
  own.sun_family = AF_UNIX;
  const bool named =
      bind(asking, reinterpret_cast<const sockaddr*>(&own), sizeof own.sun_family) == 0;
  StopAnswer answer = StopAnswer::kNobody;
  if (sendto(asking, kStop, sizeof kStop, 0, reinterpret_cast<const sockaddr*>(&address), size) >=
      0) {
    answer = StopAnswer::kSilent;
    pollfd waits{asking, POLLIN, 0};
    char text[16] = {};
    if (named && poll(&waits, 1, static_cast<int>(patience_s * 1000)) > 0 &&
        recv(asking, text, sizeof text - 1, 0) > 0) {
      if (std::strcmp(text, kStopped) == 0) answer = StopAnswer::kStopped;
      if (std::strcmp(text, kTried) == 0) answer = StopAnswer::kUnconfirmed;
    }
  }
  close(asking);
  return answer;
}

}  // namespace taut::link
