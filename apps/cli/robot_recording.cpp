#include "robot_recording.h"

#include <utility>
#include <vector>

namespace taut::cli {
namespace {

/// Writer of the trace that begins a run, which informs the recording of the same run.
class AnnouncingTrace final : public TraceWriter {
 public:
  AnnouncingTrace(RobotRecording& recording, std::unique_ptr<TraceWriter> trace, std::string path)
      : recording_(recording),
        trace_(std::move(trace)),
        path_(std::move(path)),
        before_(IdentityOf(path_)) {}
  ~AnnouncingTrace() override {
    trace_.reset();  // may begin the run
    Announce();
  }

  bool Append(double time_s, const double* values) override {
    return trace_->Append(time_s, values) && Announce();
  }
  bool FlushOld() override { return trace_->FlushOld(); }
  bool Finish() override { return trace_->Finish() && Announce(); }
  const std::string& error() const override { return trace_->error(); }

 private:
  bool Announce() {
    if (!recording_.has_begun() && IdentityOf(path_) != before_) recording_.NoteBegin();
    return true;
  }

  RobotRecording& recording_;
  std::unique_ptr<TraceWriter> trace_;
  const std::string path_;
  const FileIdentity before_;
};

/// Writer of `host.h5`. Keeps rows in memory until another trace has begun the run, since the first
/// row on the disk replaces the file of the previous run.
class WaitingTrace final : public TraceWriter {
 public:
  WaitingTrace(const RobotRecording& recording, std::unique_ptr<TraceWriter> trace,
               std::size_t channels)
      : recording_(recording), trace_(std::move(trace)), channels_(channels) {}

  bool Append(double time_s, const double* values) override {
    if (!recording_.has_begun()) {
      rows_.emplace_back(time_s, std::vector<double>(values, values + channels_));
      return true;
    }
    return AppendWaiting() && trace_->Append(time_s, values);
  }
  bool FlushOld() override {
    return !recording_.has_begun() || (AppendWaiting() && trace_->FlushOld());
  }
  bool Finish() override {
    return !recording_.has_begun() || (AppendWaiting() && trace_->Finish());
  }
  const std::string& error() const override { return trace_->error(); }

 private:
  bool AppendWaiting() {
    bool good = true;
    for (const auto& [time_s, values] : std::exchange(rows_, {})) {
      good = good && trace_->Append(time_s, values.data());
    }
    return good;
  }

  const RobotRecording& recording_;
  const std::unique_ptr<TraceWriter> trace_;
  const std::size_t channels_;
  std::vector<std::pair<double, std::vector<double>>> rows_;
};

}  // namespace

std::unique_ptr<RobotRecording> RobotRecording::Start(RunFolder& folder,
                                                      const std::vector<std::string>& cables,
                                                      const TraceMetadata& metadata,
                                                      Diagnostics& out) {
  std::unique_ptr<RobotRecording> recording(new RobotRecording(folder, cables));
  if (!folder.Prepare("", out) || !recording->Create("trace.h5", metadata, out)) return nullptr;
  std::unique_ptr<TraceWriter> trace = folder.BeginWith(std::move(recording->trace_), {"trace.h5"});
  recording->trace_ = WriteBehind(recording->Announcing(std::move(trace), "trace.h5"),
                                  recording->log_.channels().size());
  return recording;
}

std::unique_ptr<RobotRecording> RobotRecording::StartHost(RunFolder& folder,
                                                          const std::vector<std::string>& cables,
                                                          const TraceMetadata& metadata,
                                                          Diagnostics& out) {
  std::unique_ptr<RobotRecording> recording(new RobotRecording(folder, cables));
  if (!recording->Create("host.h5", metadata, out)) return nullptr;
  const std::size_t channels = recording->log_.channels().size();
  recording->trace_ = WriteBehind(
      std::make_unique<WaitingTrace>(*recording, std::move(recording->trace_), channels), channels);
  return recording;
}

bool RobotRecording::Create(const std::string& name, const TraceMetadata& metadata,
                            Diagnostics& out) {
  trace_ = CreateHdf5Trace(folder_.Path(name), log_.channels(), metadata, out);
  return trace_ != nullptr;
}

std::unique_ptr<TraceWriter> RobotRecording::Announcing(std::unique_ptr<TraceWriter> trace,
                                                        const std::string& name) {
  return std::make_unique<AnnouncingTrace>(*this, std::move(trace), folder_.Path(name));
}

void RobotRecording::NoteBegin() {
  // Events come from the thread that drives the motors, which must not wait for the disk: it waits
  // at most for the events of the time that the first ones take.
  std::string first;
  {
    const std::lock_guard lock(events_mutex_);
    first = events_before_;
  }
  const bool good = events_.Create() && events_.Write(first) && events_.Publish();
  {
    const std::lock_guard lock(events_mutex_);
    events_good_ = good && events_.WriteAllOrNone(events_before_.substr(first.size()));
    events_published_ = good;
  }
  has_begun_ = true;
}

void RobotRecording::Take(const link::State& state) {
  trace_->Append(state.time_s - begun_s_, log_.Row(state));
  ++rows_;
}

void RobotRecording::Event(double time_s, const std::string& text) {
  const std::string line = link::EventLine(time_s - begun_s_, "pc", text);
  const std::lock_guard lock(events_mutex_);
  if (events_published_) {
    events_good_ = events_.WriteAllOrNone(line) && events_good_;
  } else {
    events_before_ += line;
  }
}

bool RobotRecording::Finish(Diagnostics& out) {
  if (!trace_->Finish()) out.Error("trace.not_written", {}, trace_->error());
  const std::lock_guard lock(events_mutex_);
  if (!events_good_ || (events_published_ && !events_.Sync())) {
    out.Error("file.not_writable", {events_.path()}, "cannot write: " + events_.why());
  }
  return out.ok();
}

}  // namespace taut::cli
