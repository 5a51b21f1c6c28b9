/// A robot that somebody drives: he shows what boards say, the session passes it on and brings back
/// what browsers ask for. The thread that drives never waits for files, sockets or browsers: all
/// that it shares is copied under a lock that is held for a swap.
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

/// Where every cycle goes while somebody wants it. Used by the session's thread alone, which may
/// wait for the disk.
class RobotRecorder {
 public:
  virtual ~RobotRecorder() = default;
  /// The folder; empty and a reason if it cannot begin. `time_s` will be its 0.
  virtual std::string Begin(double time_s, std::string& why) = 0;
  virtual void Take(const link::State& state) = 0;
  virtual void Event(double time_s, const std::string& text) = 0;
  /// False and a reason if not all of it could be written.
  virtual bool End(std::string& why) = 0;
};

struct RobotSessionOptions {
  RobotSpec robot;
  std::vector<std::string> cables;  ///< Of the motors.
  std::string port;
  std::string truth;        ///< Socket on which a virtual robot tells its pose; empty: none does.
  bool experiment = false;  ///< One drives it: browsers may only take power.
  std::string recording;    ///< The folder that somebody else records into; empty: none.
  std::unique_ptr<RobotRecorder> recorder;  ///< Null: browsers may not record.
  bool record_at_once = false;
};

/// What a browser wants of the robot.
struct RobotCommand {
  enum class Kind { kStop, kOff, kArm, kHold, kImpedance, kClearFaults, kGain };
  Kind kind = Kind::kOff;
  int client = 0;
  int motor = 0;  ///< kGain, and what follows.
  int gain = 0;   ///< A `board::MotorParameter` below `board::kGains`.
  double value = 0;
};

class RobotSession final : public Session {
 public:
  RobotSession(const std::string& title, RobotSessionOptions options);
  ~RobotSession() override;

  // --- for the thread that drives ------------------------------------------------------------
  /// After each cycle, and now and then where there is none: `state.time_s` then stays.
  void Show(const link::State& state);
  void Event(double time_s, const std::string& text);
  /// A run begins: times are from now on since this one, plots begin anew.
  void BeginAt(double time_s);
  /// In the order in which they came, but for stops, which come first.
  std::vector<RobotCommand> TakeCommands();
  /// What a client asked for was not done.
  void Refuse(int client, const std::string& why);
  /// A board has said what a gain is.
  void SetGain(int motor, int gain, double value);
  /// What a board said to a kGain; `good`: its value is now this.
  void AnswerGain(const RobotCommand& command, bool good, const std::string& text);

  bool Finish() override;

 private:
  struct Happening {
    double time_s;
    std::string text;
  };
  /// What the driving thread has left for the session's.
  struct Left {
    std::vector<link::State> states;
    std::vector<Happening> events;
    std::vector<Outgoing> errors;
    std::vector<Json> answers;
    std::optional<double> begins_s;
    std::size_t lost = 0;  ///< States for which there was no room.
  };

  bool TakeAtOnce(int client, const Command& command) override;
  void Handle(int client, const Command& command) override;
  Clock::time_point Work() override;

  std::optional<RobotCommand> RobotCommandOf(int client, const Command& command) const;
  void StartHistory();
  void TakeWhatIsLeft();
  void Take(const link::State& state);
  void Happened(const Happening& event);
  void Record(bool on);
  void ShowFrame();
  void ShowStatus();
  Json MakeScene() const;
  std::size_t CableOf(std::size_t motor) const { return cable_of_motor_[motor]; }

  RobotSessionOptions options_;
  std::vector<std::size_t> cable_of_motor_;
  std::vector<bool> has_set_point_;

  // Belongs to the lock.
  std::mutex own_mutex_;
  Left left_;
  std::vector<RobotCommand> commands_;
  Gains gains_;

  std::atomic<Clock::rep> shown_at_{0};  ///< When a new state came last.

  // The session's thread's.
  link::RobotLog log_;
  TruthReader truth_;
  std::optional<History> history_;
  std::optional<link::State> now_;
  double begun_s_ = 0;
  Frame moment_;
  std::vector<Frame::Body> described_;
  std::vector<Happening> last_events_;
  std::string recording_;  ///< Empty: not by us.
  bool all_recorded_ = true, begun_ = false, true_pose_ = false;
  int run_ = 1;
  Clock::time_point status_wall_;
};

}  // namespace taut::viewer
