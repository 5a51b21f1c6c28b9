/// Control of the session: one client at a time may drive, and all clients are informed.
#pragma once

#include <string>

namespace taut::viewer {

class Drivers {
 public:
  int driver() const noexcept { return driver_; }  ///< Number of the driving client; 0: none.

  /// Returns whether a command of this type from this client is accepted. If no client drives, the
  /// first client that sends a command becomes the driver.
  bool Allow(int client, const std::string& type) {
    // An emergency stop is accepted from every client and does not change the driver.
    if (type == "want_series" || type == "stop") return true;
    if (type == "take_control" || driver_ == 0) driver_ = client;
    return driver_ == client;
  }

  void Leave(int client) {
    if (driver_ == client) driver_ = 0;
  }

 private:
  int driver_ = 0;
};

}  // namespace taut::viewer
