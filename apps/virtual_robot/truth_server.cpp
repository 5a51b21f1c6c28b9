#include "apps/virtual_robot/truth_server.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/unix_address.h"

namespace taut::virtual_robot {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWaitingClients = 16;

/// Formats JSON; NaN and infinity, which JSON lacks, become null.
std::string Line(const Json& json) { return json.dump() + '\n'; }

/// Returns a JSON list of the results of `text` for each element.
template <class List, class F>
Json Array(const List& of, F&& text) {
  Json array = Json::array();
  for (const auto& one : of) array.push_back(text(one));
  return array;
}

int NewSocket() { return socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

/// Removes a socket left by a program that has ended. Returns a reason if anything else is there.
std::string MakeRoom(const std::string& path, const sockaddr_un& address) {
  struct stat there {};
  if (lstat(path.c_str(), &there) != 0) return errno == ENOENT ? "" : std::strerror(errno);
  if (!S_ISSOCK(there.st_mode)) return "the path exists and is not a socket";
  const int probe = NewSocket();
  if (probe < 0) return std::strerror(errno);
  const int result = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const int why = result == 0 ? 0 : errno;
  close(probe);
  if (why == 0 || why == EAGAIN) return "another program listens at this socket";
  if (why != ECONNREFUSED) return std::strerror(why);
  return unlink(path.c_str()) == 0 ? "" : std::strerror(errno);
}

}  // namespace

std::string TruthHeader(const MotorPlant& plant) {
  const ModelDef& def = plant.batch().model().def();
  const auto name = [](const auto& one) { return one.name; };
  return Line({{"format", "taut_truth"},
               {"version", 1},
               {"name", def.name},
               {"bodies", Array(def.bodies, name)},
               {"cables", Array(def.cables, name)}});
}

std::string TruthFrame(const MotorPlant& plant, Time now) {
  const WorldBatch& batch = plant.batch();
  const ModelDef& def = batch.model().def();
  std::vector<BodyState> bodies;
  for (std::size_t i = 0; i < def.bodies.size(); ++i) {
    bodies.push_back(batch.Body(0, static_cast<int>(i)));
  }
  std::vector<CableState> cables;
  for (std::size_t i = 0; i < def.cables.size(); ++i) {
    cables.push_back(batch.Cable(0, static_cast<int>(i)));
  }
  const auto pose = [](const BodyState& body) {
    const Vec3& p = body.position_m;
    const Quat& q = body.orientation;
    return Json{p.x, p.y, p.z, q.w, q.x, q.y, q.z};
  };
  const auto of_all = [&cables](double CableState::*reading) {
    return Array(cables, [reading](const CableState& cable) { return cable.*reading; });
  };
  return Line({{"time_s", ToSeconds(now)},
               {"held", plant.held()},
               {"bodies", Array(bodies, pose)},
               {"tension_n", of_all(&CableState::tension_n)},
               {"length_m", of_all(&CableState::length_m)},
               {"rest_length_m", of_all(&CableState::rest_length_m)}});
}

std::unique_ptr<TruthServer> TruthServer::Open(const std::string& path, const MotorPlant& plant,
                                               Diagnostics& out) {
  sockaddr_un address{};
  if (!UnixAddress(path, &address)) {
    out.Error("socket.bad_path", {path},
              fmt::format("the path is not usable for a socket (expected 1 to {} bytes)",
                          sizeof address.sun_path - 1));
    return nullptr;
  }
  if (const std::string why = MakeRoom(path, address); !why.empty()) {
    out.Error("socket.not_made", {path}, "cannot create the socket: " + why,
              "choose an unused path");
    return nullptr;
  }
  const int listener = NewSocket();
  if (listener < 0 ||
      bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    out.Error("socket.not_made", {path},
              std::string("cannot create the socket: ") + std::strerror(errno));
    if (listener >= 0) close(listener);
    return nullptr;
  }
  std::unique_ptr<TruthServer> server(new TruthServer(listener, path, plant));
  if (listen(listener, kWaitingClients) != 0) {
    out.Error("socket.not_listening", {path},
              std::string("cannot listen at the socket: ") + std::strerror(errno));
    return nullptr;
  }
  return server;
}

TruthServer::TruthServer(int listener, std::string path, const MotorPlant& plant)
    : listener_(listener), path_(std::move(path)), plant_(plant), header_(TruthHeader(plant)) {
  struct stat mine {};
  if (lstat(path_.c_str(), &mine) == 0) {
    device_ = mine.st_dev;
    inode_ = mine.st_ino;
  }
}

TruthServer::~TruthServer() {
  for (const Client& client : clients_) close(client.socket);
  close(listener_);
  // Another program may have replaced the socket since.
  struct stat there {};
  if (lstat(path_.c_str(), &there) == 0 && there.st_dev == device_ && there.st_ino == inode_) {
    unlink(path_.c_str());
  }
}

void TruthServer::Step(Time now) {
  if (now < next_) return;
  next_ = now - now % kPeriod + kPeriod;
  TakeIn();
  if (clients_.empty()) return;
  const std::string frame = TruthFrame(plant_, now);
  std::erase_if(clients_, [&frame](Client& client) {
    if (Send(client, frame)) return false;
    close(client.socket);
    return true;
  });
}

void TruthServer::TakeIn() {
  for (;;) {
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) return;  // no client, or no capacity: clients wait
    clients_.push_back({socket, header_});
  }
}

/// Returns false if the client is gone, or has not read for too long.
bool TruthServer::Send(Client& client, const std::string& line) {
  client.pending += line;
  const ssize_t sent = send(client.socket, client.pending.data(), client.pending.size(),
                            MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent < 0 && errno != EAGAIN && errno != EINTR) return false;
  if (sent > 0) client.pending.erase(0, static_cast<std::size_t>(sent));
  return client.pending.size() <= kMostPending_bytes;
}

}  // namespace taut::virtual_robot
