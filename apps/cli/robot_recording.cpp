#include "robot_recording.h"

namespace taut::cli {

std::unique_ptr<RobotRecording> RobotRecording::Start(const std::string& trace_path,
                                                      const std::string& events_path,
                                                      const std::vector<std::string>& cables,
                                                      const TraceMetadata& metadata,
                                                      Diagnostics& out) {
  std::unique_ptr<RobotRecording> recording(new RobotRecording(cables, events_path));
  recording->trace_ = CreateHdf5Trace(trace_path, recording->log_.channels(), metadata, out);
  if (!recording->trace_) return nullptr;
  recording->trace_ = WriteBehind(std::move(recording->trace_), recording->log_.channels().size());
  if (recording->events_.Create() && recording->events_.Publish()) return recording;
  out.Error("file.not_writable", {events_path}, "cannot write: " + recording->events_.why());
  return nullptr;
}

void RobotRecording::Take(const link::State& state) {
  trace_->Append(state.time_s - begun_s_, log_.Row(state));
  ++rows_;
}

void RobotRecording::Event(double time_s, const std::string& text) {
  const std::string line = link::EventLine(time_s - begun_s_, "pc", text);
  events_good_ = events_.WriteAllOrNone(line) && events_good_;
}

bool RobotRecording::Finish(Diagnostics& out) {
  if (!trace_->Finish()) out.Error("trace.not_written", {}, trace_->error());
  if (!events_good_ || !events_.Sync()) {
    out.Error("file.not_writable", {events_.path()}, "cannot write: " + events_.why());
  }
  return out.ok();
}

}  // namespace taut::cli
