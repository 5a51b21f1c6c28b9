#include "recording.h"

#include <filesystem>

#include "taut/run.h"

namespace taut::viewer {

std::unique_ptr<LiveSession::Recording> LiveSession::Recording::Start(
    const std::string& folder, int number, LiveRun& run, const ExperimentSpec& experiment,
    Diagnostics& out) {
  const std::filesystem::path base(folder);
  const std::string suffix = number == 1 ? "" : "_" + std::to_string(number);
  const auto path = [&](const char* name, const char* end) {
    return (base / (name + suffix + end)).string();
  };
  auto recording = std::make_unique<Recording>();
  recording->writer_ =
      CreateHdf5Trace(path("trace", ".h5"), run.channels(), RunMetadata(experiment), out);
  if (!recording->writer_) return nullptr;
  recording->events_.open(path("events", ".jsonl"), std::ios::binary);
  std::ofstream inputs(path("inputs", ".yaml"), std::ios::binary);
  inputs << ResolvedYaml(experiment);
  inputs.close();
  if (!inputs || !recording->events_) {
    out.Error({folder}, "cannot be written", "is the disk full, or the folder not yours?");
    return nullptr;
  }
  recording->rate_hz_ = experiment.record.rate_hz;
  recording->Take(run);
  return recording;
}

bool LiveSession::Recording::Take(LiveRun& run) {
  const double due_s = rate_hz_ > 0 ? static_cast<double>(rows_) / rate_hz_ : 0;
  if (run.time_s() < due_s - 1e-9) return true;
  ++rows_;
  return writer_->Append(run.time_s(), run.Row().data());
}

void LiveSession::Recording::Event(double time_s, const std::string& text) {
  events_ << Dump({{"time_s", time_s}, {"text", text}}) << std::endl;
}

}  // namespace taut::viewer
