#include "truth_reader.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

namespace taut::viewer {
namespace {

constexpr std::chrono::milliseconds kRetry{500};
/// Limit of a line, which has a few kB. A sender of longer lines is not a virtual robot.
constexpr std::size_t kMaxLine = 1 << 20;

std::optional<Frame::Body> BodyOf(const nlohmann::json& numbers) {
  if (!numbers.is_array() || numbers.size() != 7) return std::nullopt;
  double v[7];
  for (std::size_t i = 0; i < 7; ++i) {
    v[i] = numbers[i].is_number() ? numbers[i].get<double>() : Frame::kUnknown;
  }
  return Frame::Body{{v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}};
}

}  // namespace

TruthReader::TruthReader(std::string path, std::size_t bodies)
    : path_(std::move(path)), bodies_(bodies) {}

TruthReader::~TruthReader() { Leave(); }

void TruthReader::Leave() {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  rest_.clear();
  pose_.reset();
  retry_ = Clock::now() + kRetry;
}

void TruthReader::Connect() {
  if (path_.empty() || Clock::now() < retry_) return;
  retry_ = Clock::now() + kRetry;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path_.size() >= sizeof address.sun_path) return;
  std::memcpy(address.sun_path, path_.c_str(), path_.size() + 1);
  socket_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return;
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) Leave();
}

void TruthReader::TakeLine(const std::string& line) {
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("bodies") || !json["bodies"].is_array()) return;
  if (json.contains("format")) return;  // the first line contains only names
  std::vector<Frame::Body> pose;
  for (const nlohmann::json& numbers : json["bodies"]) {
    const auto body = BodyOf(numbers);
    if (!body) return;
    pose.push_back(*body);
  }
  if (pose.size() == bodies_) pose_ = std::move(pose);
}

const std::vector<Frame::Body>* TruthReader::Read() {
  if (socket_ < 0) Connect();
  while (socket_ >= 0) {
    char bytes[16384];
    const ssize_t count = recv(socket_, bytes, sizeof bytes, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
    if (count <= 0 || rest_.size() > kMaxLine) {
      Leave();
      break;
    }
    rest_.append(bytes, static_cast<std::size_t>(count));
  }
  // Only the last complete line is used.
  if (const std::size_t end = rest_.rfind('\n'); end != rest_.npos) {
    const std::size_t before = end == 0 ? rest_.npos : rest_.rfind('\n', end - 1);
    const std::size_t begin = before == rest_.npos ? 0 : before + 1;
    TakeLine(rest_.substr(begin, end - begin));
    rest_.erase(0, end + 1);
  }
  return pose_ ? &*pose_ : nullptr;
}

}  // namespace taut::viewer
