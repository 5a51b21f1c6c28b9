// New runs of a live session: restarts with changed files, and other starts of a model.
#include <utility>

#include "live_inputs.h"
#include "live_session.h"
#include "taut/start.h"

namespace taut::viewer {

void LiveSession::Restart(Clock::time_point deadline) {
  if (!restarts_.pending()) return;
  auto start = restarts_.Make(experiment_, deadline, [this] { return !stopping(); });
  for (const Restarts::Refusal& refusal : restarts_.TakeRefusals()) {
    SayError(refusal.client, refusal.why);
  }
  if (!start) return;
  Begin(std::move(start->run), std::move(start->experiment));
  SayEvent(0, "restarted");
  for (const Diagnostic& warning : start->warnings) SayEvent(0, "warning: " + warning.what);
}

void LiveSession::Begin(std::unique_ptr<LiveRun> run, ExperimentSpec experiment) {
  run_ = std::move(run);
  experiment_ = std::move(experiment);
  ++run_number_;
  end_told_ = broken_told_ = dragging_ = touched_ = false;
  overloads_told_ = 0;
  marks_.clear();
  if (recording_) recording_->Restart(*run_, experiment_);
  StartHistory();
  Anchor();
  changed_ = scene_changed_ = true;
}

bool LiveSession::StartModelAs(const std::string& start, std::string& error) {
  if (mode() != "model") {
    error = "start is possible only in the view of a model";
    return false;
  }
  const ModelStart kind = StartOfName(start);
  ExperimentSpec experiment = StartModel(model_, kind);
  Diagnostics wrong;
  auto run = CheckStart(experiment.robot, experiment.start, wrong)
                 ? LiveRun::Start(experiment, wrong, [this] { return !stopping(); })
                 : nullptr;
  if (!run) {
    error = wrong.Format();
    return false;
  }
  model_start_ = start;
  Begin(std::move(run), std::move(experiment));
  for (const Diagnostic& warning : Sorted(wrong.warnings())) {
    SayEvent(0, "warning: " + warning.what);
  }
  if (kind == ModelStart::kDropped) {
    pace_.Resume(run_->time_s());
  } else {
    Pause();
  }
  return true;
}

bool LiveSession::Analyze(std::string& error) {
  if (mode() != "model" || !options_.statics) {
    error = "analyze is possible only in the view of a model";
    return false;
  }
  if (statics_.is_null()) statics_ = options_.statics(model_);
  scene_changed_ = true;
  return true;
}

}  // namespace taut::viewer
