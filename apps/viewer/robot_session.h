/// Session for a robot: passes the boards' state to browsers and returns their commands to the
/// thread that drives the robot. The driving thread never waits for files, sockets or browsers: all
/// shared data are copied under a lock that is held for a swap only.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "history.h"
#include "robot_status.h"
#include "session.h"
#include "taut/link/log.h"
#include "taut/spec.h"
#include "truth_reader.h"

namespace taut::viewer {

/// Recorder of all cycles, started and ended by clients. Used by the session's thread only, which
/// may wait for the disk.
class RobotRecorder {
 public:
  virtual ~RobotRecorder() = default;
  /// Begins a recording at `time_s`, its time 0. Returns the folder; empty, with a reason, on
  /// failure.
  virtual std::string Begin(double time_s, std::string& why) = 0;
  virtual void Take(const link::State& state) = 0;
  virtual void Event(double time_s, const std::string& text) = 0;
  /// Ends the recording. Returns false, with a reason, if data are missing.
  virtual bool End(std::string& why) = 0;
};

struct RobotSessionOptions {
  RobotSpec robot;
  std::vector<std::string> cables;  ///< Cable of each motor.
  std::string port;
  std::string truth;        ///< Socket on which a virtual robot publishes its pose; empty: none.
  bool experiment = false;  ///< An experiment drives: browsers may only turn power off.
  std::string recording;    ///< Folder of a recording outside this session; empty: none.
  std::unique_ptr<RobotRecorder> recorder;  ///< Null: browsers cannot record.
  bool record_at_once = false;
};

/// Command from a browser to the robot.
struct RobotCommand {
  enum class Kind { kStop, kOff, kArm, kHold, kImpedance, kClearFaults, kGain };
  Kind kind = Kind::kOff;
  int client = 0;
  int motor = 0;  ///< This member and the next ones are for kGain only.
  int gain = 0;   ///< A `board::MotorParameter` below `board::kGains`.
  double value = 0;
};

class RobotSession final : public Session {
 public:
  RobotSession(const std::string& title, RobotSessionOptions options);
  ~RobotSession() override;

  // --- for the thread that drives ------------------------------------------------------------
  /// Call it after each cycle, and regularly while there are no cycles; `state.time_s` is then
  /// constant.
  void Show(const link::State& state);
  void Event(double time_s, const std::string& text);
  /// Begins a run at `time_s`, the new origin of times; plots restart.
  void BeginAt(double time_s);
  /// Returns the commands in order of arrival, but stops first.
  std::vector<RobotCommand> TakeCommands();
  /// Informs a client that its command was not executed.
  void Refuse(int client, const std::string& why);
  /// Sets a gain as read from a board.
  void SetGain(int motor, int gain, double value);
  /// Passes a board's reply to a kGain; `good`: the gain now has this value.
  void AnswerGain(const RobotCommand& command, bool good, const std::string& text);

  bool Finish() override;

 private:
  struct LogEvent {
    double time_s;
    std::string text;
  };
  /// Data passed from the driving thread to the session's thread.
  struct Handover {
    std::vector<link::State> states;
    std::vector<LogEvent> events;
    std::vector<Outgoing> errors;
    std::vector<Json> answers;
    std::optional<double> begins_s;
    std::size_t lost = 0;  ///< Number of states dropped for lack of space.
  };

  bool TakeAtOnce(int client, const Command& command) override;
  void Handle(int client, const Command& command) override;
  Clock::time_point Work() override;

  std::optional<RobotCommand> RobotCommandOf(int client, const Command& command) const;
  void StartHistory();
  void TakeWhatIsLeft();
  void Take(const link::State& state);
  void Happened(const LogEvent& event);
  void Record(bool on);
  void ShowFrame();
  void ShowStatus();
  Json MakeScene() const;
  std::size_t CableOf(std::size_t motor) const { return cable_of_motor_[motor]; }

  RobotSessionOptions options_;
  std::vector<std::size_t> cable_of_motor_;
  std::vector<bool> has_set_point_;

  // Protected by this mutex:
  std::mutex own_mutex_;
  Handover handover_;
  std::vector<RobotCommand> commands_;
  Gains gains_;

  std::atomic<Clock::rep> shown_at_{0};  ///< Time of the last new state.

  // For the session's thread only:
  link::RobotLog log_;
  TruthReader truth_;
  std::optional<History> history_;
  std::optional<link::State> now_;
  double begun_s_ = 0;
  Frame moment_;
  std::vector<Frame::Body> described_;
  std::vector<LogEvent> last_events_;
  std::string recording_;  ///< Empty: not recorded by this session.
  bool all_recorded_ = true, begun_ = false, true_pose_ = false;
  int run_ = 1;
  Clock::time_point status_wall_;
};

}  // namespace taut::viewer
