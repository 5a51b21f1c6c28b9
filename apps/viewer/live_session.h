/// Live run for the viewer, in real time or at another speed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "file_watch.h"
#include "history.h"
#include "live_recorder.h"
#include "live_restarts.h"
#include "pace.h"
#include "session.h"
#include "taut/live.h"

namespace taut::viewer {

struct LiveOptions {
  Restarts::Inputs inputs;  ///< Read again when a parameter of the files changes.
  double speed = 1;         ///< Simulated seconds per second; 0: as fast as possible.
  bool paused = false;
  bool watch = false;   ///< Restart when an input file changes; show the errors of such files.
  MakeRecorder record;  ///< Creates the recorder; null: no recording.
  /// Computes Scene.statics of a model; null: not available.
  std::function<Json(const ExperimentSpec&)> statics;
  /// Prints lines to the terminal about interruptions of the recording. Called on the session's
  /// thread and by Finish.
  std::function<void(const std::string&)> tell = [](const std::string&) {};
};

/// State of a run at a time, for comparison with `taut run` of the same inputs.
struct StateMark {
  double time_s = 0;
  std::uint64_t hash = 0;  ///< Result of `World::Hash`.
};

class LiveSession final : public Session {
 public:
  /// Creates a session for `experiment`. Returns null, with errors in `out`, if it cannot start.
  static std::unique_ptr<LiveSession> Create(const std::string& mode,
                                             const ExperimentSpec& experiment,
                                             const LiveOptions& options, Diagnostics& out);
  ~LiveSession() override;

  bool Finish() override;

  // --- for sessions without a thread: between turns ------------------------------------------
  /// Returns the present state; nothing if no simulation runs.
  std::optional<StateMark> State() const;
  /// Sets the times, in increasing order, at which to record the state, for this run and after
  /// restarts.
  void MarkAt(std::vector<double> times_s);
  /// Returns the states recorded in this run: one per time of `MarkAt` that was reached.
  const std::vector<StateMark>& marks() const { return marks_; }
  /// Returns whether the user pushed, pulled or tuned since the start, so that the files do not
  /// reproduce the state.
  bool touched() const { return touched_; }
  /// Returns the user's changes of parameters with which the files were read.
  const Overrides& overrides() const { return restarts_.inputs().overrides; }

 private:
  LiveSession(const std::string& mode, std::unique_ptr<LiveRun> run, LiveOptions options);

  void Handle(int client, const Command& command) override;
  Clock::time_point Work() override;

  bool Drive(int client, const Command& command, std::string& error);
  bool SetParameter(int client, const Command& command, std::string& error);
  bool SetControl(const Command& command, std::string& error);
  void Restart(Clock::time_point deadline = Clock::time_point::max());
  /// Replaces the run of a model by one with another start.
  bool StartModelAs(const std::string& start, std::string& error);
  bool Analyze(std::string& error);
  /// Reads the input files again if they have changed.
  void ReloadChangedFiles(Clock::time_point now);
  bool Reload(Diagnostics& out);
  void Begin(std::unique_ptr<LiveRun> run, ExperimentSpec experiment);
  void StartHistory();
  void Log(const std::string& text);
  void TellOverloads();
  bool StepOnce();
  void StepUntil(double time_s, Clock::time_point deadline);
  void Anchor() { pace_.Anchor(run_->time_s()); }
  void Pause() { pace_.Pause(run_->time_s()); }
  void Fill(Frame& frame) const;
  void Mark();
  void Show();
  Json MakeScene() const;
  std::optional<int> FindNode(const std::string& name) const;

  LiveOptions options_;
  Restarts restarts_;
  ExperimentSpec model_;                   ///< For a model: experiment without weight and ground.
  std::string model_start_ = "described";  ///< Present start of a model (message start).
  Json statics_;                           ///< Scene.statics; null until computed.
  ExperimentSpec experiment_;  ///< Experiment as read; `run_` may differ after changes by the user.
  /// Initial values of the files' parameters, which determine the ranges of sliders.
  std::map<std::string, double> given_;
  std::unique_ptr<LiveRun> run_;
  std::unique_ptr<LiveRecorder> recording_;
  std::vector<bool> has_set_point_;  ///< Whether each cable is under impedance control.
  std::optional<History> history_;
  std::optional<std::size_t> past_row_;  ///< Displayed row; nothing: the present.
  Frame moment_;                         ///< Frame that is reused, to reduce allocations.
  int run_number_ = 1;
  bool end_told_ = false, broken_told_ = false, dragging_ = false;
  std::size_t overloads_told_ = 0;  ///< Number of logged items of LiveRun::Overloads.
  Pace pace_;
  Clock::time_point shown_wall_;
  bool changed_ = true, scene_changed_ = false;
  std::vector<double> mark_at_s_;
  std::vector<StateMark> marks_;
  bool touched_ = false;
  FileWatch watch_;
  Clock::time_point polled_;
  std::string files_notice_;  ///< Errors of changed files, until they are mended.
};

}  // namespace taut::viewer
