/// Browser page for a robot that this command drives: `taut view --robot`, `taut robot run --view`.
/// Between cycles, the driving thread publishes the boards' state and executes the browsers'
/// requests; the server has a separate thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/viewer/robot_session.h"
#include "apps/viewer/server.h"
#include "robot_console.h"

namespace taut::cli {

struct RobotViewOptions {
  std::string title;
  viewer::ServerOptions server;
  bool experiment = false;
  std::string recording;  ///< Folder of the command's own recording.
  std::unique_ptr<viewer::RobotRecorder> recorder;
  bool record_at_once = false;
};

/// Returns whether a page that moves motors may be served at this address; otherwise prints the
/// reason.
bool IsSafeToServe(const viewer::ServerOptions& options);

class RobotView {
 public:
  /// Starts the server and prints its address. Returns null after messages on stderr; then `exit`
  /// is the status. The console must outlive the view.
  static std::unique_ptr<RobotView> Open(RobotConsole& desk, const std::string& port,
                                         RobotViewOptions options, int& exit);
  ~RobotView();

  /// To be called after each cycle, within its thread, and regularly while there are no cycles.
  void AfterCycle(const link::State& state);
  void Event(double time_s, const std::string& text) { session_->Event(time_s, text); }
  void BeginAt(double time_s) { session_->BeginAt(time_s); }
  /// Ends the server. Returns false if the recording is incomplete.
  bool End();

 private:
  /// A request that waits for the boards.
  struct Pending {
    int client = 0;
    bool impedance = false;  ///< Whether impedance control follows hold.
    double until_s = 0;
  };

  RobotView(RobotConsole& desk, bool experiment) : desk_(desk), experiment_(experiment) {}
  void AskForGain();
  void Obey(const viewer::RobotCommand& command, const link::State& state);
  void Arm(int client, const link::State& state);
  void GivePower(int client, bool impedance, const link::State& state);
  void SetGain(const viewer::RobotCommand& command);
  void Continue(const link::State& state);

  RobotConsole& desk_;
  const bool experiment_;
  /// Shared with pending replies of the boards, which may arrive after the view has ended.
  std::shared_ptr<viewer::RobotSession> session_;
  std::shared_ptr<int> gains_under_way_ = std::make_shared<int>(0);
  /// Motor and gain of values not yet read from a board; one is requested per cycle.
  std::shared_ptr<std::vector<std::pair<int, int>>> unknown_gains_ =
      std::make_shared<std::vector<std::pair<int, int>>>();
  std::unique_ptr<viewer::Server> server_;
  std::thread thread_;
  std::optional<Pending> pending_;
  std::optional<double> armed_until_s_;
};

}  // namespace taut::cli
