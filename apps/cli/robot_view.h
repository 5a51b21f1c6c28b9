/// A page in browsers for a robot that this command drives: `taut view --robot`, `taut robot run
/// --view`. The thread that drives shows what boards say and does what browsers ask for, between
/// cycles; the server has a thread of its own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/viewer/robot_session.h"
#include "apps/viewer/server.h"
#include "robot.h"

namespace taut::cli {

struct RobotViewOptions {
  std::string title;
  viewer::ServerOptions server;
  bool experiment = false;
  std::string recording;  ///< The folder that the command itself records into.
  std::unique_ptr<viewer::RobotRecorder> recorder;
  bool record_at_once = false;
};

/// Whether a page that moves motors may be served there; else says why not.
bool IsSafeToServe(const viewer::ServerOptions& options);

class RobotView {
 public:
  /// Serves, and says where. Null after messages on stderr; `exit` says how to end. The desk
  /// outlives it.
  static std::unique_ptr<RobotView> Open(RobotDesk& desk, const std::string& port,
                                         RobotViewOptions options, int& exit);
  ~RobotView();

  /// After each cycle, from within it, and now and then where there is none.
  void AfterCycle(const link::State& state);
  void Event(double time_s, const std::string& text) { session_->Event(time_s, text); }
  void BeginAt(double time_s) { session_->BeginAt(time_s); }
  /// Nobody looks any more. False if not all that was to be recorded is there.
  bool End();

 private:
  /// What was asked for and waits for the boards.
  struct Pending {
    int client = 0;
    bool impedance = false;  ///< After holding.
    double until_s = 0;
  };

  RobotView(RobotDesk& desk, bool experiment) : desk_(desk), experiment_(experiment) {}
  void AskForGain();
  void Obey(const viewer::RobotCommand& command, const link::State& state);
  void Arm(int client, const link::State& state);
  void GivePower(int client, bool impedance, const link::State& state);
  void SetGain(const viewer::RobotCommand& command);
  void Continue(const link::State& state);

  RobotDesk& desk_;
  const bool experiment_;
  /// Shared with answers that boards owe: they may come when nobody looks any more.
  std::shared_ptr<viewer::RobotSession> session_;
  std::shared_ptr<int> gains_under_way_ = std::make_shared<int>(0);
  /// Motor and gain that no board has said yet; one is asked for in each cycle.
  std::shared_ptr<std::vector<std::pair<int, int>>> unknown_gains_ =
      std::make_shared<std::vector<std::pair<int, int>>>();
  std::unique_ptr<viewer::Server> server_;
  std::thread thread_;
  std::optional<Pending> pending_;
  std::optional<double> armed_until_s_;
};

}  // namespace taut::cli
