/// Who may drive: one client at a time, and everybody knows who.
#pragma once

#include <string>

namespace taut::viewer {

class Drivers {
 public:
  int driver() const noexcept { return driver_; }  ///< 0: nobody.

  /// Whether the command may be passed on. Whoever asks first while nobody drives, drives.
  bool Allow(int client, const std::string& type) {
    // An emergency stop asks for no control, and takes none.
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
