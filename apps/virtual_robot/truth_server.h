/// What the robot truly does, for whoever wants to watch: lines of JSON from a socket of the
/// machine (docs/formats/truth.md).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_time.h"
#include "apps/virtual_robot/motor_plant.h"
#include "taut/diagnostics.h"

namespace taut::virtual_robot {

/// The first line of a stream: what the numbers of the others belong to.
std::string TruthHeader(const MotorPlant& plant);
/// A line of the stream: the robot as it is at `now`.
std::string TruthFrame(const MotorPlant& plant, Time now);

/// One thread calls it, that of the robot, and never waits for a client.
class TruthServer {
 public:
  static constexpr Time kPeriod = 20 * kMillisecond;  ///< From frame to frame.
  /// What a client may leave unread beyond what the system keeps for it; then it is dropped.
  static constexpr std::size_t kMostPending_bytes = std::size_t{1} << 20;

  /// Listens at `path`. A socket there that nobody listens at is replaced; anything else is not.
  /// Nothing and a complaint if that fails. The plant outlives it.
  static std::unique_ptr<TruthServer> Open(const std::string& path, const MotorPlant& plant,
                                           Diagnostics& out);
  ~TruthServer();
  TruthServer(const TruthServer&) = delete;
  TruthServer& operator=(const TruthServer&) = delete;

  /// After each step of the plant: takes in who has come and sends what is due.
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
  unsigned long long device_ = 0, inode_ = 0;  ///< Of the file at `path_`.
  const MotorPlant& plant_;
  std::string header_;
  std::vector<Client> clients_;
  Time next_ = kPeriod;
};

}  // namespace taut::virtual_robot
