/// Server for the true state of the virtual robot: JSON lines on a Unix domain socket
/// (docs/formats/truth.md).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_time.h"
#include "apps/virtual_robot/motor_plant.h"
#include "taut/diagnostics.h"

namespace taut::virtual_robot {

/// Returns the first line of a stream: the names for the numbers of the other lines.
std::string TruthHeader(const MotorPlant& plant);
/// Returns a line of the stream: the robot's state at `now`.
std::string TruthFrame(const MotorPlant& plant, Time now);

/// For use on the robot's thread only; never waits for a client.
class TruthServer {
 public:
  static constexpr Time kPeriod = 20 * kMillisecond;  ///< Interval between frames.
  /// Limit of unsent data for a client in addition to the system's buffer; beyond it the client is
  /// dropped.
  static constexpr std::size_t kMostPending_bytes = std::size_t{1} << 20;

  /// Listens at `path`. An abandoned socket at this path is replaced, other files are not. Returns
  /// null, with an error in `out`, on failure. The plant must outlive the server.
  static std::unique_ptr<TruthServer> Open(const std::string& path, const MotorPlant& plant,
                                           Diagnostics& out);
  ~TruthServer();
  TruthServer(const TruthServer&) = delete;
  TruthServer& operator=(const TruthServer&) = delete;

  /// To be called after each step of the plant: accepts clients and sends due frames.
  void Step(Time now);
  std::size_t client_count() const { return clients_.size(); }

 private:
  struct Client {
    int socket = -1;
    std::string pending;
  };

  TruthServer(int listener, std::string path, const MotorPlant& plant);
  void TakeIn();
  static bool Send(Client& client, const std::string& line);

  int listener_;
  std::string path_;
  unsigned long long device_ = 0, inode_ = 0;  ///< Identity of the file at `path_`.
  const MotorPlant& plant_;
  std::string header_;
  std::vector<Client> clients_;
  Time next_ = kPeriod;
};

}  // namespace taut::virtual_robot
