#include "recording.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scene.h"
#include "taut/run.h"
#include "taut/run_folder.h"

namespace taut::viewer {
namespace {

/// A new file, never one that was there, nor one that a link leads to.
File CreateAnew(const std::string& path) {
  unlink(path.c_str());
  return File(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
}

bool WriteAll(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Under this name until it is whole.
std::string Unfinished(const std::string& path) { return path + ".part"; }

bool Complete(const std::string& path) {
  return std::rename(Unfinished(path).c_str(), path.c_str()) == 0;
}

std::pair<dev_t, ino_t> IdentityOf(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {};
  return {info.st_dev, info.st_ino};
}

}  // namespace

File::~File() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool LineFile::Create(const std::string& path) {
  file_ = CreateAnew(path);
  size_ = 0;
  return file_.get() >= 0;
}

bool LineFile::Append(const std::string& line) {
  if (WriteAll(file_.get(), line + "\n")) {
    size_ += static_cast<off_t>(line.size()) + 1;
    return true;
  }
  const int why = errno;
  if (ftruncate(file_.get(), size_) == 0) errno = why;
  return false;
}

std::unique_ptr<Recording> Recording::Start(const std::string& folder, LiveRun& run,
                                            const ExperimentSpec& experiment,
                                            std::function<void(const std::string&)> say,
                                            Diagnostics& out) {
  std::unique_ptr<Recording> recording(new Recording(folder, std::move(say)));
  recording->lock_ = FolderLock::Take(folder, out);
  if (!recording->lock_) return nullptr;
  // What `taut run` wrote there would say something of another run.
  for (const char* name : {"summary.json", "report.html", "trace.csv"}) {
    unlink((std::filesystem::path(folder) / name).c_str());
  }
  return recording->Begin(run, experiment, out) ? std::move(recording) : nullptr;
}

std::string Recording::Path(const char* name, const char* end) const {
  const std::string suffix = part_ == 1 ? "" : "_" + std::to_string(part_);
  return (std::filesystem::path(folder_) / (name + suffix + end)).string();
}

bool Recording::Begin(LiveRun& run, const ExperimentSpec& experiment, Diagnostics& out) {
  const std::string trace = Path("trace", ".h5"), inputs = Path("inputs", ".yaml"),
                    events = Path("events", ".jsonl");
  // The trace takes its name with its first row: where there is no room for a new part, an old one
  // of that name stays whole.
  const std::string id = NewRunId();
  TraceMetadata metadata = RunMetadata(experiment);
  metadata.emplace_back(kRunIdKey, id);
  const bool listed = events_.Create(Unfinished(events));
  writer_ = listed ? CreateHdf5Trace(trace, run.channels(), metadata, out) : nullptr;
  const bool good = writer_ &&
                    WriteWholeFile(inputs, InputsOfRun(id, ResolvedYaml(experiment)), out) &&
                    Complete(events);
  if (!good) {
    if (out.ok()) {
      out.Error({folder_}, fmt::format("cannot be written: {}", std::strerror(errno)),
                "is the disk full, or the folder not yours?");
    }
    unlink(Unfinished(events).c_str());
    return false;
  }
  rate_hz_ = experiment.record.rate_hz;
  rows_ = event_count_ = 0;
  Take(run);
  identity_ = IdentityOf(trace);
  return true;
}

void Recording::Restart(LiveRun& run, const ExperimentSpec& experiment) {
  if (!Finish()) return;
  if ((rows_ > 1 || event_count_ > 0) && part_ < kMaxParts && ++part_ == kMaxParts) {
    say_(fmt::format("{} is the last part that is recorded: every restart replaces it from now on",
                     Path("trace", ".h5")));
  }
  Diagnostics found;
  if (!Begin(run, experiment, found)) Fail(found.Format());
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
  if (events_.Append(Dump({{"time_s", time_s}, {"text", text}}))) return;
  Fail(fmt::format("{}: cannot be written: {}", Path("events", ".jsonl"), std::strerror(errno)));
}

void Recording::FlushOld() {
  if (failure_.empty() && IsThere() && !writer_->FlushOld()) Fail(writer_->error());
}

bool Recording::Finish() {
  if (failure_.empty() && IsThere() && !writer_->Finish()) Fail(writer_->error());
  return failure_.empty();
}

/// What is written into a file that somebody has removed goes nowhere, without an error.
bool Recording::IsThere() {
  if (IdentityOf(Path("trace", ".h5")) == identity_) return true;
  Fail(Path("trace", ".h5") + ": is no longer there");
  return false;
}

void Recording::Fail(const std::string& why) {
  if (!failure_.empty()) return;
  failure_ = fmt::format("nothing is recorded any more, since t = {:g} s of part {}: {}", time_s_,
                         part_, why);
  while (failure_.back() == '\n') failure_.pop_back();
  failure_ += "; to record again, start taut view anew";
  writer_.reset();
  say_(failure_);
}

}  // namespace taut::viewer
