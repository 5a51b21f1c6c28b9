#include "recording.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "scene.h"
#include "taut/run.h"
#include "taut/run_folder.h"

namespace taut::viewer {
std::unique_ptr<Recording> Recording::Start(const std::string& folder, LiveRun& run,
                                            const ExperimentSpec& experiment,
                                            std::function<void(const std::string&)> say,
                                            Diagnostics& out) {
  std::unique_ptr<Recording> recording(new Recording(folder, std::move(say)));
  return recording->Begin(run, experiment, out) ? std::move(recording) : nullptr;
}

std::string Recording::Path(const char* name, const char* end) const {
  const std::string suffix = part_ == 1 ? "" : "_" + std::to_string(part_);
  return (std::filesystem::path(folder_) / (name + suffix + end)).string();
}

/// Creates the folder again if the user has moved it away to free space.
bool Recording::TakeFolder(Diagnostics& out) {
  if (lock_ && lock_->Holds()) return true;
  ours_ = false;
  lock_.reset();
  lock_ = FolderLock::Take(folder_, out);
  if (lock_) RemoveLeftovers(folder_);
  return lock_ != nullptr;
}

bool Recording::Begin(LiveRun& run, const ExperimentSpec& experiment, Diagnostics& out) {
  time_s_ = run.time_s();
  rows_ = event_count_ = 0;
  if (TakeFolder(out) && BeginFiles(run, experiment, out)) return true;
  writer_.reset();
  events_.reset();
  return false;
}

bool Recording::BeginFiles(LiveRun& run, const ExperimentSpec& experiment, Diagnostics& out) {
  const auto fail = [&](const NewFile& file) {
    out.Error("file.not_writable", {file.path()}, "cannot write: " + file.why());
    return false;
  };
  const std::string id = NewRunId();
  TraceMetadata metadata = RunMetadata(experiment);
  metadata.emplace_back(kRunIdKey, id);
  // Files are first created without a name: on a full disk, existing files of these names stay.
  NewFile inputs(Path("inputs", ".yaml"));
  if (!inputs.Create() || !inputs.Write(InputsOfRun(id, ResolvedYaml(experiment))) ||
      !inputs.Sync()) {
    return fail(inputs);
  }
  events_ = std::make_unique<NewFile>(Path("events", ".jsonl"));
  if (!events_->Create()) return fail(*events_);
  writer_ = CreateHdf5Trace(Path("trace", ".h5"), run.channels(), metadata, out);
  if (!writer_) return false;
  rate_hz_ = experiment.record.rate_hz;
  rows_ = 1;
  if (!writer_->Append(time_s_, run.Row().data())) {  // the file gets its name with the first row
    out.Error("trace.not_written", {}, writer_->error());
    return false;
  }
  identity_ = IdentityOf(Path("trace", ".h5"));
  inputs.Leave();  // if a step below fails, the next reader completes the run with these inputs
  // Files of `taut run` in this folder belong to another run.
  if (!ours_ && !RemoveRunBefore(folder_, {"trace.h5", "inputs.yaml", "events.jsonl"}, out)) {
    return false;
  }
  ours_ = true;
  if (!inputs.Publish()) return fail(inputs);
  return events_->Publish() || fail(*events_);
}

void Recording::Restart(LiveRun& run, const ExperimentSpec& experiment) {
  Finish();
  if ((rows_ > 1 || event_count_ > 0) && part_ < kMaxParts && ++part_ == kMaxParts) {
    say_(fmt::format("{} is the last part of the recording: every further restart replaces it",
                     Path("trace", ".h5")));
  }
  resumed_.clear();
  Diagnostics found;
  if (!Begin(run, experiment, found)) return Fail(found.Format());
  if (failure_.empty()) return;
  failure_.clear();
  resumed_ = fmt::format("recording resumed at the start of part {}; data after {} are missing",
                         part_, since_);
  say_(resumed_);
  Event(time_s_, resumed_);
}

void Recording::Take(LiveRun& run) {
  time_s_ = run.time_s();
  if (!failure_.empty()) return;
  const double due_s = rate_hz_ > 0 ? static_cast<double>(rows_) / rate_hz_ : 0;
  if (time_s_ < due_s - 1e-9) return;
  ++rows_;
  if (!writer_->Append(time_s_, run.Row().data())) Fail(writer_->error());
}

void Recording::Event(double time_s, const std::string& text) {
  if (!failure_.empty()) return;
  ++event_count_;
  if (events_->WriteAllOrNone(Dump({{"time_s", time_s}, {"text", text}}) + "\n")) return;
  Fail(fmt::format("{}: cannot write: {}", events_->path(), events_->why()));
}

void Recording::FlushOld() {
  if (failure_.empty() && IsThere() && !writer_->FlushOld()) Fail(writer_->error());
}

bool Recording::Finish() {
  if (failure_.empty() && IsThere() && !writer_->Finish()) Fail(writer_->error());
  return complete_;
}

/// Checks the file's identity, because writing into a deleted file causes no error.
bool Recording::IsThere() {
  if (IdentityOf(Path("trace", ".h5")) == identity_) return true;
  Fail(Path("trace", ".h5") + ": the file was deleted or replaced");
  return false;
}

void Recording::Fail(const std::string& why) {
  if (!failure_.empty()) return;
  complete_ = false;
  since_ = fmt::format("t = {:g} s of part {}", time_s_, part_);
  failure_ = fmt::format("recording stopped at {}: {}", since_, why);
  while (failure_.back() == '\n') failure_.pop_back();
  failure_ += "; solve this problem, then reset to resume recording";
  writer_.reset();
  events_.reset();
  say_(failure_);
}

MakeRecorder RecordInto(const std::string& folder) {
  if (folder.empty()) return {};
  return [folder](LiveRun& run, const ExperimentSpec& experiment,
                  std::function<void(const std::string&)> say, Diagnostics& out) {
    return Recording::Start(folder, run, experiment, std::move(say), out);
  };
}

}  // namespace taut::viewer
