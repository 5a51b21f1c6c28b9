// Restarts of a live run whose input files have changed on disk.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "live_inputs.h"
#include "live_parameters.h"
#include "live_session.h"
#include "taut/start.h"

namespace taut::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPollPeriod{250};

/// Reports watched files that were replaced by a pipe or a device: reading one could block the
/// session forever, and with it Ctrl-C. Readers accept such a file if a user names it.
void CheckRegular(const std::vector<std::string>& files, Diagnostics& out) {
  for (const std::string& path : files) {
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (!fs::exists(status) || fs::is_regular_file(status) || fs::is_directory(status)) continue;
    out.Error("view.not_a_file", {path, 0, 0}, "the file was replaced by a pipe, socket or device",
              "replace it by a regular file");
  }
}

}  // namespace

void LiveSession::ReloadChangedFiles(Clock::time_point now) {
  if (!options_.watch || now - polled_ < kPollPeriod) return;
  polled_ = now;
  if (!watch_.Poll()) return;
  Diagnostics found;
  scene_changed_ = true;
  std::vector<std::string> files = experiment_.files;
  CheckRegular(watch_.files(), found);
  if (found.ok() && Reload(found)) {
    files_notice_.clear();
    files = experiment_.files;
    const std::string text = "restarted with the changed files";
    SayEvent(0, text);
    options_.tell(text);
    for (const Diagnostic& warning : Sorted(found.warnings())) {
      SayEvent(0, "warning: " + warning.what);
    }
  } else if (!stopping()) {
    const std::string errors = found.Format();
    files_notice_ = errors + "The robot is shown as before the change.";
    options_.tell(errors.substr(0, errors.find_last_not_of('\n') + 1));
    // A change that mends the error may be in a file that the present run does not use.
    for (const Diagnostic& error : found.items()) files.push_back(error.at.file);
  }
  watch_.Watch(files);
}

bool LiveSession::Reload(Diagnostics& out) {
  const Restarts::Inputs& inputs = restarts_.inputs();
  auto read = LoadLiveInputs(inputs.path, inputs.overrides, inputs.start.has_value(), out);
  if (!read) return false;
  const bool model = mode() == "model";
  if (read->model != model) {
    out.Error("view.other_kind", {inputs.path, 0, 0}, "the kind of the file has changed",
              "start taut view again");
    return false;
  }
  ExperimentSpec experiment = std::move(read->experiment);
  if (inputs.step_s > 0) experiment.step_s = inputs.step_s;
  const ExperimentSpec alone = experiment;
  if (model) {
    experiment = StartModel(alone, StartOfName(model_start_));
    if (!CheckStart(experiment.robot, experiment.start, out)) return false;
  }
  auto run = LiveRun::Start(experiment, out, [this] { return !stopping(); });
  if (!run) return false;
  const bool ended = end_told_;
  const NamedValues before = std::exchange(given_, ParametersOfFiles(experiment));
  // A slider keeps its range if the page, not the file, has changed the parameter's value.
  for (const auto& [name, value] : inputs.overrides) {
    const auto old = before.find(name);
    if (old != before.end() && given_.contains(name)) given_[name] = old->second;
  }
  Begin(std::move(run), std::move(experiment));
  if (model) {
    model_ = alone;
    if (!statics_.is_null()) statics_ = options_.statics(model_);
  }
  if (ended || model_start_ == "dropped") pace_.Resume(run_->time_s());
  return true;
}

}  // namespace taut::viewer
