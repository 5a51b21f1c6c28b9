// `taut view --robot`: control page of a robot.
#include "view_robot.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "interrupt.h"
#include "robot_recording.h"
#include "robot_view.h"
#include "standard_streams.h"
#include "taut/run_folder.h"
#include "taut/version.h"
#include "view_server.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

constexpr char kFolder[] = "runs/robot_view";

/// Recorder with one folder per recording: OUT, OUT_2, OUT_3, ...
class FolderRecorder final : public viewer::RobotRecorder {
 public:
  FolderRecorder(std::string out, std::vector<std::string> cables, TraceMetadata metadata)
      : out_(std::move(out)), cables_(std::move(cables)), metadata_(std::move(metadata)) {}

  std::string Begin(double time_s, std::string& why) override {
    Diagnostics found;
    folder_ = RunFolder::Open(NextFolder(), {}, found);
    if (folder_) {
      TraceMetadata metadata = metadata_;
      metadata.emplace_back(kRunIdKey, folder_->id());
      recording_ = RobotRecording::Start(*folder_, cables_, metadata, found);
    }
    if (!recording_) {
      why = found.Format();
      Tell(why);
      folder_.reset();
      return {};
    }
    recording_->BeginAt(time_s);
    return path_;
  }
  void Take(const link::State& state) override { recording_->Take(state); }
  void Event(double time_s, const std::string& text) override { recording_->Event(time_s, text); }
  bool End(std::string& why) override {
    Diagnostics found;
    const bool whole = recording_->Finish(found);
    why = found.Format();
    if (!whole) Tell(why);
    recording_.reset();
    folder_.reset();
    return whole;
  }

 private:
  /// Returns the next folder. A folder named on the command line is replaced, as by other commands;
  /// all others are kept.
  std::string NextFolder() {
    path_ = out_.empty() ? kFolder : out_;
    const bool named = !out_.empty() && count_++ == 0;
    const std::string first = path_;
    std::error_code error;
    for (int i = 2; !named && fs::exists(path_, error); ++i) path_ = fmt::format("{}_{}", first, i);
    return path_;
  }

  std::string out_, path_;
  int count_ = 0;
  std::vector<std::string> cables_;
  TraceMetadata metadata_;
  std::unique_ptr<RunFolder> folder_;
  std::unique_ptr<RobotRecording> recording_;
};

}  // namespace

int ViewRobot(ViewRobotArguments args) {
  OutputIsNews();
  if (!IsSafeToServe(args.server) || !TokensOf(args.server)) return kUsage;
  int exit = kOk;
  const auto desk = RobotConsole::Open(args, nullptr, exit);
  if (!desk) return exit;
  const std::string& name = desk->robot().def.name;
  RobotViewOptions options;
  options.title = name;
  options.server = args.server;
  options.record_at_once = !args.out.empty();
  TraceMetadata metadata{
      {"taut_version", kVersion}, {"model", name}, {"plant", "robot at " + args.port}};
  if (!args.calibration.empty()) metadata.emplace_back("calibration", args.calibration);
  options.recorder =
      std::make_unique<FolderRecorder>(args.out, desk->cables(), std::move(metadata));
  const auto view = RobotView::Open(*desk, args.port, std::move(options), exit);
  if (!view) return exit;

  link::Driver& driver = desk->driver();
  desk->on_cycle = [&](const link::State& state) { view->AfterCycle(state); };
  desk->on_event = [&](double time_s, const std::string& text) { view->Event(time_s, text); };
  desk->RunWhile([&] {
    // No cycles run without an adapter; the page is updated nevertheless.
    if (!driver.state().link.connected) view->AfterCycle(driver.state());
    return true;
  });
  const bool off = desk->EndAndReport(false);
  desk->on_event = {};
  const bool recorded = view->End();
  return off && recorded ? kOk : kFailed;
}

}  // namespace taut::cli
